// Keys, as the dialog lists them.
const KEYS = [
  ["arrows", "move the cross over the map (Shift: ten steps)"], ["Enter", "pin the design at the cross"],
  ["1 … 5", "choose a pinned design"], ["Delete", "unpin the chosen one"], ["+ −", "more or less pressure"],
  ["[ ]", "show the variable before or after"], ["u", "units"], ["d", "light or dark"], ["t", "taut only"],
  ["e", "solve the chosen design exactly"], ["o", "polish: designs that meet all wishes"], ["l", "copy a link to this view"],
  ["drag a strip", "a wish; an end of it moves alone"], ["drag a box", "over the points: two wishes"], ["?", "this"],
];

function showKeys() {
  const box = byId("keys");
  box.innerHTML = `<dl>${KEYS.map(([key, words]) => `<dt>${key}</dt><dd>${words}</dd>`).join("")}</dl><form method="dialog"><button autofocus>close</button></form>`;
  box.showModal();
}

function moveCross(dx, dy) {
  const move = (name, value, steps) => {
    const { low, high } = facts.axes[name];
    return Math.min(Math.max(value + ((high - low) * steps) / 170, low), high);
  };
  const from = cross || [state.x, state.y].map((name) => 0.5 * (facts.axes[name].low + facts.axes[name].high));
  cross = [move(state.x, from[0], dx), move(state.y, from[1], dy)];
  drawMarks();
  const { map } = models, [x, y] = [shown(state.x, cross[0]), shown(state.y, cross[1])];
  const place = (value, range, size) => ((value - range.start) / (range.end - range.start)) * size;
  delete byId("tip").dataset.away;
  askTip(x, y, place(x, map.x_range, map.inner_width) + 50, map.inner_height - place(y, map.y_range, map.inner_height));
}

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || byId("keys").open) return;
  if (event.target.matches("input[type=text], select")) return;
  const steps = event.shiftKey ? 10 : 1, onSlider = event.target.matches("input[type=range]");
  const names = [...measures.keys()], next = (by) => names[(names.indexOf(state.m) + by + names.length) % names.length];
  const press = (by) => "pressure" in state.at && slide("pressure", fromShare("pressure", Math.min(Math.max(toShare("pressure", state.at.pressure) + by, 0), 1)), false);
  const ways = {
    ArrowLeft: () => moveCross(-steps, 0), ArrowRight: () => moveCross(steps, 0), ArrowUp: () => moveCross(0, steps), ArrowDown: () => moveCross(0, -steps),
    Enter: () => cross && pin({ ...state.at, [state.x]: cross[0], [state.y]: cross[1] }), Delete: () => state.pins.length && unpin(state.active),
    "+": () => press(0.02), "-": () => press(-0.02), "[": () => change({ m: next(-1) }), "]": () => change({ m: next(1) }),
    u: () => change({ u: (state.u + 1) % facts.systems.length }), d: () => change({ dark: !state.dark }), t: () => change({ taut: !state.taut }),
    e: () => state.pins.length && solveExactly(state.active), o: polish, l: copyLink, "?": showKeys,
  };
  for (let k = 0; k < MOST_PINS; k++) ways[k + 1] = () => k < state.pins.length && change({ active: k });
  if (onSlider && event.key.startsWith("Arrow")) return;
  if (event.target.matches("button") && event.key === "Enter") return;
  if (event.key in ways) { event.preventDefault(); ways[event.key](); }
}
