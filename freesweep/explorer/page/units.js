// Numbers as a designer reads them. Everything is kept in SI units and degrees; shown = factor * kept.
const byId = (id) => document.getElementById(id);

function unitOf(name) {
  const unit = measures.has(name) ? measures.get(name).unit : facts.units_of[name];
  return facts.units[unit][state.u];
}

const shown = (name, value) => unitOf(name)[1] * value;
const kept = (name, value) => value / unitOf(name)[1];

function labelOf(name) {
  if (measures.has(name)) return measures.get(name).label;
  return { alpha: "α", beta: "β", c10: "C10", c01: "C01" }[name] || name.replaceAll("_", " ");
}

function withUnit(name) {
  const [unit] = unitOf(name);
  return unit ? `${labelOf(name)} [${unit === "degree" ? "°" : unit}]` : labelOf(name);
}

const minus = (text) => text.replace("-", "−");

function digits(value, count = 4) {
  if (value === null || value === undefined || !isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size < -4 || size > 6) return minus(value.toExponential(Math.max(count - 1, 0)));
  const places = Math.max(count - 1 - size, 0);
  const text = value.toFixed(places);
  return minus(places ? text.replace(/\.?0+$/, "") : text);
}

// A value to the digit that its error leaves.
function honest(value, error) {
  if (!isFinite(value) || value === null) return "–";
  const size = error > 0 ? Math.floor(Math.log10(error)) : -6;
  return minus(value.toFixed(Math.min(Math.max(-size, 0), Math.max(3 - Math.floor(Math.log10(Math.abs(value) || 1)), 0))));
}

const oneDigit = (error) => (error > 0 ? digits(error, 1) : "0");

// "12 mm", "15 psi", "1 bar", or a plain number in the unit that is shown; NaN if it is none.
function readShown(name, text) {
  const match = /^\s*([+\-−]?[0-9.]+(?:[eE][+-]?[0-9]+)?)\s*(.*?)\s*$/.exec(text);
  if (!match) return NaN;
  const number = Number(match[1].replace("−", "-"));
  const unit = measures.has(name) ? measures.get(name).unit : facts.units_of[name];
  const own = match[2] && facts.units[unit].find(([word]) => word === match[2]); // also of what no text of Python has: mL, %
  const factor = own ? 1 / own[1] : facts.written[unit][match[2].replace("µ", "u").replace("²", "2")];
  return match[2] ? number * (factor ?? NaN) : kept(name, number);
}
