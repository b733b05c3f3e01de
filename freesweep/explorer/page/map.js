// The map: asked for coarsely while something is dragged, finely when it rests.
const FINE = 4, DRAFT = 3, ROOM = 0.04; // ROOM: of a name from the edge, of the axis
const PAUSE = 500; // [ms] without a frame: something else is moved
let grid = null, bands = null, draftScale = 0.5, cross = null;

function gridSize(drag) {
  const counts = (name) => {
    const { low, high, unit } = facts.axes[name];
    return unit === "degree" ? Math.min(Math.max(Math.round(high - low) + 1, 41), 181) : 101;
  };
  const scale = drag ? draftScale : 1;
  return [state.x, state.y].map((name) => Math.max(Math.round((counts(name) - 1) * scale), 16) + 1);
}

function gridMeasures(drag) {
  const own = state.wishes.map((wish) => wish.measure);
  return [...new Set([state.m, ...own, ...(state.cloud === "map" && !drag ? [state.fx, state.fy] : [])])];
}

function askMap(drag) {
  const [nx, ny] = gridSize(drag), began = performance.now();
  const { x, y } = state, question = { what: "grid", x, y, nx, ny, at: { ...state.at }, measures: gridMeasures(drag) };
  request("grid", question, (answer) => {
    grid = { ...answer, x, y, at: question.at, measure: question.measures[0], drag };
    drawMap();
    if (drag) {
      const now = performance.now(), gap = now - (frames.at(-1) ?? 0); // what was drawn is painted in it, too
      const took = gap < PAUSE ? gap : now - began;
      draftScale = Math.min(Math.max(draftScale * (took > 75 ? 0.85 : took < 50 ? 1.05 : 1), 0.25), 1); // ten frames a second and better
      frames.push(now);
    }
    drawWishes();
    if (!drag) drawFront();
  });
}

const frames = []; // when maps were drawn while something moved

function drawMap() {
  if (!grid || grid.x !== state.x || grid.y !== state.y || !(state.m in grid.values)) return;
  const { nx, ny } = grid, f = grid.drag ? DRAFT : FINE, factor = unitOf(state.m)[1], one = measures.get(state.m);
  const values = grid.values[state.m].map((value) => factor * value);
  if (!grid.drag || !bands || bands.of !== state.m + state.u) {
    bands = { ...bandsOf(values, one.centre === null ? null : one.centre * factor), of: state.m + state.u };
    drawBar();
  }
  const fine = finer(values, nx, ny, f), lit = state.wishes.length || state.taut ? finer(margins(grid), nx, ny, f).values : null;
  const [x0, x1] = spanOf(state.x), [y0, y1] = spanOf(state.y);
  put("map_image", { image: [pixelColumn(pixels(fine, bands, lit), fine.w, fine.h)], x: [x0], y: [y0], dw: [x1 - x0], dh: [y1 - y0] });
  drawHatches();
}

const spanOf = (name) => [shown(name, facts.axes[name].low), shown(name, facts.axes[name].high)];
const models = {};
const put = (name, data) => { models[name].data = data; };

function drawBar() {
  const palette = bands.colours.map((one) => (bands.isEmpty ? "#00000000" : "#" + one.map((part) => part.toString(16).padStart(2, "0")).join("")));
  const { map_colours: mapper, map_bar: bar } = models;
  mapper.setv({ palette, low: bands.low, high: bands.low + bands.step * palette.length });
  const ticks = Array.from({ length: palette.length + 1 }, (_, k) => bands.low + k * bands.step);
  const stride = Math.ceil(ticks.length / 9), first = Math.max(ticks.findIndex((one) => Math.abs(one) < 1e-9 * bands.step * 100), 0) % stride;
  const { FixedTicker } = Bokeh.Models.get ? { FixedTicker: Bokeh.Models.get("FixedTicker") } : Bokeh.Models;
  bar.ticker = new FixedTicker({ ticks: ticks.filter((_, k) => k % stride === first) });
  bar.major_label_text_alpha = bands.isEmpty ? 0 : 1;
  byId("map_title").innerHTML = withUnit(state.m) + (bands.isEmpty ? '<span class="note"> no value on this map</span>' : "");
}

// How far inside all wishes the places of a grid are, in spans of a wish; below zero outside.
function margins(from) {
  const count = (from.slack || []).length, made = new Float32Array(count).fill(1);
  for (const { measure, low, high } of state.wishes) {
    const values = from.values[measure];
    if (!values) continue;
    const size = low !== null && high !== null ? Math.max(high - low, 1e-12) : Math.abs(low ?? high ?? 1) || 1;
    for (let k = 0; k < count; k++) {
      const room = Math.min(low === null ? 1 : (values[k] - low) / size, high === null ? 1 : (high - values[k]) / size);
      made[k] = Number.isNaN(room) ? -1 : Math.min(made[k], room);
    }
  }
  if (state.taut) for (let k = 0; k < count; k++) if (from.slack[k]) made[k] = -1;
  return made;
}

const isFailed = (status) => ![0, 5, 10].includes(status);

function drawHatches() {
  const { nx, ny, status, slack } = grid, [x0, x1] = spanOf(state.x), [y0, y1] = spanOf(state.y);
  const dx = (x1 - x0) / (nx - 1), dy = (y1 - y0) / (ny - 1);
  const made = Object.fromEntries(Object.keys(facts.hatches).map((kind) => [kind, { left: [], right: [], bottom: [], top: [] }]));
  const kindOf = (k) => (isFailed(status[k]) ? status[k] : slack[k] ? 100 + slack[k] : status[k] === 10 ? 10 : 0);
  let before = new Map(); // runs of the row below: those that go on grow
  for (let j = 0; j < ny; j++) {
    const runs = new Map(), top = Math.min(y0 + (j + 0.5) * dy, y1);
    for (let i = 0, from = 0; i < nx; i++) {
      const kind = kindOf(j * nx + i);
      if (i + 1 < nx && kindOf(j * nx + i + 1) === kind) continue;
      if (kind) {
        const key = (kind * nx + from) * nx + i, data = made[kind], old = before.get(key);
        runs.set(key, old ?? data.left.length);
        if (old !== undefined) data.top[old] = top; else {
          data.left.push(Math.max(x0 + (from - 0.5) * dx, x0));
          data.right.push(Math.min(x0 + (i + 0.5) * dx, x1));
          data.bottom.push(Math.max(y0 + (j - 0.5) * dy, y0));
          data.top.push(top);
        }
      }
      from = i + 1;
    }
    before = runs;
  }
  const seen = [];
  for (const [kind, data] of Object.entries(made)) {
    if (data.left.length) seen.push(Number(kind));
    if (data.left.length || models[`hatch_${kind}`].data.left.length) put(`hatch_${kind}`, data);
  }
  drawLegend(seen);
}

const LINES = {
  right_diagonal_line: "M0 11L8 0M6 11L14 0M12 11L20 0", left_diagonal_line: "M0 0L8 11M6 0L14 11M12 0L20 11",
  diagonal_cross: "M0 11L8 0M6 11L14 0M12 11L20 0M0 0L8 11M6 0L14 11M12 0L20 11", horizontal_line: "M0 3H18M0 8H18",
  cross: "M0 3H18M0 8H18M4 0V11M9 0V11M14 0V11", dot: "M3 3h1M9 3h1M15 3h1M6 8h1M12 8h1", ring: "M3 5h2M8 5h2M13 5h2", blank: "",
};
function drawLegend(kinds) {
  const box = byId("legend"), of = kinds.join() + state.dark;
  if (box.dataset.of === of) return;
  box.dataset.of = of;
  box.innerHTML = kinds.map((kind) => {
    const words = kind < 100 ? facts.statuses[kind].meaning : facts.slack[kind - 100], title = kind < 100 ? facts.statuses[kind].sentence : facts.slack_sentence;
    return `<span title="${title.replaceAll('"', "'")}"><svg><rect width="18" height="11" fill="${isFailed(kind) && kind < 100 ? "var(--blank)" : "none"}"/>` +
      `<path d="${LINES[facts.hatches[kind]]}" stroke="var(--quiet)" fill="none"/></svg>${words}</span>`;
  }).join("");
}

// A place of a name, drawn in from the edge of the map.
function inside(name, value) {
  const { low, high } = facts.axes[name], room = ROOM * (high - low);
  return Math.min(Math.max(value, low + room), high - room);
}

// What lies over the map: the lines and regions of both fiber angles, pins, the cross.
function drawMarks() {
  const plane = ["alpha", "beta"].includes(state.x) && ["alpha", "beta"].includes(state.y);
  const turned = state.x === "beta";
  const both = (xs, ys) => (turned ? [ys, xs] : [xs, ys]);
  const [mx, my] = plane ? both(facts.manifold.x, facts.manifold.y) : [[], []];
  put("map_manifold", { x: mx, y: my });
  put("map_manifold_line", { x: mx, y: my });
  const lines = plane ? [both([0, 90], [0, -90]), both([0, 90], [0, 90])] : [];
  // over the colours of the map, which are those of light paper until they are turned down
  const isDim = state.dark && (state.wishes.length > 0 || state.taut), on = isDim ? "#dfe3e8" : facts.colours.ink;
  put("map_lines", { xs: lines.map((one) => one[0]), ys: lines.map((one) => one[1]), ink: lines.map(() => on), dash: [[6, 3], [6, 3, 1, 3]].slice(0, lines.length) });
  const texts = plane ? facts.regions.map(([text, a, b]) => [text, ...both(a, b)]).map(([text, x, y]) => [text, inside(state.x, x), inside(state.y, y)]) : [];
  put("map_labels", { text: texts.map((one) => one[0]), x: texts.map((one) => one[1]), y: texts.map((one) => one[2]), ink: texts.map(() => on) });
  const pins = state.pins.map((pin, k) => ({ k, x: shown(state.x, at(pin)[state.x]), y: shown(state.y, at(pin)[state.y]) }));
  put("map_pins", {
    x: pins.map((one) => one.x), y: pins.map((one) => one.y), colour: pins.map((one) => colourOf(one.k)),
    edge: pins.map(() => (state.dark && !isDim ? on : "#ffffff")), size: pins.map((one) => (one.k === state.active ? 15 : 11)),
  });
  models.map_cross_glyph.glyph.setv({ line_color: { value: on } });
  put("map_cross", cross ? { x: [shown(state.x, cross[0])], y: [shown(state.y, cross[1])] } : { x: [], y: [] });
}

function windowMap() {
  const { map } = models, [x0, x1] = spanOf(state.x), [y0, y1] = spanOf(state.y);
  map.x_range.setv({ start: x0, end: x1 });
  map.y_range.setv({ start: y0, end: y1 });
  map.below[0].axis_label = withUnit(state.x);
  map.left[0].axis_label = withUnit(state.y);
  byId("map_title").textContent = withUnit(state.m);
}

// What is under the pointer, asked for anew: a value, its error, its status in words.
function askTip(x, y, sx, sy) {
  const [a, b] = [kept(state.x, x), kept(state.y, y)], tip = byId("tip");
  const inside = [[state.x, a], [state.y, b]].every(([name, v]) => v >= facts.axes[name].low && v <= facts.axes[name].high);
  if (!inside) { tip.hidden = true; return; }
  const values = { ...state.at, [state.x]: a, [state.y]: b }, measure = state.m;
  request("tip", { what: "point", at: values, measures: [measure] }, (answer) => {
    if (tip.dataset.away) return;
    const { value, error, status } = answer.measures[measure], factor = unitOf(measure)[1], unit = unitOf(measure)[0];
    const number = value === null ? (status ? "no value" : "none") : `${honest(factor * value, factor * error)}${unit === "degree" ? "°" : " " + unit}`;
    const where = [state.x, state.y].map((name) => `${labelOf(name)} ${digits(shown(name, values[name]))}${unitName(name) === "°" ? "°" : " " + unitName(name)}`);
    const words = status ? facts.statuses[status] : null;
    tip.innerHTML = `<b>${number}</b>${value === null ? "" : ` ± ${oneDigit(factor * error)}`}<small>${where.join(", ")}</small>` +
      (words ? `<small>${words.meaning}: ${words.sentence}</small>` : "") + (answer.slack && value !== null ? `<small>${facts.slack[answer.slack]}</small>` : "");
    tip.hidden = false;
    const { clientWidth: w, clientHeight: h } = byId("panel_map");
    tip.style.left = `${Math.min(sx + 24, w - tip.offsetWidth - 8)}px`;
    tip.style.top = `${sy + 46 + tip.offsetHeight > h ? sy - tip.offsetHeight + 14 : sy + 46}px`;
  });
}
