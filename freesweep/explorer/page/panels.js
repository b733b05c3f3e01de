// Curves of the pinned designs along the pressure: stated errors as bands, thin where threads are slack, locked values dotted.
function drawCurve() {
  const { along, nodes, curves } = pinned, name = state.m, factor = unitOf(name)[1];
  const lines = { xs: [], ys: [], colour: [], width: [] }, band = { xs: [], ys: [], colour: [] };
  const locked = { xs: [], ys: [], colour: [] }, dots = { x: [], y: [], colour: [] };
  let low = Infinity, high = -Infinity;
  const xs = [...nodes].map((value) => shown(facts.along, value)), [x0, x1] = spanOf(facts.along);
  curves.forEach((curve, k) => {
    if (!curve[name]) return;
    const colour = colourOf(k), { value, error, slack } = curve[name];
    const ys = [...value].map((one) => factor * one), room = [...error].map((one) => factor * one);
    for (const y of ys) if (Number.isFinite(y)) { low = Math.min(low, y); high = Math.max(high, y); }
    for (const [from, to] of runsOf(ys.map((y) => Number.isFinite(y)))) {
      const part = (list) => list.slice(from, to + 1);
      band.xs.push([...part(xs), ...part(xs).reverse()]);
      band.ys.push([...part(ys.map((y, j) => y + room[j])), ...part(ys.map((y, j) => y - room[j])).reverse()]);
      band.colour.push(colour);
      for (const [a, b, isSlack] of piecesOf(part([...slack]).map(Boolean))) {
        lines.xs.push(part(xs).slice(a, b + 1)); lines.ys.push(part(ys).slice(a, b + 1));
        lines.colour.push(colour); lines.width.push((isSlack ? 1 : 2) + (k === state.active ? 0.8 : 0));
      }
    }
    const end = lockedOf(name) && pinned.pins[k].measures[lockedOf(name)]?.value;
    if (Number.isFinite(end)) { locked.xs.push([x0, x1]); locked.ys.push([factor * end, factor * end]); locked.colour.push(colour); }
    const now = pinned.pins[k].measures[name]?.value;
    if (Number.isFinite(now)) { dots.x.push(shown(facts.along, state.at[facts.along])); dots.y.push(factor * now); dots.colour.push(colour); }
  });
  const ends = locked.ys.map((one) => one[0]);
  [low, high] = Number.isFinite(low) ? [Math.min(low, ...ends), Math.max(high, ...ends)] : [0, 1];
  const room = 0.06 * (high - low) || Math.abs(high) || 1;
  put("curve_lines", lines); put("curve_band", band); put("curve_locked", locked); put("curve_dots", dots);
  const here = shown(facts.along, state.at[facts.along]);
  put("curve_now", { xs: [[here, here]], ys: [[low - room, high + room]], ink: [css("--quiet")] });
  models.curve.x_range.setv({ start: x0, end: x1 });
  models.curve.y_range.setv({ start: low - room, end: high + room });
  models.curve.below[0].axis_label = withUnit(facts.along);
  models.curve.left[0].axis_label = unitOf(name)[0] ? `[${unitName(name)}]` : "";
  byId("curve_title").innerHTML = `${labelOf(name)}${lockedOf(name) && curves.length ? '<span class="note"> dotted: locked</span>' : ""}`;
}

// [first, last] of the runs of true.
function runsOf(flags) {
  const runs = [];
  flags.forEach((flag, k) => {
    if (!flag) return;
    if (k && flags[k - 1]) runs[runs.length - 1][1] = k; else runs.push([k, k]);
  });
  return runs;
}

// [first, last, flag] of pieces that share their ends.
function piecesOf(flags) {
  const pieces = [[0, 0, flags[0]]];
  for (let k = 1; k < flags.length; k++) {
    pieces[pieces.length - 1][1] = k;
    if (flags[k] !== pieces[pieces.length - 1][2] && k + 1 < flags.length) pieces.push([k, k, flags[k]]);
  }
  return pieces;
}
