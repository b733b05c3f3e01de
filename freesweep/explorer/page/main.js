// Puts the parts together: who hears of which change, and the figures' events.
function dress() {
  document.documentElement.classList.toggle("dark", state.dark);
  const ink = css("--ink"), quiet = css("--quiet"), line = css("--line");
  for (const name of ["map", "section", "space", "curve", "front"]) {
    const model = models[name];
    for (const axis of [...model.below, ...model.left].filter((one) => "axis_label" in one)) {
      axis.setv({ axis_label_text_color: quiet, major_label_text_color: quiet, axis_line_color: line, major_tick_line_color: line });
    }
    for (const one of model.center.filter((each) => "grid_line_color" in each)) one.grid_line_color = line;
  }
  for (const kind of Object.keys(facts.hatches)) {
    const fails = kind < 100 && isFailed(Number(kind)), weak = Number(kind) === 10 ? 0.22 : 0.42;
    models[`hatch_glyph_${kind}`].setv({
      fill_color: fails ? { value: css("--blank") } : { value: null }, hatch_color: { value: fails ? quiet : state.dark ? "#000000" : ink }, hatch_alpha: { value: fails ? 0.7 : weak },
    });
  }
  models.map_bar.setv({ major_label_text_color: quiet });
  models.front_lit_glyph.glyph.setv({ fill_color: { value: colourOf(0) } });
  models.front_line_glyph.glyph.setv({ line_color: { value: colourOf(1) } });
}

hearers.push((keys, drag) => {
  const any = (...names) => keys.some((key) => names.includes(key));
  if (drag) drawSliders(); else drawControls();
  if (any("dark")) dress();
  if (any("x", "y", "m", "u")) byId("tip").hidden = true;
  if (any("x", "y")) { grid = null; cross = null; }
  if (any("x", "y", "u", "m")) windowMap();
  if (!drag || !(facts.design_axes.includes(state.x) && facts.design_axes.includes(state.y))) drawMarks();
  if (any("at", "m", "x", "y", "fx", "fy", "cloud") || (any("wishes") && !state.wishes.every((one) => grid?.values[one.measure]))) askMap(drag);
  else if (any("wishes", "taut", "u", "dark")) { drawMap(); drawWishes(); }
  if (any("at", "fx", "fy", "cloud", "wishes", "taut") && (!drag || state.cloud === "all")) askCloud(); else if (any("u", "dx", "dy", "pins")) drawFront();
  if (any("at", "pins", "m")) askPins(drag); else if (any("u", "dark", "active", "wishes")) drawPins();
  if (any("pins") || any("at", "active")) { clearTimeout(shapeTimer); if (!drag) shapeTimer = setTimeout(askShapes, 250); }
});
let shapeTimer = 0, waitingTip = 0, panned = [0, 0];

function event(panel, happened) {
  const { event_name: kind, x, y, sx, sy } = happened;
  if (panel === "map" && kind === "tap") {
    const values = { ...state.at, [state.x]: kept(state.x, x), [state.y]: kept(state.y, y) };
    if ([state.x, state.y].every((name) => values[name] >= facts.axes[name].low && values[name] <= facts.axes[name].high)) pin(values);
  } else if (panel === "map" && kind === "mousemove") {
    cancelAnimationFrame(waitingTip);
    waitingTip = requestAnimationFrame(() => askTip(x, y, sx, sy));
  } else if (panel === "map" && kind === "mouseleave") byId("tip").hidden = true;
  else if (panel === "front" && kind === "tap") tapFront(sx, sy, x, y);
  else if (panel === "front" && kind === "selectiongeometry" && happened.final && happened.geometry.type === "rect") boxFront(happened.geometry);
  else if (panel === "curve" && kind === "tap") slide(facts.along, kept(facts.along, x), false);
  else if (panel === "space" && kind === "panstart") panned = [...state.view];
  else if (panel === "space" && kind === "pan") {
    state.view = [Math.min(Math.max(panned[0] + happened.delta_x / 120, -1.5), 1.5), panned[1] - happened.delta_y / 80];
    drawSpace();
  }
}

async function begin() {
  while (!(window.Bokeh?.documents.length && ["map", "front"].every((name) => Bokeh.documents[0].get_model_by_name(name)))) await new Promise((done) => setTimeout(done, 20));
  const [page] = Bokeh.documents;
  for (const model of page._all_models.values()) if (model.name) models[model.name] = model;
  follow(location.hash.slice(1));
  buildControls();
  listen();
  addEventListener("keydown", onKey);
  addEventListener("resize", () => { fadeTable(); setTimeout(drawShapes, 120); });
  byId("pins").addEventListener("scroll", fadeTable);
  addEventListener("hashchange", () => { follow(location.hash.slice(1)); change({ at: state.at, m: state.m, x: state.x, y: state.y, pins: state.pins, dark: state.dark, u: state.u }); });
  dress();
  drawFront();
  drawPins();
  change({ at: state.at, m: state.m, x: state.x, y: state.y, pins: state.pins, wishes: state.wishes, cloud: state.cloud });
  window.freesweep.ready = true;
}

window.freesweep = { event, state, change, facts, link, pin, isIdle, frames, exports: EXPORTS, pictureOf, viewOf, ask, get grid() { return grid; }, get cloud() { return cloud; }, get pinned() { return pinned; }, margins, models, ready: false };
begin();
