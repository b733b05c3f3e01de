// From numbers on a grid to pixels: bands of colour between round numbers, lines between bands, what is not lit turned down.
const BANDS = 16;
const require_ = (name) => Bokeh.require(name);

function niceStep(span, count) {
  const raw = span / count, power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 2.5, 5, 10].map((one) => one * power).find((one) => one >= raw * 0.999);
}

// Bands for some shown values: first boundary, step, colours.
function bandsOf(values, centre) {
  const finite = values.filter((one) => Number.isFinite(one)).sort();
  let low = finite.length ? finite[Math.floor(0.05 * (finite.length - 1))] : 0;
  let high = finite.length ? finite[Math.ceil(0.95 * (finite.length - 1))] : 1;
  if (centre !== null) { low = Math.min(low, centre); high = Math.max(high, centre); }
  if (!(high - low > 1e-12 * Math.max(Math.abs(low), Math.abs(high)))) {
    const room = 0.01 * Math.abs(high) || 1;
    [low, high] = [low - room, high + room];
  }
  const step = niceStep(high - low, BANDS), from = Math.floor(low / step + 1e-6), to = Math.ceil(high / step - 1e-6);
  const reach = centre === null ? 0 : Math.max(centre - from * step, to * step - centre);
  const colours = [];
  for (let k = from; k < to; k++) {
    const middle = (k + 0.5) * step;
    const share = centre === null ? (k + 0.5 - from) / (to - from) : 0.5 + (0.5 * (middle - centre)) / reach;
    const all = centre === null ? facts.colours.sequential : facts.colours.diverging;
    colours.push(all[Math.round(Math.min(Math.max(share, 0), 1) * (all.length - 1))]);
  }
  return { low: from * step, step, colours, isEmpty: !finite.length };
}

// Values between the places of a grid (nx, ny), f pixels for each; NaN next to NaN.
function finer(values, nx, ny, f) {
  const w = (nx - 1) * f + 1, h = (ny - 1) * f + 1, made = new Float32Array(w * h);
  for (let r = 0; r < h; r++) {
    const j = Math.min(Math.floor(r / f), ny - 2), b = r / f - j;
    for (let c = 0; c < w; c++) {
      const i = Math.min(Math.floor(c / f), nx - 2), a = c / f - i, k = j * nx + i;
      const v = (1 - b) * ((1 - a) * values[k] + a * values[k + 1]) + b * ((1 - a) * values[k + nx] + a * values[k + nx + 1]);
      made[r * w + c] = Number.isNaN(v) ? values[(b > 0.5 ? k + nx : k) + (a > 0.5 ? 1 : 0)] : v;
    }
  }
  return { w, h, values: made };
}

const hex = (text) => [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const packed = ([r, g, b], alpha = 255) => ((alpha << 24) | (b << 16) | (g << 8) | r) >>> 0;

// RGBA pixels of a fine grid; `lit` (same shape): above zero where all wishes are met, null without wishes.
function pixels({ w, h, values }, bands, lit) {
  const paper = hex(state.dark ? "#1b1f26" : "#ffffff"), ink = hex(state.dark ? "#f4f6f8" : facts.colours.ink);
  const mix = (colour, other, share) => colour.map((part, k) => Math.round(part * (1 - share) + other[k] * share));
  const dim = (colour) => {
    const grey = colour[0] * 0.3 + colour[1] * 0.59 + colour[2] * 0.11;
    return mix(mix(colour, [grey, grey, grey], 0.6), paper, 0.72);
  };
  const plain = bands.colours.map((one) => packed(one)), line = bands.colours.map((one) => packed(mix(one, [0, 0, 0], 0.2)));
  const faint = bands.colours.map((one) => packed(dim(one))), edge = packed(ink), last = plain.length - 1;
  const made = new Uint32Array(w * h), band = new Int16Array(w * h);
  for (let k = 0; k < made.length; k++) {
    const value = values[k];
    band[k] = Number.isNaN(value) ? -1 : Math.min(Math.max(Math.floor((value - bands.low) / bands.step), 0), last);
  }
  for (let r = 0; r < h; r++) for (let c = 0; c < w; c++) {
    const k = r * w + c, own = band[k];
    if (own < 0) continue;
    const right = c + 1 < w ? k + 1 : k, above = r + 1 < h ? k + w : k;
    const isOn = lit === null || lit[k] >= 0;
    if (lit !== null && (isOn !== (lit[right] >= 0) || isOn !== (lit[above] >= 0))) { made[k] = edge; continue; }
    const other = (at_) => band[at_] >= 0 && band[at_] !== own;
    made[k] = !isOn ? faint[own] : other(right) || other(above) ? line[own] : plain[own];
  }
  return made;
}

function pixelColumn(numbers, w, h) {
  const { ndarray } = require_("core/util/ndarray");
  return ndarray(numbers, { dtype: "uint32", shape: [h, w] });
}
