// What leaves the page: pictures of panels, pinned designs as text, the link.
function download(name, content, type) {
  const place = document.createElement("a");
  place.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
  place.download = name;
  place.click();
  setTimeout(() => URL.revokeObjectURL(place.href), 10000);
}

// A panel as a Blob, on the paper of the page.
async function pictureOf(panel, kind) {
  const model = models[panel], view = viewOf(model), before = model.border_fill_color, paper = css("--panel");
  model.setv({ border_fill_color: paper, background_fill_color: paper });
  const layer = view.export(kind === "svg" ? "svg" : "png");
  model.setv({ border_fill_color: before, background_fill_color: null });
  if (kind === "svg") return new Blob([layer.ctx.get_serialized_svg(true)], { type: "image/svg+xml" });
  return new Promise((resolve) => layer.canvas.toBlob(resolve, "image/png"));
}

const viewOf = (model) => Bokeh.index.get_one ? Bokeh.index.find_one(model) ?? Bokeh.index.get_one(model) : Bokeh.index[model.id];

async function savePanel(panel, kind) {
  download(`freesweep-${panel}.${kind}`, await pictureOf(panel, kind));
}

// All parameters of a pinned design, kept units.
function whole(design) {
  const own = Object.fromEntries(Object.entries(facts.by_design).map(([name, list]) => [name, list[design.design ?? state.at.design]]));
  return { fiber_extension: 1, c01: 0, c20: 0, c30: 0, ...facts.fixed, ...own, ...at(design) };
}
const plainNumber = (value) => String(Number(Number(value).toPrecision(DIGITS)));
const LOADS = ["pressure", "force", "torque"];
const SIZES = ["alpha", "beta", "length", "radius", "wall"], SHAPE = ["taper", "bulge"]; // of tubes, and of bodies besides
const SOURCE = { energy: "full", wall_model: "membrane", fibers: "bonded", fiber_radius: "inner" };

function parts(values) {
  const own = { ...facts.model };
  if ("fiber_radius" in values) own.fiber_radius = values.fiber_radius;
  return Object.entries(SOURCE).filter(([name, usual]) => own[name] !== usual).map(([name]) => [name, own[name]]);
}

// A size as an actuator takes it: a number, a rule with its number, or null of a family of fibers that there is not.
function given(values, name) {
  if (["alpha", "beta"].includes(name) && !facts.families.includes(name)) return null;
  return facts.rules[name] ? `${facts.rules[name]} ${plainNumber(values[name])} ${name === "wall" ? "m" : "deg"}` : values[name];
}

const sizesOf = (values) => [...SIZES, ...SHAPE.filter((name) => values[name])].map((name) => [name, given(values, name)]);

function rubberOf({ c10, c01, c20, c30 }) {
  return c20 || c30 ? ["Yeoh", { c1: c10, c2: c20, c3: c30 }] : ["MooneyRivlin", { c10, c01 }];
}

function asPython() {
  const lines = ["import freesweep as fs", "", "tubes = ["];
  for (const design of state.pins) {
    const values = whole(design), [rubber, constants] = rubberOf(values);
    const word = (value) => (value === null ? "None" : typeof value === "string" ? `"${value}"` : plainNumber(value));
    const list = (pairs) => pairs.map(([name, value]) => `${name}=${word(value)}`).join(", ");
    const extension = values.fiber_extension !== 1 ? [["fiber_extension", values.fiber_extension]] : [];
    lines.push(`    fs.Actuator(${list(sizesOf(values))}, material=fs.${rubber}(${list(Object.entries(constants))})${[...extension, ...parts(values)].map((pair) => `, ${list([pair])}`).join("")}),`);
  }
  const values = whole(state.pins[0]), loads = LOADS.map((name) => plainNumber(values[name] ?? 0)).join(", ");
  return [...lines, "]", `states = [fs.inflate(tube, ${loads}) for tube in tubes]  # pressure [Pa], force [N], torque [N m]`, ""].join("\n");
}

function asShell() {
  const units = { alpha: "deg", beta: "deg", length: "m", radius: "m", wall: "m", c10: "Pa", c01: "Pa", c20: "Pa", c30: "Pa", pressure: "Pa", force: "N", torque: "N m" };
  return state.pins.map((design) => {
    const values = whole(design), names = ["c10", ...["c01", "c20", "c30", "force", "torque"].filter((name) => values[name]), "pressure"];
    const word = (name, value) => (value === null ? "none" : typeof value === "string" ? value : `${plainNumber(value)} ${units[name] ?? ""}`.trim());
    const words = [...sizesOf(values), ...names.map((name) => [name, values[name] ?? 0])].map(([name, value]) => `--${name} "${word(name, value)}"`);
    if (values.fiber_extension !== 1) words.push(`--fiber-extension ${plainNumber(values.fiber_extension)}`);
    for (const [name, value] of parts(values)) words.push(`--${name.replaceAll("_", "-")} ${typeof value === "string" ? value : `"${plainNumber(value)} m"`}`);
    return `freesweep inflate ${words.join(" ")}`;
  }).join("\n") + "\n";
}

function asToml() {
  const first = whole(state.pins[0]), own = [...facts.design_axes.filter((name) => name !== "fiber_radius" || "fiber_radius" in first), ...Object.keys(facts.by_design)];
  const word = (value) => (typeof value === "string" ? `"${value}"` : plainNumber(value));
  for (const name of own) if (facts.rules[name]) throw new Error(`a list of designs is of numbers, and ${name} is ${facts.rules[name]}: take Python or shell`);
  const every = [...SIZES, ...SHAPE, "fiber_radius", "fiber_extension", "c10", "c01", "c20", "c30"];
  const shared = every.filter((name) => !own.includes(name) && (name in facts.fixed || given(first, name) === null));
  const words = parts({}).map(([name, value]) => `${name} = "${value}"`);
  const { high } = facts.axes.pressure || { high: first.pressure };
  return [
    'title = "Designs pinned in the explorer"', "", "[actuator]", ...shared.map((name) => `${name} = ${word(given(first, name) ?? "none")}`), ...words, "",
    "[load]", ...["force", "torque"].map((name) => `${name} = ${plainNumber(first[name] ?? 0)}`), "",
    "[axes]", `pressure = { start = 0.0, stop = ${plainNumber(high)}, num = 41 }`, "",
    ...state.pins.flatMap((design, k) => ["[[designs]]", `name = "pin ${k + 1}"`, ...own.map((name) => `${name} = ${plainNumber(whole(design)[name])}`), ""]),
  ].join("\n");
}

// In the units of the page, which are named in the header.
function asCsv() {
  const axes = [...facts.design_axes, ...axisNames.filter((name) => !facts.design_axes.includes(name))], columns = tableColumns();
  const head = (name) => { const [unit] = unitOf(name); return unit ? `${name} [${unit}]` : name; };
  const lines = [[...axes.map(head), ...columns.flatMap((name) => [head(name), `${head(name)} error`]), "threads"].join(",")];
  state.pins.forEach((design, k) => {
    const values = whole(design), number = (value) => (Number.isFinite(value) ? plainNumber(value) : "");
    const cells = columns.flatMap((name) => { const one = valueOf(k, name), factor = factorOf(name); return one && one.value !== null ? [number(factor * one.value), number(factor * one.error)] : ["", ""]; });
    lines.push([...axes.map((name) => number(shown(name, values[name]))), ...cells, facts.slack[pinned.pins[k]?.slack ?? 0]].join(","));
  });
  return lines.join("\n") + "\n";
}

const EXPORTS = {
  csv: [asCsv, "csv", "text/csv"], python: [asPython, "py", "text/x-python"], shell: [asShell, "sh", "text/plain"], toml: [asToml, "toml", "text/plain"],
};

function saveText(kind) {
  const [make, suffix, type] = EXPORTS[kind];
  try {
    if (kind !== "csv" && !facts.in_numbers) throw new Error("the tubes of this atlas have profiles; only CSV holds what numbers tell of them");
    download(`freesweep-pins.${suffix}`, make(), type);
  } catch (error) { say(error.message); }
}

async function copyLink() {
  const address = location.href.split("#")[0] + "#" + link();
  try { await navigator.clipboard.writeText(address); say("the link to this view is copied"); } catch { say(address); }
}
