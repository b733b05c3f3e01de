// Wishes: ranges of measures, brushed over strips that show how often values occur on the map.
const BINS = 56;
const strips = new Map(); // measure -> [low, high] of its strip, kept

function addWish(measure, low = null, high = null) {
  const wishes = state.wishes.filter((one) => one.measure !== measure);
  change({ wishes: [...wishes, { measure, low, high }] });
}

function stripOf(measure) {
  const values = grid?.values[measure];
  if (values && !grid.drag) {
    const finite = values.filter((one) => Number.isFinite(one)).sort();
    if (finite.length > 1) {
      const at_ = (share) => finite[Math.round(share * (finite.length - 1))];
      let [low, high] = [at_(0.01), at_(0.99)];
      for (const wish of state.wishes.filter((one) => one.measure === measure)) {
        low = Math.min(low, wish.low ?? low); high = Math.max(high, wish.high ?? high);
      }
      if (high > low && !dragging) strips.set(measure, [low, high]);
    }
  }
  return strips.get(measure) || [0, 1];
}

let dragging = null;

function drawWishes() {
  const box = byId("wishes"), wanted = state.wishes.map((one) => one.measure).join();
  if (box.dataset.of !== wanted) {
    box.dataset.of = wanted;
    box.innerHTML = state.wishes.map(({ measure }, k) => `<div class="wish" data-wish="${k}"><span>${labelOf(measure)}</span>
      <button aria-label="remove" title="remove">×</button><svg viewBox="0 0 200 34" preserveAspectRatio="none" data-measure="${measure}"></svg>
      <input type="text" aria-label="at least" data-end="low"><input type="text" aria-label="at most" data-end="high"><span class="unit"></span></div>`).join("");
  }
  state.wishes.forEach((wish, k) => drawWish(box.children[k], wish));
  drawLit();
}

function drawWish(row, { measure, low, high }) {
  const [a, b] = stripOf(measure), values = grid?.values[measure], counts = new Float32Array(BINS);
  for (const value of values || []) {
    const bin = Math.floor(((value - a) / (b - a)) * BINS);
    if (bin >= 0 && bin < BINS) counts[bin] += 1;
  }
  const most = Math.max(...counts, 1), place = (value) => Math.min(Math.max(((value - a) / (b - a)) * 200, 0), 200);
  const bars = [...counts].map((count, bin) => {
    const height = count ? 3 + 27 * Math.sqrt(count / most) : 0, middle = a + ((bin + 0.5) / BINS) * (b - a);
    const isIn = (low === null || middle >= low) && (high === null || middle <= high);
    return `<rect x="${(bin * 200) / BINS}" y="${34 - height}" width="${200 / BINS - 0.6}" height="${height}" fill="${isIn && (low ?? high) !== null ? "var(--accent)" : "var(--quiet)"}" opacity="${isIn ? 0.85 : 0.35}"/>`;
  });
  const from = low === null ? 0 : place(low), to = high === null ? 200 : place(high);
  const brush = (low ?? high) === null ? "" : `<rect x="${from}" y="0" width="${Math.max(to - from, 1)}" height="34" fill="var(--accent)" opacity="0.12"/>` +
    [[low, from], [high, to]].map(([end, x]) => (end === null ? "" : `<rect x="${x - 1}" y="0" width="2" height="34" fill="var(--accent)"/>`)).join("");
  row.querySelector("svg").innerHTML = brush + bars.join("");
  for (const input of row.querySelectorAll("input")) {
    const end = input.dataset.end === "low" ? low : high;
    input.placeholder = input.dataset.end === "low" ? "at least" : "at most";
    if (document.activeElement !== input) input.value = end === null ? "" : digits(shown(measure, end));
  }
  row.querySelector(".unit").textContent = unitName(measure);
}

function drawLit() {
  const on = state.wishes.length > 0 || state.taut, part = byId("lit");
  byId("polish").disabled = isLocal || !state.wishes.some((one) => (one.low ?? one.high) !== null) || underWay.has("polish");
  byId("clear").disabled = !on;
  if (!on || !grid) { part.textContent = ""; return; }
  const room = margins(grid), lit = room.filter((one) => one >= 0).length;
  part.textContent = lit ? `${digits((100 * lit) / room.length, 2)} % of the map` : "nothing on this map";
}

// Drag over a strip: its ends are the range; near an end of a range that end moves.
function brushWish(svg, event) {
  const k = Number(svg.closest(".wish").dataset.wish), { measure } = state.wishes[k], [a, b] = stripOf(measure);
  const valueAt = (e) => { const box = svg.getBoundingClientRect(); return a + ((e.clientX - box.left) / box.width) * (b - a); };
  const { low, high } = state.wishes[k], start = valueAt(event), near = 0.03 * (b - a);
  const other = low !== null && Math.abs(start - low) < near ? high ?? b : high !== null && Math.abs(start - high) < near ? low ?? a : start;
  dragging = { move: (e, drag) => {
    const [from, to] = [other, valueAt(e)].sort((p, q) => p - q), wishes = [...state.wishes];
    wishes[k] = { measure, low: from <= a ? null : from, high: to >= b ? null : to };
    change({ wishes }, drag);
  } };
  svg.setPointerCapture(event.pointerId);
}

// Ranges of what may move while designs are polished: the box around what is lit.
function litBox() {
  const free = {};
  const take = (name, value) => { const span = (free[name] ||= [value, value]); span[0] = Math.min(span[0], value); span[1] = Math.max(span[1], value); };
  if (state.cloud === "all" && cloud) {
    const room = margins(cloud);
    room.forEach((one, k) => { if (one >= 0) for (const name of facts.design_axes) take(name, cloud.designs[name][k]); });
  } else {
    const room = margins(grid);
    room.forEach((one, k) => {
      if (one < 0) return;
      [[state.x, k % grid.nx, grid.nx], [state.y, Math.floor(k / grid.nx), grid.ny]].forEach(([name, i, n]) => {
        const { low, high } = facts.axes[name];
        if (facts.design_axes.includes(name)) take(name, low + ((high - low) * i) / (n - 1));
      });
    });
  }
  const names = state.cloud === "all" ? facts.design_axes : [state.x, state.y].filter((name) => facts.design_axes.includes(name));
  return Object.fromEntries(names.map((name) => [name, free[name] || [facts.axes[name].low, facts.axes[name].high]]));
}

function polish() {
  if (byId("polish").disabled) return;
  request("polish", { what: "polish", wishes: state.wishes, at: { ...state.at }, free: litBox(), taut: state.taut }, (answer) => {
    say(answer.summary);
    change({ pins: answer.pins.slice(0, MOST_PINS), active: 0 });
  });
  drawLit();
}
