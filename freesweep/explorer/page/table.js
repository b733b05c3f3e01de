// The smaller table inside the page, read as freesweep/explorer/table.py reads it: cubics through four nodes along each axis.
const small = {};

async function unpacked(text) {
  const raw = Uint8Array.from(atob(text), (one) => one.charCodeAt(0));
  const stream = new Blob([raw]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function openTable() {
  const place = { sqrt: Math.sqrt, log: Math.log, linear: (value) => value };
  for (const [name, axis] of Object.entries(window.freesweepTable.axes)) {
    small[name] = { place: place[axis.kind], nodes: axis.nodes.map(place[axis.kind]) };
  }
  for (const table of Object.values(window.freesweepTable.tables)) {
    const planes = await unpacked(table.values), count = planes.length / 4, bytes = new Uint8Array(planes.length);
    for (let k = 0; k < count; k++) for (let b = 0; b < 4; b++) bytes[4 * k + b] = planes[b * count + k];
    table.numbers = new Float32Array(bytes.buffer);
    table.statuses = await unpacked(table.status);
    table.slacks = await unpacked(table.slack);
  }
}

// Four nodes around a place, their cubic and linear weights, and the nearest node.
function weigh(name, value) {
  const { place, nodes } = small[name], at = place(value), n = nodes.length, count = Math.min(4, n);
  const room = 1e-9 * (nodes[n - 1] - nodes[0]);
  if (!(at >= nodes[0] - room && at <= nodes[n - 1] + room)) return null;
  let piece = 0;
  while (piece < n - 2 && nodes[piece + 1] <= at) piece++;
  const first = Math.min(Math.max(piece - 1, 0), n - count), cubic = [], linear = [];
  for (let j = 0; j < count; j++) {
    let weight = 1;
    for (let k = 0; k < count; k++) if (k !== j) weight *= (at - nodes[first + k]) / (nodes[first + j] - nodes[first + k]);
    cubic.push(weight);
    linear.push(0);
  }
  const share = (at - nodes[piece]) / (nodes[piece + 1] - nodes[piece]);
  linear[piece - first] = 1 - share;
  linear[piece - first + 1] = share;
  return { first, cubic, linear, piece, share };
}

function mixed(weights, get) {
  let smooth = 0, plain = 0;
  for (let k = 0; k < weights.cubic.length; k++) {
    const value = get(k);
    if (weights.cubic[k] !== 0) smooth += weights.cubic[k] * value;
    if (weights.linear[k] !== 0) plain += weights.linear[k] * value;
  }
  return Number.isNaN(smooth) ? plain : smooth;
}

// The table of a measure with the axes in `fixed` contracted: the axes that are left, their strides, numbers, statuses.
function contracted(measure, fixed) {
  const table = window.freesweepTable.tables[measure];
  let axes = table.axes, numbers = table.numbers, statuses = table.statuses, slacks = table.slacks;
  for (const name of [...axes].reverse().filter((one) => one in fixed)) {
    const k = axes.indexOf(name), size = (one) => small[one].nodes.length;
    const inner = axes.slice(k + 1).reduce((all, one) => all * size(one), 1);
    const outer = axes.slice(0, k).reduce((all, one) => all * size(one), 1), n = size(name);
    const weights = weigh(name, fixed[name]), made = new Float64Array(outer * inner), codes = new Uint8Array(outer * inner);
    const loose = new Uint8Array(outer * inner);
    for (let o = 0; o < outer; o++) for (let i = 0; i < inner; i++) {
      const node = (j) => (o * n + weights.first + j) * inner + i, to = o * inner + i;
      if (weights === null) { made[to] = NaN; codes[to] = 8; continue; }
      made[to] = mixed(weights, (j) => numbers[node(j)]);
      const left = weights.piece - weights.first, near = node(left + (weights.share > 0.5 ? 1 : 0));
      codes[to] = failing(statuses[near], weights.share > 0 ? statuses[node(left + (weights.share > 0.5 ? 0 : 1))] : 0);
      loose[to] = slacks[near];
    }
    [axes, numbers, statuses, slacks] = [axes.filter((one) => one !== name), made, codes, loose];
  }
  return { axes, numbers, statuses, slacks };
}

const failing = (one, other) => (one !== 0 && one !== 5 && one !== 10 ? one : other !== 0 && other !== 5 && other !== 10 ? other : one);

const stridesOf = (axes) => axes.map((_, k) => axes.slice(k + 1).reduce((all, one) => all * small[one].nodes.length, 1));
const nearest = (weights, strides) => weights.reduce((all, w, d) => all + (w.piece + (w.share > 0.5 ? 1 : 0)) * strides[d], 0);

function summed(numbers, weights, strides, d = 0, offset = 0) {
  if (d === weights.length) return numbers[offset];
  return mixed(weights[d], (j) => summed(numbers, weights, strides, d + 1, offset + (weights[d].first + j) * strides[d]));
}

function scaleOf(measure, values) {
  let size = 1;
  for (const [name, power] of Object.entries(window.freesweepTable.tables[measure].scale)) size *= values[name] ** power;
  return size;
}

function readSmall(measure, values) {
  const table = window.freesweepTable.tables[measure], weights = table.axes.map((name) => weigh(name, values[name]));
  if (weights.includes(null)) return { value: NaN, status: 8, slack: 0 };
  const strides = stridesOf(table.axes), value = scaleOf(measure, values) * summed(table.numbers, weights, strides), near = nearest(weights, strides);
  return { value, status: Number.isFinite(value) ? 0 : table.statuses[near] || 9, slack: table.slacks[near] };
}

// What the table may be off, from what it was off at places around when the page was made.
function errorOf(measure, value, values) {
  const floor = facts.floors[measures.get(measure).unit] || 0, { bins, axes, tables } = window.freesweepTable;
  const bin = Object.keys(axes).slice(0, bins.length).reduce((all, name, k) => {
    const { low, high } = facts.axes[name], at_ = Math.floor((bins[k] * (values[name] - low)) / (high - low));
    return all * bins[k] + Math.min(Math.max(at_, 0), bins[k] - 1);
  }, 0);
  return tables[measure].deviation[bin] * Math.max(Math.abs(value), floor);
}

function told(measure, values) {
  const { value, status } = readSmall(measure, values);
  return Number.isFinite(value) ? { value, error: errorOf(measure, value, values), status } : { value: null, error: null, status };
}

const slackAt = (values) => {
  const name = facts.measures.map((one) => one.name).find((one) => ["rotation", "deformed_length", "mid_radius"].includes(one));
  return name ? readSmall(name, values).slack : 0;
};

function localGrid({ x, y, nx, ny, at: fixed, measures: wanted }) {
  const others = Object.fromEntries(Object.entries(fixed).filter(([name]) => name !== x && name !== y));
  const along = (name, count) => Array.from({ length: count }, (_, k) => {
    const { low, high } = facts.axes[name];
    return weigh(name, low + ((high - low) * k) / (count - 1));
  });
  const wx = along(x, nx), wy = along(y, ny), none = { first: 0, cubic: [1], linear: [1], piece: 0, share: 0 };
  const answer = { nx, ny, values: {}, status: new Uint8Array(nx * ny), slack: new Uint8Array(nx * ny) };
  const state_ = ["rotation", "deformed_length", "mid_radius"].find((one) => measures.has(one));
  for (const measure of new Set([...wanted, ...(state_ ? [state_] : [])])) {
    const { axes, numbers, statuses, slacks } = contracted(measure, others);
    const stride = (name) => (axes.indexOf(name) < 0 ? 0 : axes.indexOf(name) === axes.length - 1 ? 1 : small[axes[1]].nodes.length);
    const sx = stride(x), sy = stride(y), values = new Float32Array(nx * ny);
    const value = (name, k, n) => facts.axes[name].low + ((facts.axes[name].high - facts.axes[name].low) * k) / (n - 1);
    for (let j = 0; j < ny; j++) for (let i = 0; i < nx; i++) {
      const size = scaleOf(measure, { ...fixed, [x]: value(x, i, nx), [y]: value(y, j, ny) });
      const a = sx ? wx[i] : none, b = sy ? wy[j] : none, to = j * nx + i;
      values[to] = size * mixed(b, (q) => mixed(a, (p) => numbers[(a.first + p) * sx + (b.first + q) * sy]));
      const near = (w) => w.piece + (w.share > 0.5 ? 1 : 0), at_ = near(a) * sx + near(b) * sy;
      if (measure === wanted[0]) answer.status[to] = Number.isFinite(values[to]) ? 0 : statuses[at_] || 9;
      if (measure === state_) answer.slack[to] = slacks[at_];
    }
    if (wanted.includes(measure)) answer.values[measure] = values;
  }
  return answer;
}

function localPins({ pins, at: fixed, measures: wanted, curves, n = 81 }) {
  const { low, high } = facts.axes[facts.along], root = low >= 0;
  const nodes = Float64Array.from({ length: n }, (_, k) => (root ? (Math.sqrt(low) + ((Math.sqrt(high) - Math.sqrt(low)) * k) / (n - 1)) ** 2
    : low + ((high - low) * k) / (n - 1)));
  nodes[n - 1] = high;
  const answer = { along: facts.along, nodes, pins: [], curves: [] };
  for (const pin of pins) {
    const values = { ...fixed, ...pin };
    answer.pins.push({ measures: Object.fromEntries(wanted.map((one) => [one, told(one, values)])), slack: slackAt(values) });
    answer.curves.push(Object.fromEntries(curves.map((one) => {
      const line = [...nodes].map((node) => ({ ...values, [facts.along]: node }));
      const value = Float64Array.from(line, (place) => readSmall(one, place).value);
      return [one, { value, error: value.map((number) => errorOf(one, number, values)), slack: Uint8Array.from(line, slackAt) }];
    })));
  }
  return answer;
}

function localCloud({ n, at: fixed, measures: wanted }) {
  const free = facts.design_axes, designs = {};
  let g = 2;
  for (let k = 0; k < 60; k++) g = (1 + g) ** (1 / (free.length + 1));
  free.forEach((name, d) => {
    const { low, high } = facts.axes[name];
    designs[name] = Float64Array.from({ length: n }, (_, k) => low + (high - low) * ((0.5 + (k + 1) * g ** -(d + 1)) % 1));
  });
  const loads = Object.fromEntries(Object.entries(fixed).filter(([name]) => !free.includes(name)));
  const values = {}, slack = new Uint8Array(n);
  for (const measure of wanted) {
    const part = contracted(measure, loads), found = new Float32Array(n);
    const strides = stridesOf(part.axes);
    for (let k = 0; k < n; k++) {
      const weights = part.axes.map((name) => weigh(name, designs[name][k]));
      found[k] = scaleOf(measure, { ...fixed, ...Object.fromEntries(free.map((name) => [name, designs[name][k]])) }) * summed(part.numbers, weights, strides);
      slack[k] |= part.slacks[nearest(weights, strides)];
    }
    values[measure] = found;
  }
  return { designs, values, slack };
}

let opened = null; // questions that come meanwhile wait for the same

async function answerLocally(question) {
  await (opened ??= openTable());
  const point = ({ at: values, measures: wanted }) =>
    ({ measures: Object.fromEntries(wanted.map((one) => [one, told(one, values)])), slack: slackAt(values) });
  const ways = { grid: localGrid, point, pins: localPins, cloud: localCloud };
  if (!(question.what in ways)) throw new Error("this page has no solver; open the atlas with freesweep explore");
  return ways[question.what](question);
}
