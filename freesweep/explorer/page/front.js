// Designs as points: two measures against each other, lit ones in colour, and the front of the lit ones.
const CLOUD = 6000;
let cloud = null;

function askCloud() {
  if (state.cloud !== "all") { cloud = null; drawFront(); return; }
  const wanted = [...new Set([state.fx, state.fy, ...state.wishes.map((one) => one.measure)])];
  const loads = { ...state.at };
  request("cloud", { what: "cloud", n: CLOUD, at: loads, measures: wanted }, (answer) => { cloud = answer; drawFront(); });
}

const frontOf = () => (state.cloud === "all" ? cloud : grid);

function drawFront() {
  const from = frontOf(), { fx, fy } = state;
  const empty = { x: [], y: [] }, xs = from?.values[fx], ys = from?.values[fy];
  models.front.below[0].axis_label = withUnit(fx);
  models.front.left[0].axis_label = withUnit(fy);
  if (!xs || !ys) { for (const name of ["front_dim", "front_lit", "front_line"]) put(name, empty); return; }
  const room = margins(from), on = state.wishes.length > 0 || state.taut, stride = Math.max(Math.ceil(xs.length / 5000), 1);
  const dim = { x: [], y: [] }, lit = { x: [], y: [] }, all = [];
  for (let k = 0; k < xs.length; k++) {
    if (!Number.isFinite(xs[k]) || !Number.isFinite(ys[k])) continue;
    const x = shown(fx, xs[k]), y = shown(fy, ys[k]), isLit = on && room[k] >= 0;
    if (isLit) all.push([x, y, k]);
    if (!isLit && k % stride) continue;
    (isLit ? lit : dim).x.push(x);
    (isLit ? lit : dim).y.push(y);
  }
  put("front_dim", dim); put("front_lit", lit);
  const best = paretoOf(all);
  put("front_line", { x: best.map((one) => one[0]), y: best.map((one) => one[1]) });
  const pins = state.pins.map((_, k) => [valueOf(k, fx)?.value, valueOf(k, fy)?.value, colourOf(k)]).filter(([x, y]) => Number.isFinite(x) && Number.isFinite(y));
  put("front_pins", { x: pins.map((one) => shown(fx, one[0])), y: pins.map((one) => shown(fy, one[1])), colour: pins.map((one) => one[2]), edge: pins.map(() => "#ffffff") });
  for (const [axis, values, name] of [["x_range", [...dim.x, ...lit.x], fx], ["y_range", [...dim.y, ...lit.y], fy]]) {
    const sorted = Float64Array.from(values).sort(), end = (share) => sorted[Math.round(share * (sorted.length - 1))];
    if (!sorted.length) continue;
    const lits = (name === fx ? lit.x : lit.y), low = lits.reduce((a, b) => Math.min(a, b), end(0.02)), high = lits.reduce((a, b) => Math.max(a, b), end(0.98));
    const margin = 0.05 * (high - low) || 1;
    if (!grid?.drag) models.front[axis].setv({ start: low - margin, end: high + margin });
  }
}

// The front of what is lit: designs that no other beats in both measures; `dx`, `dy` = 1: more is better, -1: less.
function paretoOf(points) {
  const { dx, dy } = state, sorted = [...points].sort((p, q) => dx * (q[0] - p[0]) || dy * (q[1] - p[1])), best = [];
  let most = -Infinity;
  for (const one of sorted) if (dy * one[1] > most) { most = dy * one[1]; best.push(one); }
  return best;
}

// A click takes the nearest design: its pin, and the sliders to where it is.
function tapFront(sx, sy, x, y) {
  const from = frontOf(), { fx, fy } = state, { x_range: xr, y_range: yr } = models.front;
  if (!from?.values[fx] || !from.values[fy]) return;
  let best = null, least = 0.04;
  const on = state.wishes.length > 0 || state.taut, room = margins(from);
  for (let k = 0; k < from.values[fx].length; k++) {
    const dx = (shown(fx, from.values[fx][k]) - x) / (xr.end - xr.start), dy = (shown(fy, from.values[fy][k]) - y) / (yr.end - yr.start);
    const far = Math.hypot(dx, dy) + (on && room[k] < 0 ? 0.02 : 0);
    if (far < least) { least = far; best = k; }
  }
  if (best === null) return;
  if (state.cloud === "all") {
    const design = Object.fromEntries(facts.design_axes.map((name) => [name, cloud.designs[name][best]]));
    pin({ ...state.at, ...design });
    change({ at: { ...state.at, ...design } });
  } else {
    const along = (name, i, n) => facts.axes[name].low + ((facts.axes[name].high - facts.axes[name].low) * i) / (n - 1);
    pin({ ...state.at, [state.x]: along(state.x, best % grid.nx, grid.nx), [state.y]: along(state.y, Math.floor(best / grid.nx), grid.ny) });
  }
}

// A box over the points is two wishes.
function boxFront({ x0, x1, y0, y1 }) {
  const { fx, fy } = state, range = (name, a, b) => ({ measure: name, low: kept(name, Math.min(a, b)), high: kept(name, Math.max(a, b)) });
  const others = state.wishes.filter((one) => ![fx, fy].includes(one.measure));
  change({ wishes: [...others, range(fx, x0, x1), ...(fy === fx ? [] : [range(fy, y0, y1)])] });
}
