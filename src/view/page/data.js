// SPDX-License-Identifier: Apache-2.0
// The controls that know the data: columns with kind, range and histogram, colour maps, slices.
import { facing, project } from "./camera.js";
import { $, ask, command, current, element, isRead, onUpdate, option, page, set, setStill, state } from "./store.js";
import { choices } from "./panel.js";
import { size } from "./picture.js";

const shortened = number => String(Number(number.toPrecision(4)));
const limited = share => Math.max(0, Math.min(1, share));
const FEW_ROWS = 300000, MOST_COLUMNS = 24;  // of files whose columns are read to list their ranges

// Lets a pointer drag an element, `drag(event, moves)`, and arrow keys move it: `step(1)` or `step(-1)`.
function draggable(handle, { grab = () => {}, drag, step }) {
  handle.onpointerdown = event => {
    handle.setPointerCapture(event.pointerId);
    grab(event);
  };
  handle.onpointermove = handle.onpointerup = event => {
    if (handle.hasPointerCapture(event.pointerId)) drag(event, event.type === "pointermove");
  };
  handle.onkeydown = event => {
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    step(by);
  };
}

// ---- Columns ------------------------------------------------------------------------------------------------------

const summaries = new Map();  // by request
const latest = new Map();     // by column: of the last frame that was read
export const frameNumber = () => {
  const value = option("--frame"), number = value === "last" ? -1 : Number(value || 1);
  return number < 0 ? Math.max(state?.frames ?? 1, 1) + 1 + number : number;
};

// What the program tells of a column; null: it is not known.
export async function summary(column, isLog = false) {
  const address = `column?frame=${frameNumber()}&name=${encodeURIComponent(column)}${isLog ? "&log=1" : ""}`;
  if (!summaries.has(address) && isRead()) summaries.set(address, ask(address, undefined, true));
  if (summaries.has(address)) latest.set(column + isLog, summaries.get(address));
  return latest.get(column + isLog) ?? null;
}

const columns = () => state?.data?.columns ?? [];
const kindOf = type => type === "text" ? "words" : /int/.test(type) ? "whole numbers" : "numbers";

// The column of the colours; "": there is none.
export function colourColumn() {
  const name = option("--color-by") || state?.legend.title || "";
  return columns().some(([column]) => column === name) ? name : state?.data?.[name] || "";
}

const entry = (value, textContent) => element("option", { value, textContent });
let listed = "";  // columns that the list has
function listColumns() {
  const list = $("columns"), field = $("color-by"), key = JSON.stringify(columns());
  if (key !== listed) {
    listed = key;
    list.replaceChildren(entry("", ""), entry("none", "one colour"), entry("element", "element"), entry("type", "type"), entry("rgb", "colours of the file"),
      ...columns().filter(([name]) => !["element", "type"].includes(name)).map(([name, type]) => entry(name, `${name} (${kindOf(type)})`)), entry("*", "expression ..."));
  }
  const value = option("--color-by"), title = state?.legend.title;
  list.options[0].textContent = title && !value ? `automatic: ${title}` : "automatic";
  if (document.activeElement === field) return;
  field.hidden = [...list.options].some(one => one.value === value);
  list.value = field.hidden ? value : "*";
}

// Adds what is known of a column to its name in the list.
async function describe(column) {
  const known = await summary(column), one = [...$("columns").options].find(({ value }) => value === column);
  const [, type] = columns().find(([name]) => name === column) ?? [];
  const range = known?.low !== undefined ? `, ${shortened(known.low)} … ${shortened(known.high)}`
    : known?.distinct !== undefined ? `, ${known.distinct.toLocaleString("en")} different` : "";
  if (one && type) one.textContent = `${column} (${kindOf(type)}${range})`;
}

function makeColumns() {
  $("columns").onchange = event => {
    const { value } = event.target;
    $("color-by").hidden = value !== "*";
    if (value === "*") $("color-by").focus();
    else set({ "--color-by": value });
  };
  $("columns").onfocus = () => {
    if (state?.data?.rows <= FEW_ROWS) columns().slice(0, MOST_COLUMNS).forEach(([name]) => describe(name));
  };
  onUpdate(() => {
    listColumns();
    if (colourColumn()) describe(colourColumn());
  });
}

// ---- Histogram and range ------------------------------------------------------------------------------------------

function makeHistogram() {
  const box = $("histogram"), [canvas, ...handles] = box.children, log = $("range-log");
  let known = null, ends = [0, 1];
  const isLog = () => /\blog\b/.test(option("--range"));
  // Shares of the width from values, and back.
  const share = v => isLog() ? Math.log(v / known.low) / Math.log(known.high / known.low) : (v - known.low) / (known.high - known.low);
  const valueAt = s => isLog() ? known.low * (known.high / known.low) ** s : known.low + s * (known.high - known.low);
  handles.forEach((handle, i) => {
    const to = (s, moves) => {
      const value = Number(shortened(valueAt(limited(s))));
      if (i === 0 ? value < ends[1] : value > ends[0]) ends[i] = value;
      set({ "--range": `${isLog() ? "log," : ""}${ends.map(shortened).join(":")}` }, moves);
    };
    const drag = (event, moves) => {
      const { left, width } = canvas.getBoundingClientRect();
      to((event.clientX - left) / width, moves);
    };
    draggable(handle, { drag, step: by => to(share(ends[i]) + 0.02 * by, false) });
  });
  log.onchange = () => set({ "--range": log.checked ? "log" : "" });
  $("range-all").onclick = () => set({ "--range": isLog() ? "log" : "" });
  const show = () => {
    const { range, bar } = state?.legend ?? {};
    log.checked = isLog();
    $("range-all").disabled = !option("--range") || option("--range") === "log";
    log.closest(".row").hidden = !state?.chosen["--range"] && !option("--range");
    box.hidden = !known?.bins || !range || !(known.high > known.low) || (isLog() && !(known.low > 0));
    if (box.hidden) return;
    const typed = option("--range").match(/^(?:log,)?(-?[\d.e+-]+):(-?[\d.e+-]+)$/);
    ends = typed ? [Number(typed[1]), Number(typed[2])] : range;
    handles.forEach((handle, i) => {
      handle.style.left = `${100 * limited(share(ends[i]))}%`;
      for (const [name, value] of Object.entries({ min: known.low, max: known.high, now: ends[i] })) handle.setAttribute(`aria-value${name}`, shortened(value));
    });
    drawBins(canvas, known.bins, ends.map(share), bar);
  };
  onUpdate(async () => {
    const column = colourColumn(), told = column ? await summary(column, isLog()) : null;
    if (column !== colourColumn()) return;
    known = told;
    show();
  });
}

// Bars in the colours that their values have.
function drawBins(canvas, bins, [from, to], bar) {
  const context = canvas.getContext("2d"), { width, height } = canvas, most = Math.sqrt(Math.max(...bins));
  context.clearRect(0, 0, width, height);
  bins.forEach((count, i) => {
    const s = limited(((i + 0.5) / bins.length - from) / Math.max(to - from, 1e-9));
    context.fillStyle = bar.length ? bar[Math.round(s * (bar.length - 1))] : "#888";
    const tall = count === 0 ? 0 : Math.max(1, height * Math.sqrt(count) / most);
    context.fillRect(i * width / bins.length, height - tall, width / bins.length - 0.5, tall);
  });
}

// ---- Colour maps --------------------------------------------------------------------------------------------------

function makeMaps() {
  const reversed = $("reversed"), map = () => option("--map") || state?.chosen["--map"] || "", chosen = () => map().replace(/_r$/, "");
  const choose = name => set({ "--map": name + (reversed.checked ? "_r" : "") });
  const show = (span, name) => { span.style.background = `linear-gradient(90deg, ${page.maps[name].join(", ")})`; };
  choices($("maps"), Object.keys(page.maps), { name: "--map", chosen, choose, show });
  reversed.onchange = () => choose(chosen());
  onUpdate(() => {
    reversed.checked = map().endsWith("_r");
    reversed.closest("section").hidden = !map();
  });
}

// ---- Slices -------------------------------------------------------------------------------------------------------

const AXES = "xyz";
let bounds = null;  // of what is shown without slices: `low`, `high`

// The first slice, if it is along an axis.
function plane() {
  const [, axis, at] = (option("--slice")[0] ?? "").match(/^([xyz])=(.+)$/) ?? [];
  return axis ? { axis: AXES.indexOf(axis), at: Number(at) } : null;
}

function findBounds() {
  const key = JSON.stringify(["--select", "--frame", "--assembly", "--replicate"].map(option)), cut = plane();
  if (!isRead() || !state.bounds || (cut && bounds?.key === key)) return;
  const [low, high] = state.bounds.map(corner => [...corner]);
  bounds = { key, low, high };
  if (!cut) return;
  const reach = span(cut.axis);  // the other side is not known
  bounds.low[cut.axis] -= reach;
  bounds.high[cut.axis] += reach;
}

const span = axis => bounds.high[axis] - bounds.low[axis];
const middle = () => bounds.low.map((low, i) => (low + bounds.high[i]) / 2);

function setPlane(axis, at, moves) {
  setStill({ "--slice": [`${AXES[axis]}=${shortened(at)}`, ...option("--slice").slice(1)] }, moves);
}

// Cuts in the middle along x, y, z or the axis that points at the camera; "off": removes the plane.
function cut(name) {
  if (name === "off") return setStill({ "--slice": option("--slice").slice(1) });
  const axis = name !== "view" ? AXES.indexOf(name) : current() ? facing(current()).axis : 2;
  setPlane(axis, bounds ? middle()[axis] : 0, false);
}

function makeCut() {
  const slider = $("cut"), handle = $("plane");
  choices($("cuts"), ["off", "x", "y", "z", "view"], { name: "cut", chosen: () => AXES[plane()?.axis] ?? "off", choose: cut });
  const slide = moves => {
    const { axis } = plane();
    if (bounds) setPlane(axis, bounds.low[axis] + Number(slider.value) / 1000 * span(axis), moves);
  };
  slider.oninput = () => slide(true);
  slider.onchange = () => slide(false);
  // A handle on the picture drags the plane along its axis.
  const place = (axis, at) => {
    const point = middle(), { width, height } = size();
    point[axis] = at;
    return project(current(), point, width, height);
  };
  let start = null;
  const grab = event => {
    const { axis, at } = plane(), unit = span(axis) / 100 || 1, [a, b] = [place(axis, at), place(axis, at + unit)];
    start = a && b && { axis, at, unit, x: event.clientX, y: event.clientY, dx: b.x - a.x, dy: b.y - a.y };
  };
  const drag = (event, moves) => {
    if (!start) return;
    const { axis, at, unit, x, y, dx, dy } = start;
    setPlane(axis, at + unit * ((event.clientX - x) * dx + (event.clientY - y) * dy) / Math.max(dx ** 2 + dy ** 2, 0.01), moves);
  };
  draggable(handle, { grab, drag, step: by => setPlane(plane().axis, plane().at + by * span(plane().axis) / 50, false) });
  onUpdate(() => {
    findBounds();
    const now = plane(), { width, height } = size(), at = now && bounds && current() && width > 0 && place(now.axis, now.at);
    slider.parentElement.hidden = !now || !bounds;
    handle.hidden = !at;
    if (!slider.parentElement.hidden) {
      slider.value = 1000 * (now.at - bounds.low[now.axis]) / span(now.axis);
      slider.nextElementSibling.value = shortened(now.at);
    }
    if (!at) return;
    handle.style.left = `${Math.max(12, Math.min(width - 12, at.x))}px`;
    handle.style.top = `${Math.max(12, Math.min(height - 12, at.y))}px`;
    handle.textContent = AXES[now.axis];
  });
}

export function makeDataControls() {
  if (!command("--color-by")) return;
  makeColumns();
  makeHistogram();
  makeMaps();
  makeCut();
}
