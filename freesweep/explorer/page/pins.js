// Pinned designs: up to five, each with its own parameters of design; the loads are those of the sliders.
let pinned = { pins: [], curves: [], nodes: [] };
const exact = new Map(); // what the solver said, by design and loads

const keyOf = (pin) => JSON.stringify(at(pin));

function pin(values) {
  const own = Object.fromEntries(facts.design_axes.map((name) => [name, values[name]]));
  if (facts.designs.length) own.design = values.design;
  const pins = [...state.pins];
  if (pins.length < MOST_PINS) pins.push(own); else pins[state.active] = own;
  const active = state.pins.length < MOST_PINS ? pins.length - 1 : state.active;
  const loads = Object.fromEntries(Object.entries(values).filter(([name]) => !(name in own)));
  change({ pins, active, at: { ...state.at, ...loads } });
}

function unpin(k) {
  const pins = state.pins.filter((_, j) => j !== k);
  change({ pins, active: Math.min(state.active, Math.max(pins.length - 1, 0)) });
}

const lockedOf = (name) => (measures.has(`locked_${name}`) ? `locked_${name}` : null);

let pinsAsked = 0;

function askPins(drag) {
  if (drag && performance.now() - pinsAsked < 150) return; // the map comes first
  pinsAsked = performance.now();
  if (!state.pins.length) { pinned = { pins: [], curves: [], nodes: [] }; drawPins(); return; }
  const all = drag ? [...new Set([state.m, ...needsShape(), ...(lockedOf(state.m) ? [lockedOf(state.m)] : [])])] : [...measures.keys()];
  const question = { what: "pins", pins: state.pins, at: { ...state.at }, measures: all, curves: [state.m], n: 81 };
  request("pins", question, (answer) => {
    if (answer.pins.length !== state.pins.length) return;
    answer.pins.forEach((one, k) => { one.measures = { ...pinned.pins[k]?.measures, ...one.measures }; });
    pinned = answer;
    drawPins();
  });
}

function drawPins() {
  drawCurve();
  drawShapes();
  drawTable();
  if (!grid?.drag) drawFront();
}

// The value of a measure of a pin: exact where the solver was asked, else the atlas'.
function valueOf(k, name) {
  const solved = exact.get(keyOf(state.pins[k]))?.measures[name];
  if (solved) return { ...solved, isExact: true };
  return pinned.pins[k]?.measures[name];
}

function tableColumns() {
  const first = [state.m, ...state.wishes.map((wish) => wish.measure)];
  return [...new Set([...first, ...[...measures.keys()].filter((name) => !name.startsWith("locked_mid"))])];
}

function drawTable() {
  byId("pins_note").textContent = state.pins.length ? "" : "up to five";
  for (const button of document.querySelectorAll("[data-export]")) button.disabled = !state.pins.length;
  const extra = [...new Set([...exact.values()].flatMap((one) => Object.keys(one.measures)))].filter((name) => ["blocked_force", "blocked_torque"].includes(name) && !measures.has(name));
  const columns = [...tableColumns().filter((name) => !name.startsWith("locked_")), ...extra, ...tableColumns().filter((name) => name.startsWith("locked_"))], own = [...(facts.designs.length ? ["design"] : []), ...facts.design_axes];
  const unit = (name) => { const word = unitName(name); return word ? `<br>${word}` : ""; };
  const heads = [...own.map((name) => `<th>${labelOf(name)}${name === "design" ? "" : unit(name)}</th>`), "<th>threads</th>", ...columns.map((name) => `<th class="${name === state.m ? "shown" : ""}">${headOf(name)}${unit(name)}</th>`)];
  const rows = state.pins.map((design, k) => {
    const cells = own.map((name) => `<td>${name === "design" ? text(facts.designs[design.design]) : digits(shownAny(name, design[name]))}</td>`);
    const slack = exact.get(keyOf(design))?.slack ?? pinned.pins[k]?.slack;
    cells.push(`<td>${slack === undefined ? "" : facts.slack[slack]}</td>`);
    for (const name of columns) {
      const one = valueOf(k, name), factor = factorOf(name);
      const words = one && one.status ? facts.statuses[one.status] : null;
      const number = one && one.value !== null ? `${honest(factor * one.value, factor * one.error)} <small>±${oneDigit(factor * one.error)}</small>` : words ? `<small>${words.meaning}</small>` : one ? "<small>none</small>" : "";
      cells.push(`<td class="${name === state.m ? "shown" : ""} ${one?.isExact ? "exact" : ""}" data-measure="${name}" title="${words ? words.sentence.replaceAll('"', "'") : one?.isExact ? "solved exactly" : "from the atlas"}">${number}</td>`);
    }
    const solve = isLocal ? "" : `<button data-solve="${k}" title="solve exactly (e)">${exact.has(keyOf(design)) ? "solved" : "solve exactly"}</button>`;
    return `<tr data-pin="${k}" class="${k === state.active ? "active" : ""}"><td><span class="dot" style="background:${colourOf(k)}"></span> <button data-unpin="${k}" title="unpin (Delete)">×</button> ${solve}</td>${cells.join("")}</tr>`;
  });
  byId("pins").innerHTML = rows.length ? `<table><thead><tr><th></th>${heads.join("")}</tr></thead><tbody>${rows.join("")}</tbody></table>` : HINT;
  fadeTable();
}

// The table fades out at the right where there is more of it.
function fadeTable() {
  const box = byId("pins");
  box.classList.toggle("more", box.scrollLeft + box.clientWidth < box.scrollWidth - 1);
}

const HINT = `<p class="hint">Click the map to pin a design and to see its shape, its curve and its numbers here. Add a wish at the left and drag over
  its strip: designs that do it light up. Press <b>?</b> for the keys.</p>`;
const text = (word) => String(word).replaceAll("&", "&amp;").replaceAll("<", "&lt;");
const unitName = (name) => (measures.has(name) || facts.units_of[name] ? unitOf(name)[0] : { blocked_force: facts.units.N[state.u][0], blocked_torque: facts.units["N m"][state.u][0] }[name] || "").replace("degree", "°");
const factorOf = (name) => (measures.has(name) ? unitOf(name)[1] : { blocked_force: facts.units.N[state.u][1], blocked_torque: facts.units["N m"][state.u][1] }[name] || 1);
const headOf = (name) => (measures.has(name) ? labelOf(name) : name.replaceAll("_", " "));
const shownAny = (name, value) => (facts.units_of[name] ? shown(name, value) : value);

function solveExactly(k) {
  const design = state.pins[k], key = keyOf(design);
  if (!design || isLocal) return;
  request("exact", { what: "exact", at: at(design) }, (answer) => { exact.set(key, answer); drawTable(); });
}
