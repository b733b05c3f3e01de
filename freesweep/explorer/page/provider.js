// Who answers: the server this page came from, or the table inside it. One question of a kind is under way at a time; of those
// that come meanwhile the last one counts.
const isLocal = Boolean(window.freesweepTable);
const underWay = new Map(), waiting = new Map();
let asked = 0;

function unpack(buffer) {
  const size = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
  const kinds = { float32: Float32Array, float64: Float64Array, uint8: Uint8Array };
  const walk = (value) => {
    if (value === null || typeof value !== "object") return value;
    if (Array.isArray(value)) return value.map(walk);
    if ("array" in value) return new kinds[value.array](buffer, 4 + size + value.at, value.length);
    return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, walk(one)]));
  };
  return walk(head);
}

async function ask(question) {
  if (isLocal) return answerLocally(question);
  const reply = await fetch("/ask", {
    method: "POST", body: JSON.stringify(question), headers: { "X-Freesweep": facts.token },
  });
  if (!reply.ok) throw new Error(await reply.text());
  return unpack(await reply.arrayBuffer());
}

// Ask, and hand the answer on if it is still wanted; `kind` names the line in which a question waits.
async function request(kind, question, use) {
  if (underWay.has(kind)) { waiting.set(kind, [question, use]); return; }
  underWay.set(kind, true);
  showBusy();
  if (SOLVER.includes(kind)) watchSolver();
  try {
    const answer = await ask(question);
    asked += 1;
    use(answer);
  } catch (error) {
    say(`${error.message || error}`);
  }
  underWay.delete(kind);
  showBusy();
  if (kind === "polish") drawLit();
  if (waiting.has(kind)) {
    const next = waiting.get(kind);
    waiting.delete(kind);
    request(kind, ...next);
  }
}

const SLOW = { grid: "", pins: "", exact: "solving exactly", shape: "solving the shape", polish: "looking for designs" };
let busySince = 0, watching = false, compiling = null; // [s]

// Ask, while the solver is at something, whether it is being compiled: that may take longer than all the rest.
async function watchSolver() {
  if (watching || isLocal) return;
  watching = true;
  while (SOLVER.some((kind) => underWay.has(kind))) {
    await new Promise((done) => setTimeout(done, 1000));
    try { compiling = (await ask({ what: "busy" })).compiling; } catch { break; }
    showBusy();
  }
  watching = false;
  compiling = null;
}

function showBusy() {
  const words = [...underWay.keys()].map((kind) => SLOW[kind]).filter(Boolean);
  if (!underWay.size) busySince = 0;
  else if (!busySince) { busySince = performance.now(); setTimeout(showBusy, 1200); }
  const long = busySince ? performance.now() - busySince : 0;
  const first = compiling === null ? "" : ` the solver is being compiled, once for each version (${Math.round(compiling)} s so far)`;
  const text = words.length ? words.join(", ") + " …" + first : long > 1100 ? "reading the atlas …" : "";
  if (byId("busy").textContent !== text) byId("busy").textContent = text; // while something moves, nothing is laid out anew
}

const say = (text) => { byId("said").textContent = byId("said").title = text; };
const SOLVER = ["shape", "exact", "polish"];
// Whether nothing is under way; `solver` false: but for what the solver is at.
const isIdle = (solver = true) => ![...underWay.keys(), ...waiting.keys()].some((kind) => solver || !SOLVER.includes(kind));
