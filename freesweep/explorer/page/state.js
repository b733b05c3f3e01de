// What is shown: one object, its link, and who hears of changes.
const facts = window.freesweepFacts;
const measures = new Map(facts.measures.map((one) => [one.name, one]));
const axisNames = Object.keys(facts.axes);
const MOST_PINS = 5;

function initial() {
  const at = {};
  for (const [name, axis] of Object.entries(facts.axes)) {
    at[name] = name === "pressure" ? axis.low + 0.5 * (axis.high - axis.low)
      : ["force", "torque", "held_rotation"].includes(name) ? Math.min(Math.max(0, axis.low), axis.high)
      : axis.root === false && axis.low > 0 ? Math.sqrt(axis.low * axis.high) : 0.5 * (axis.low + axis.high);
  }
  if (facts.designs.length) at.design = 0;
  const both = facts.axes.alpha && facts.axes.beta;
  const [x, y] = both ? ["alpha", "beta"] : axisNames.slice(0, 2);
  const names = facts.measures.map((one) => one.name);
  return {
    m: names[0], x, y, at, u: 1, dark: matchMedia("(prefers-color-scheme: dark)").matches, pins: [], active: 0, wishes: [],
    taut: false, fx: names[0], fy: names[1] || names[0], dx: 1, dy: -1, cloud: "map", view: [0.5, 0.35],
  };
}

const state = initial();
const colourOf = (k) => (state.dark ? facts.colours.on_dark : facts.colours.series)[k]; // of a pinned design
const hearers = [];

// Numbers of a design in as many digits as leave the page: what is exported is what is shown.
const DIGITS = 12;
function tidy(values) {
  return Object.fromEntries(Object.entries(values).map(([name, value]) => {
    const axis = facts.axes[name], short = Number(Number(value).toPrecision(DIGITS));
    return [name, axis ? Math.min(Math.max(short, axis.low), axis.high) : value];
  }));
}

// Change the view; `drag`: more of the same will follow at once.
function change(patch, drag = false) {
  Object.assign(state, patch);
  if ("at" in patch) state.at = tidy(state.at);
  if ("pins" in patch) state.pins = state.pins.map(tidy);
  for (const hear of hearers) hear(Object.keys(patch), drag);
  if (!drag) history.replaceState(null, "", "#" + link());
}

// Values where a design or a load is told: sliders, and what a pin has of its own.
function at(pin = {}) {
  return { ...state.at, ...pin };
}

function link() {
  const words = new URLSearchParams();
  const list = (object) => Object.entries(object).map(([name, value]) => `${name}:${value}`).join(",");
  const { m, x, y, u, fx, fy, dx, dy, cloud, active } = state;
  for (const [key, value] of Object.entries({ m, x, y, u, fx, fy, dx, dy, cloud, active })) words.set(key, value);
  words.set("at", list(state.at));
  if (state.dark) words.set("dark", 1);
  if (state.taut) words.set("taut", 1);
  if (state.pins.length) words.set("pins", state.pins.map(list).join(";"));
  const open = (end) => (end === null ? "" : end);
  if (state.wishes.length) {
    words.set("wishes", state.wishes.map((one) => `${one.measure}:${open(one.low)}:${open(one.high)}`).join(";"));
  }
  return words.toString().replaceAll("%3A", ":").replaceAll("%2C", ",").replaceAll("%3B", ";");
}

// Read a link; what it names and this atlas lacks is left out.
function follow(text) {
  const words = new URLSearchParams(text);
  const known = (key, names) => { if (names.includes(words.get(key))) state[key] = words.get(key); };
  const names = [...measures.keys()];
  for (const key of ["m", "fx", "fy"]) known(key, names);
  for (const key of ["x", "y"]) known(key, axisNames);
  if (state.x === state.y) state.y = axisNames.find((name) => name !== state.x);
  known("cloud", ["map", "all"]);
  if (["0", "1", "2"].includes(words.get("u"))) state.u = Number(words.get("u"));
  for (const key of ["dx", "dy"]) if (["1", "-1"].includes(words.get(key))) state[key] = Number(words.get(key));
  if (words.size) { state.dark = words.has("dark"); state.taut = words.has("taut"); }
  const read = (list) => {
    const found = {};
    for (const [name, value] of (list || "").split(",").map((one) => one.split(":"))) {
      const number = Number(value), axis = facts.axes[name];
      if (axis && value && isFinite(number)) found[name] = Math.min(Math.max(number, axis.low), axis.high);
      if (name === "design" && number in facts.designs) found[name] = number;
    }
    return found;
  };
  Object.assign(state.at, read(words.get("at")));
  if (words.has("pins")) {
    state.pins = words.get("pins").split(";").slice(0, MOST_PINS).map(read)
      .filter((pin) => facts.design_axes.every((name) => name in pin));
    state.active = Math.min(Math.max(Number(words.get("active")) || 0, 0), Math.max(state.pins.length - 1, 0));
  }
  if (words.has("wishes")) {
    const end = (word) => (word === "" || !isFinite(Number(word)) ? null : Number(word));
    state.wishes = words.get("wishes").split(";").map((one) => one.split(":")).filter(([name]) => measures.has(name))
      .map(([measure, low = "", high = ""]) => ({ measure, low: end(low), high: end(high) }));
  }
}
