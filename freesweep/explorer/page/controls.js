// The controls at the left and on top.
const STEPS = 1000; // of a slider

const toShare = (name, value) => {
  const { low, high, root } = facts.axes[name], f = root ? Math.sqrt : (v) => v;
  return (f(value) - f(low)) / (f(high) - f(low));
};
const fromShare = (name, share) => {
  const { low, high, root } = facts.axes[name];
  return root ? (Math.sqrt(low) + (Math.sqrt(high) - Math.sqrt(low)) * share) ** 2 : low + (high - low) * share;
};

function fill(id, names, label) {
  byId(id).innerHTML = names.map((name) => `<option value="${name}">${text(label(name))}</option>`).join("");
}

function buildControls() {
  byId("title").textContent = facts.title || facts.file;
  const names = [...measures.keys()];
  for (const id of ["measure", "fx", "fy"]) fill(id, names, labelOf);
  for (const id of ["x", "y"]) fill(id, axisNames, labelOf);
  byId("units").innerHTML = facts.systems.map((name, k) => `<button data-u="${k}">${name}</button>`).join("");
  byId("cloud").innerHTML = '<button data-cloud="map" title="designs of this map">map</button><button data-cloud="all" title="designs of the whole atlas, at these loads">atlas</button>';
  for (const place of document.querySelectorAll(".save")) {
    place.innerHTML = ["png", "svg"].map((kind) => `<button data-save="${kind}">${kind.toUpperCase()}</button>`).join("");
  }
  if (isLocal) for (const button of document.querySelectorAll(".solver")) button.hidden = true;
}

function drawControls() {
  for (const [id, value] of Object.entries({ measure: state.m, x: state.x, y: state.y, fx: state.fx, fy: state.fy })) byId(id).value = value;
  for (const button of document.querySelectorAll("[data-way]")) {
    const isMore = state[button.dataset.way] > 0;
    button.textContent = isMore ? "↑" : "↓";
    button.title = `front: ${isMore ? "more" : "less"} is better`;
  }
  byId("taut").checked = state.taut;
  byId("dark").textContent = state.dark ? "light" : "dark";
  for (const [attribute, value] of [["u", state.u], ["cloud", state.cloud]]) {
    for (const button of document.querySelectorAll(`[data-${attribute}]`)) button.setAttribute("aria-pressed", button.dataset[attribute] === String(value));
  }
  fill("wish", ["", ...[...measures.keys()].filter((name) => !state.wishes.some((one) => one.measure === name))], (name) => (name ? labelOf(name) : "add a wish …"));
  const wanted = [...(facts.designs.length ? ["design"] : []), ...axisNames.filter((name) => name !== state.x && name !== state.y)], box = byId("sliders");
  if (box.dataset.of !== wanted.join()) {
    box.dataset.of = wanted.join();
    box.innerHTML = wanted.map((name) => (name === "design" ? `<label class="wide">design <select data-design></select></label>` : `<div class="slider" data-axis="${name}"><label></label><input type="text" aria-label="${name}"><input type="range" min="0" max="${STEPS}" step="1" aria-label="${name}"></div>`)).join("");
    const designs = box.querySelector("[data-design]");
    if (designs) designs.innerHTML = facts.designs.map((name, k) => `<option value="${k}">${text(name)}</option>`).join("");
  }
  drawSliders();
  const designs = box.querySelector("[data-design]");
  if (designs) designs.value = state.at.design;
}

function drawSliders() {
  for (const row of byId("sliders").querySelectorAll("[data-axis]")) {
    const name = row.dataset.axis, [label, field, range] = row.children;
    label.textContent = withUnit(name);
    if (document.activeElement !== field) field.value = digits(shown(name, state.at[name]));
    if (Math.abs(Number(range.value) - STEPS * toShare(name, state.at[name])) > 0.5) range.value = STEPS * toShare(name, state.at[name]);
  }
}

function axesChosen(id, value) {
  const other = id === "x" ? "y" : "x";
  change(state[other] === value ? { [id]: value, [other]: state[id] } : { [id]: value });
}

const slide = (name, value, drag) => change({ at: { ...state.at, [name]: Math.min(Math.max(value, facts.axes[name].low), facts.axes[name].high) } }, drag);

function listen() {
  const on = (target, type, use) => target.addEventListener(type, use);
  on(byId("measure"), "change", (e) => change({ m: e.target.value }));
  for (const id of ["x", "y"]) on(byId(id), "change", (e) => axesChosen(id, e.target.value));
  for (const id of ["fx", "fy"]) on(byId(id), "change", (e) => change({ [id]: e.target.value }));
  const sliders = byId("sliders");
  on(sliders, "input", (e) => { if (e.target.type === "range") { const name = e.target.closest("[data-axis]").dataset.axis; slide(name, fromShare(name, e.target.value / STEPS), true); } });
  on(sliders, "change", (e) => {
    if (e.target.matches("[data-design]")) { change({ at: { ...state.at, design: Number(e.target.value) } }); return; }
    const name = e.target.closest("[data-axis]").dataset.axis;
    const value = e.target.type === "range" ? fromShare(name, e.target.value / STEPS) : readShown(name, e.target.value);
    if (Number.isNaN(value)) say(`${labelOf(name)}: write a number, or one with its unit`); else slide(name, value, false);
    e.target.blur();
  });
  on(byId("wish"), "change", (e) => { if (e.target.value) addWish(e.target.value); });
  on(byId("taut"), "change", (e) => change({ taut: e.target.checked }));
  on(byId("clear"), "click", () => change({ wishes: [], taut: false }));
  on(byId("polish"), "click", polish);
  const wishes = byId("wishes");
  on(wishes, "pointerdown", (e) => { const svg = e.target.closest("svg"); if (svg) brushWish(svg, e); });
  on(wishes, "pointermove", (e) => dragging?.move(e, true));
  on(wishes, "pointerup", (e) => { const was = dragging; dragging = null; was?.move(e, false); });
  on(wishes, "click", (e) => { if (e.target.closest("button")) { const k = Number(e.target.closest(".wish").dataset.wish); change({ wishes: state.wishes.filter((_, j) => j !== k) }); } });
  on(wishes, "change", (e) => {
    const k = Number(e.target.closest(".wish").dataset.wish), list = [...state.wishes], value = e.target.value.trim() ? readShown(list[k].measure, e.target.value) : null;
    if (Number.isNaN(value)) { say("a wish ends at a number, or at nothing"); return; }
    list[k] = { ...list[k], [e.target.dataset.end]: value };
    e.target.blur();
    change({ wishes: list });
  });
  on(byId("units"), "click", (e) => { if (e.target.dataset.u) change({ u: Number(e.target.dataset.u) }); });
  on(byId("cloud"), "click", (e) => { if (e.target.dataset.cloud) change({ cloud: e.target.dataset.cloud }); });
  on(byId("dark"), "click", () => change({ dark: !state.dark }));
  on(byId("link"), "click", copyLink);
  on(byId("help"), "click", showKeys);
  on(document, "click", (e) => {
    const { save, export: kind, solve, unpin: gone } = e.target.dataset;
    if (e.target.dataset.way) change({ [e.target.dataset.way]: -state[e.target.dataset.way] });
    if (save) savePanel(e.target.parentElement.dataset.panel, save);
    else if (kind) saveText(kind);
    else if (solve) solveExactly(Number(solve));
    else if (gone) unpin(Number(gone));
    else if (e.target.closest("[data-pin]")) change({ active: Number(e.target.closest("[data-pin]").dataset.pin) });
  });
  on(byId("map_place"), "mouseleave", () => { byId("tip").hidden = true; byId("tip").dataset.away = "1"; });
  on(byId("map_place"), "mouseenter", () => { delete byId("tip").dataset.away; });
}
