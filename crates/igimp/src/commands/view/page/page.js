// The page of `igimp view`: asks for what is new, and puts frames and curves side by side.

// Time between two questions for new frames [ms].
const PAUSE = 2000;

// Tables with a row for every step that say which step it is: of monitors and of rigid bodies.
const isHistory = (name) => /^(monitors|rigid)\//.test(name);
// Tables of contact along the sides of a rigid body at the end of a stage.
const isContact = (name) => /^rigid\/.+__\d+-.+\.csv$/.test(name);

const asked = new URLSearchParams(location.hash.slice(1));
const charts = new Map();
const tables = new Map();
let index = null;
let current = null;

async function fetched(name) {
  const answer = await fetch(name.split("/").map(encodeURIComponent).join("/"), { cache: "no-store" });
  if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
  return answer.text();
}

// Where a frame stands: its stage, its step (or trial), and the step in words. One that the index does not know yet is taken for the last.
function momentOf(name) {
  const own = index.frames[name] || {};
  const stage = typeof own.stage === "number" ? own.stage : Math.max(index.planned.length - 1, 0);
  return { stage, step: own.step || 0, when: own.when || "" };
}

// A moment in words.
function whenOf({ stage, when }) {
  return [`stage ${stage + 1} “${stageName(stage)}”`, when].filter(Boolean).join(", ");
}

function stageName(k) {
  const own = index.stages[k];
  return own ? own.name : index.planned[k] || "";
}

// The way to load the rigid bodies or the reinforcement of a frame, where there are some.
function besideOf(name, what) {
  const own = name.includes("particles_") ? name.replace("particles_", `${what}_`) : name.replace(".vtu", `-${what}.vtu`);
  return index.files[own] ? () => fetched(`packed/${own}`) : null;
}

// What stands over the frames of a stage: water and slip line.
function overOf(stage) {
  return (index.over && index.over[stage]) || {};
}

function entryOf(name, label, more) {
  return { name, bodies: besideOf(name, "rigid"), members: besideOf(name, "reinforcement"), label, key: `${name} ${index.files[name]}`, load: () => fetched(`packed/${name}`), ...more };
}

async function framesOf() {
  const collection = "paraview/particles.pvd";
  if (!index.files[collection]) return [];
  const page = new DOMParser().parseFromString(await fetched(collection), "application/xml");
  const sets = [...page.querySelectorAll("DataSet")].filter((set) => index.files[`paraview/${set.getAttribute("file")}`]);
  return sets.map((set, k) => {
    const name = `paraview/${set.getAttribute("file")}`;
    const moment = momentOf(name);
    const seconds = index.seconds[name];
    const when = seconds === undefined ? "" : `t = ${short(seconds)} s, `;
    const label = `Frame ${k + 1} of ${sets.length}: ${when}${whenOf(moment)}`;
    return entryOf(name, label, { moment, seconds, ...overOf(moment.stage) });
  });
}

function statesOf() {
  const what = { "last-stable": "last stable state", "first-unstable": "first unstable state" };
  return Object.keys(index.files).map((name) => {
    const found = /^paraview\/stage-(\d+)-(last-stable|first-unstable)\.vtu$/.exec(name);
    if (!found) return null;
    const stage = Number(found[1]) - 1;
    // The state that failed has moved most; where it was not written, the other one tells.
    const other = name.replace("last-stable", "first-unstable");
    const isLast = stage === index.planned.length - 1 && stage === index.stages.length - 1;
    const isMechanism = isLast && (other === name || !index.files[other]);
    return entryOf(name, `${stageName(stage)}: ${what[found[2]]}`, { moment: { stage, step: Infinity }, isMechanism, ...overOf(stage) });
  }).filter(Boolean).sort((a, b) => b.name.localeCompare(a.name));
}

// The row of a table that belongs to a moment; those of monitors say which it is.
function rowOf(name, own, moment) {
  const upTo = (rows, holds) => rows.reduce((last, row, k) => (holds(row) ? k : last), -1);
  const isReached = (row) => row[0] < moment.stage + 1 || (row[0] === moment.stage + 1 && row[1] <= moment.step);
  if (isHistory(name)) return upTo(own.rows, isReached);
  const only = index.stage_of_curve[name];
  if (only !== null && only !== undefined) return only === moment.stage ? Math.min(moment.step, own.rows.length - 1) : -1;
  // Curves of all stages have the rows of monitors.
  const monitor = [...tables].find(([other]) => other.startsWith("monitors/"));
  if (monitor) return upTo(monitor[1].rows, isReached);
  const before = index.stages.slice(0, moment.stage).reduce((sum, stage) => sum + stage.rows, 0);
  return Math.min(before + moment.step, own.rows.length - 1);
}

function pointCharts() {
  if (!current) return;
  for (const { chart, name } of charts.values()) chart.point(rowOf(name, tables.get(name), current.moment));
}

// The place of the column of time of a history; -1 where there is none.
function timeColumn({ header }) {
  return header.findIndex((label) => plain(label) === "time [s]");
}

// The times of the rows of a history [s], which stand still in stages that take none; null in cases without time.
function timesOf(own) {
  const column = timeColumn(own);
  return column >= 0 ? own.rows.map((row) => row[column]) : null;
}

// The columns of a history that are drawn, each with its place: all behind those of the moment and of the time.
function columnsOf(own) {
  const first = Math.max(timeColumn(own) + 1, 3);
  return own.header.slice(first).map((label, k) => [label, k + first]);
}

async function drawTables() {
  const names = Object.keys(index.files).filter((name) => name.endsWith(".csv") && !isContact(name));
  for (const name of names) {
    const known = tables.get(name);
    if (known && known.version === index.files[name]) continue;
    const own = { ...table(await fetched(name)), version: index.files[name] };
    tables.set(name, own);
    const title = name.replace(/^.*?\//, "").replace(/\.csv$/, "");
    const times = isHistory(name) ? timesOf(own) : null;
    const columns = isHistory(name) ? columnsOf(own) : [[own.header[1], 1]];
    for (const [label, column] of columns) {
      const id = `${name} ${column}`;
      if (!charts.has(id)) {
        const head = isHistory(name) ? `${title}: ${plain(label)}` : title;
        const chart = new Chart(document.getElementById("curves"), head, [isHistory(name) ? (times ? "time [s]" : "row of the table") : own.header[0], label]);
        charts.set(id, { chart, name });
      }
      // The displacement may begin anew with a stage: lines of histories do not cross from one to the next.
      const part = (row) => (isHistory(name) ? row[0] : 0);
      charts.get(id).chart.show(own.rows.map((row, k) => [times ? times[k] : isHistory(name) ? k : row[0], row[column], part(row)]));
    }
  }
  for (const [id, { chart, name }] of charts) {
    if (names.includes(name)) continue;
    chart.card.remove();
    charts.delete(id);
    tables.delete(name);
  }
  pointCharts();
}

// Numbers behind the # of the address.
function numbersOf(name) {
  return asked.has(name) ? asked.get(name).split(",").map(Number) : null;
}

const viewer = new Viewer(
  {
    frame: Number(asked.get("frame")),
    field: asked.get("field"),
    hover: numbersOf("hover"),
    framed: asked.has("frame"),
    arrows: asked.get("arrows"),
    contours: asked.get("contours"),
    outlines: asked.get("outlines"),
    section: numbersOf("section"),
    view: asked.get("view"),
    cut: numbersOf("cut"),
    least: Number(asked.get("least")),
  },
  (entry, field, frame) => {
    current = entry;
    pointCharts();
    if (isBeside) window.parent.postMessage({ frame, frames: viewer.frames.length, seconds: entry.seconds, field: field.key, label: entry.label, isOwn: chosen(frame, field.key) !== followed }, location.origin);
    const isLast = frame === viewer.frames.length;
    const kept = new URLSearchParams({ ...(isLast ? {} : { frame }), field: field.key });
    history.replaceState(null, "", `#${kept}`);
  },
);

// Beside another run the page follows what is chosen there: the frame of the same time, or at the same share of all, and the
// field. What was followed is not handed back.
const isBeside = window.parent !== window;
let followed = "";

function chosen(frame, field) {
  return `${frame} ${field}`;
}

function frameLike({ frame, frames, seconds }) {
  const own = viewer.frames;
  const times = own.map((entry) => (seconds === undefined || entry.seconds === undefined ? Infinity : Math.abs(entry.seconds - seconds)));
  const nearest = Math.min(...times);
  if (Number.isFinite(nearest)) return times.indexOf(nearest) + 1;
  return Math.round(((frame - 1) / Math.max(frames - 1, 1)) * (own.length - 1)) + 1;
}

// Hands the range of values over when it changes.
viewer.ranged = (range) => {
  const text = JSON.stringify(range);
  if (!isBeside || text === viewer.toldRange || !range.own.every(Number.isFinite)) return;
  viewer.toldRange = text;
  window.parent.postMessage({ range }, location.origin);
};

window.addEventListener("message", (event) => {
  if (!isBeside || event.source !== window.parent || event.origin !== location.origin || viewer.frames.length === 0) return;
  if (event.data.range) {
    viewer.joint = event.data.range;
    if (viewer.shown) viewer.paint();
    return;
  }
  const { slider, field, state } = viewer.part;
  const frame = frameLike(event.data);
  const isKnown = [...field.options].some((option) => option.value === event.data.field);
  const wanted = isKnown ? event.data.field : field.value;
  if (Number(slider.value) === frame && field.value === wanted && state.value === "") return;
  followed = chosen(frame, wanted);
  slider.value = frame;
  field.value = wanted;
  state.value = "";
  viewer.show();
});

function tell(text) {
  const message = document.getElementById("message");
  message.hidden = text === "";
  message.textContent = text;
}

// What to say where there is no frame.
function whyNone() {
  if (index.never) return "This run writes no frames: its case says paraview = { every = \"never\" } in [output]. With every = \"stage\", or every = 5 for every fifth step, as in igimp run CASE --set 'output.paraview={ every = 5 }', there will be some.";
  return "There are no frames yet. The first is written at the end of a stage, or after every fifth step with paraview = { every = 5 } in [output] of the case; this page takes it up by itself.";
}

async function look() {
  try {
    const text = await fetched("index.json");
    if (look.last !== text) {
      index = JSON.parse(text);
      document.getElementById("title").textContent = index.title || index.folder;
      document.title = `${index.title || index.folder} – igimp`;
      await drawTables();
      const frames = await framesOf();
      tell(frames.length === 0 ? whyNone() : "");
      viewer.take(frames, statesOf());
      look.last = text;
      if (asked.has("play")) viewer.play();
      asked.delete("play");
    } else if (viewer.frames.length > 0) tell("");
  } catch (error) {
    tell(error instanceof TypeError ? "The program that serves this page has ended; igimp view starts it again." : `Something cannot be read: ${error.message}`);
  }
  setTimeout(look, PAUSE);
}

look();
