// Shapes of pinned designs, in section and in space: solved ones where the solver has spoken, sketches of the atlas' numbers till
// then (length, radius at half length, rotation; the way from the clamped ends to the middle is drawn, not computed).
const STATIONS = 121, ENDS = 0.8; // of a radius: how far the drawn ends of a sketch reach
const shapes = new Map();
const needsShape = () => ["deformed_length", "mid_radius", "rotation"].filter((name) => measures.has(name));

// Where the fibers of a design (all its numbers) lie at rest, at a share of the length: a body has a taper and a bulge.
function fiberRadius(all, share = 0.5) {
  const body = (1 - (all.taper ?? 0) * share) * (1 + (all.bulge ?? 0) * Math.sin(Math.PI * share) ** 2);
  return all.fiber_radius ?? all.radius * body + Math.max(facts.fiber_share, 0) * all.wall;
}

function sketch(all, length, middle, rotation) {
  const r0 = fiberRadius(all), reach = ENDS * Math.max(middle, r0);
  const share = Array.from({ length: STATIONS }, (_, k) => k / (STATIONS - 1));
  const rise = (z) => (middle - r0) * (1 - Math.exp(-z / reach)) * (1 - Math.exp(-(length - z) / reach)) / (1 - Math.exp(-length / 2 / reach)) ** 2;
  const twist = share.map((s) => (s * rotation * Math.PI) / 180), angle = (name) => ((all[name] ?? 0) * Math.PI) / 180;
  const fibers = ["alpha", "beta"].map((name) => share.map((s, k) => (Math.tan(angle(name)) * all.length * s) / r0 + twist[k]));
  const counts = ["alpha", "beta"].map((name) => (facts.families.includes(name) ? Math.max(2, Math.round(14 * Math.cos(angle(name)))) : 0));
  return { radius: share.map((s) => 1e3 * (fiberRadius(all, s) + rise(s * length))), position: share.map((s) => 1e3 * s * length), twist, fibers, counts };
}

// { rest, state, isSolved } of a pin, null while nothing is known of it.
function shapeOf(k) {
  const design = state.pins[k], all = whole(design);
  if (all.length === undefined || all.radius === undefined) return null;
  const solved = shapes.get(keyOf(design));
  if (solved && solved.state) return { rest: solved.rest, state: solved.state, isSolved: true };
  const [length, middle, rotation] = ["deformed_length", "mid_radius", "rotation"].map((name) => pinned.pins[k]?.measures[name]?.value ?? null);
  const rest = sketch(all, all.length, fiberRadius(all), 0);
  return { rest, state: length === null || middle === null ? null : sketch(all, length, middle, rotation ?? 0), isSolved: false };
}

function askShapes() {
  if (isLocal || !facts.in_numbers) return;
  const open = state.pins.filter((design) => !shapes.has(keyOf(design)));
  const order = [state.pins[state.active], ...open].filter((design) => design && open.includes(design));
  if (!order.length) return;
  const design = order[0], key = keyOf(design);
  request("shape", { what: "shape", at: at(design) }, (answer) => {
    shapes.set(key, answer);
    drawShapes();
    askShapes();
  });
}

function drawShapes() {
  drawSection();
  drawSpace();
}

const inUnits = (mm) => shown("length", mm / 1e3);

// All pins below each other, to one scale; the outline at rest in grey.
function drawSection() {
  const rest = { xs: [], ys: [], ink: [] }, wall = { xs: [], ys: [], colour: [], alpha: [] }, words = { x: [], y: [], text: [], ink: [] };
  const made = state.pins.map((_, k) => shapeOf(k));
  let below = 0, right = 0, sketches = 0;
  const tall = made.map((one) => (one ? Math.max(...one.rest.radius, ...(one.state?.radius || [])) : 0)), gap = 0.5 * Math.max(...tall, 0);
  made.forEach((one, k) => {
    if (!one) return;
    const middle = below - tall[k];
    const outline = ({ position, radius }) => [[...position, ...[...position].reverse(), position[0]].map(inUnits), [...[...radius].map((r) => middle + r), ...[...radius].reverse().map((r) => middle - r), middle + radius[0]].map(inUnits)];
    if (one.state) {
      const [xs, ys] = outline(one.state);
      wall.xs.push(xs); wall.ys.push(ys); wall.colour.push(colourOf(k)); wall.alpha.push(k === state.active ? 0.42 : 0.22);
    }
    const [xs, ys] = outline(one.rest);
    rest.xs.push(xs); rest.ys.push(ys); rest.ink.push(css("--quiet"));
    const rotation = valueOf(k, "rotation")?.value;
    const end = Math.max(one.rest.position[STATIONS - 1], one.state ? one.state.position[STATIONS - 1] : 0);
    words.x.push(inUnits(end * 1.02)); words.y.push(inUnits(middle)); words.ink.push(css("--ink"));
    words.text.push(one.state ? (Number.isFinite(rotation) ? `${digits(rotation, 3)}°` : "") : "no state");
    right = Math.max(right, end * 1.24);
    sketches += one.isSolved ? 0 : 1;
    below = middle - tall[k] - gap;
  });
  put("section_rest", rest); put("section_wall", wall); put("section_text", words);
  models.section.below[0].axis_label = `axial position [${facts.units.m[state.u][0]}]`;
  fit("section", inUnits(-0.03 * right), inUnits(right || 100), inUnits(below + gap * 0.5 || -30), inUnits(gap * 0.5 || 30));
  byId("section_note").textContent = state.pins.length ? (sketches ? "sketched, not solved" : "solved") : "";
}

// Limits of a figure that shows both directions to one scale, the window in its middle.
function fit(name, x0, x1, y0, y1) {
  const model = models[name], w = model.inner_width || 300, h = model.inner_height || 200;
  const scale = Math.max((x1 - x0) / w, (y1 - y0) / h), cx = 0.5 * (x0 + x1), cy = 0.5 * (y0 + y1);
  model.x_range.setv({ start: cx - 0.5 * scale * w, end: cx + 0.5 * scale * w });
  model.y_range.setv({ start: cy - 0.5 * scale * h, end: cy + 0.5 * scale * h });
}

const AROUND = 30, ALONG = 30;

// The active pin in space, seen from where `state.view` says: turned about its axis, then slanted.
function drawSpace() {
  const one = state.pins.length ? shapeOf(state.active) : null, shape = one && (one.state || one.rest);
  const wall = { xs: [], ys: [], colour: [] }, lines = { xs: [], ys: [], colour: [], alpha: [], width: [] };
  byId("space_note").textContent = one ? `${one.state ? "" : "at rest, "}drag to turn` : "";
  if (!shape) { put("space_wall", wall); put("space_threads", lines); return; }
  const [slant, roll] = state.view, c = Math.cos(slant), s = Math.sin(slant), half = 0.5 * shape.position[STATIONS - 1];
  const seen = (z, r, theta) => {
    const across = r * Math.sin(theta + roll), depth = r * Math.cos(theta + roll);
    return [(z - half) * c - depth * s, across, (z - half) * s + depth * c];
  };
  const steps = Array.from({ length: ALONG + 1 }, (_, k) => Math.round((k * (STATIONS - 1)) / ALONG));
  const tint = hex(one.state ? facts.colours.after[1] : facts.colours.before[1]), paper = state.dark ? 70 : 255;
  const faces = [];
  for (let a = 0; a < ALONG; a++) for (let t = 0; t < AROUND; t++) {
    const [i, j] = [steps[a], steps[a + 1]], [u, v] = [(2 * Math.PI * t) / AROUND, (2 * Math.PI * (t + 1)) / AROUND];
    const corners = [[i, u], [j, u], [j, v], [i, v]].map(([k, theta]) => seen(shape.position[k], shape.radius[k], theta));
    const slope = (shape.radius[j] - shape.radius[i]) / Math.max(Math.abs(shape.position[j] - shape.position[i]), 1e-6), m = 0.5 * (u + v) + roll;
    const size = Math.hypot(1, slope), normal = [(-slope * c - Math.cos(m) * s) / size, Math.sin(m) / size, (-slope * s + Math.cos(m) * c) / size];
    if (normal[2] <= 0) continue;
    const bright = Math.max(0.25 * normal[0] + 0.62 * normal[1] + 0.72 * normal[2], 0);
    const share = 0.5 + 0.34 * (1 - Math.min(bright, 1)), colour = tint.map((part) => Math.round(part * share + paper * (1 - share)));
    faces.push([corners.reduce((sum, corner) => sum + corner[2], 0), corners, `rgb(${colour})`]);
  }
  faces.sort((p, q) => p[0] - q[0]);
  for (const [, corners, colour] of faces) {
    wall.xs.push(corners.map((one_) => inUnits(one_[0]))); wall.ys.push(corners.map((one_) => inUnits(one_[1]))); wall.colour.push(colour);
  }
  shape.fibers.forEach((turn, family) => {
    // steep threads turn far between two stations: as many places as make them round
    const fine = Math.min(Math.max(Math.ceil(Math.abs(turn[STATIONS - 1] - turn[0]) / (STATIONS - 1) / 0.25), 1), 24);
    const between = (list, k) => { const i = Math.min(Math.floor(k / fine), STATIONS - 2), share = k / fine - i; return (1 - share) * list[i] + share * list[i + 1]; };
    const count = shape.counts[family], colour = (one.state ? facts.colours.after[0] : facts.colours.before[0]);
    for (let f = 0; f < count; f++) {
      let xs = [], ys = [];
      const flush = () => {
        if (xs.length > 1) { lines.xs.push(xs); lines.ys.push(ys); lines.colour.push(family ? facts.colours.families[1] : colour); lines.alpha.push(0.95); lines.width.push(1.1); }
        [xs, ys] = [[], []];
      };
      for (let k = 0; k <= (STATIONS - 1) * fine; k++) {
        const theta = between(turn, k) + (2 * Math.PI * (f + 0.5)) / count, [x, y] = seen(between(shape.position, k), between(shape.radius, k) * 1.004, theta);
        if (Math.cos(theta + roll) * c - slopeAt(shape, Math.floor(k / fine)) * s > 0) { xs.push(inUnits(x)); ys.push(inUnits(y)); } else flush();
      }
      flush();
    }
  });
  const last = STATIONS - 1, r = shape.radius[last], near = s > 0 ? last : 0;
  const disc = Array.from({ length: 49 }, (_, k) => seen(shape.position[near], shape.radius[near], (2 * Math.PI * k) / 48));
  wall.xs.push(disc.map((one_) => inUnits(one_[0]))); wall.ys.push(disc.map((one_) => inUnits(one_[1]))); wall.colour.push(state.dark ? "#565c66" : "#d8d5ce");
  if (near === last) {
    const notch = [0.25, 1].map((q) => seen(shape.position[last], q * r, Math.PI / 2 - roll * 0 + shape.twist[last]));
    lines.xs.push(notch.map((one_) => inUnits(one_[0]))); lines.ys.push(notch.map((one_) => inUnits(one_[1])));
    lines.colour.push(state.dark ? "#ffffff" : facts.colours.ink); lines.alpha.push(1); lines.width.push(2);
  }
  put("space_wall", wall); put("space_threads", lines);
  const reach = Math.hypot(half, Math.max(...shape.radius)) * 1.04;
  fit("space", inUnits(-reach), inUnits(reach), inUnits(-1.3 * Math.max(...shape.radius)), inUnits(1.3 * Math.max(...shape.radius)));
}

const slopeAt = (shape, k) => {
  const [i, j] = [Math.max(k - 1, 0), Math.min(k + 1, STATIONS - 1)], step = shape.position[j] - shape.position[i];
  return (shape.radius[j] - shape.radius[i]) / (Math.abs(step) < 1e-9 ? 1e-9 : step);
};
