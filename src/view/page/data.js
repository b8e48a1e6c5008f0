// SPDX-License-Identifier: Apache-2.0
// The controls that know the data: columns with kind, range and histogram, colour maps, slices.
import { facing, project } from "./camera.js";
import { $, ask, command, control, current, element, on, option, own, page, set, setStill, state, view } from "./store.js";
import { onUpdate, row, section } from "./panel.js";
import { size } from "./picture.js";

const shortened = number => String(Number(number.toPrecision(4)));
const FEW_ROWS = 300000;  // of files whose columns are all read while nothing else is to be done

// ---- Columns ------------------------------------------------------------------------------------------------------

const summaries = new Map();  // by frame and column, as text
export const frameNumber = () => {
  const value = option("--frame"), number = value === "last" ? -1 : Number(value || 1);
  return number < 0 ? Math.max(state?.frames ?? 1, 1) + 1 + number : number;
};

// What the program tells of a column; null: it is not known.
export async function summary(column, isLog = false) {
  const address = `column?frame=${frameNumber()}&name=${encodeURIComponent(column)}${isLog ? "&log=1" : ""}`;
  if (!summaries.has(address)) summaries.set(address, ask(address, undefined, true));
  return summaries.get(address);
}

const columns = () => state?.data?.columns ?? [];
const kindOf = type => type === "text" ? "words" : /int/.test(type) ? "whole numbers" : "numbers";

function rangeText(known) {
  if (!known) return "";
  if (known.low === undefined) return known.distinct === undefined ? "" : `, ${known.distinct.toLocaleString("en")} different`;
  return `, ${shortened(known.low)} … ${shortened(known.high)}`;
}

// The column of the colours; "": there is none.
export function colourColumn() {
  const name = option("--color-by") || state?.legend.title || "";
  const known = columns().some(([column]) => column === name);
  return known ? name : state?.data?.[name] || "";
}

export function columnSection() {
  const list = element("select", { id: "columns" });
  const field = element("input", { type: "text", id: "color-by", placeholder: "expression, such as sqrt(vx^2 + vy^2)", spellcheck: false });
  field.setAttribute("aria-label", "Colour by an expression");
  let shown = "";
  const choose = value => set({ "--color-by": value, "--range": "" });
  list.addEventListener("change", () => {
    field.hidden = list.value !== "*";
    if (list.value !== "*") choose(list.value);
    else field.focus();
  });
  field.addEventListener("change", () => choose(field.value.trim()));
  const entry = (value, text) => element("option", { value, textContent: text });
  onUpdate(() => {
    const key = JSON.stringify(columns());
    if (key !== shown) {
      shown = key;
      list.replaceChildren(entry("", "chosen from the data"), entry("none", "one colour"), entry("element", "element"), entry("type", "type"),
        entry("rgb", "colours of the file"), ...columns().filter(([name]) => !["element", "type"].includes(name)).map(([name, type]) => entry(name, `${name}   ${kindOf(type)}`)), entry("*", "expression ..."));
    }
    const value = option("--color-by"), isKnown = [...list.options].some(one => one.value === value);
    if (document.activeElement !== field) field.value = value;
    list.value = isKnown ? value : "*";
    list.options[0].textContent = state?.legend.title && !value ? `${state.legend.title}, chosen from the data` : "chosen from the data";
    field.hidden = isKnown;
    const column = colourColumn();
    if (column) summary(column).then(known => tell(list, column, known));
  });
  on("settled", () => describeAll(list));
  return section("Colour", ["--color-by", "--range"], row("Column", list), field, histogram());
}

function tell(list, column, known) {
  const one = [...list.options].find(({ value }) => value === column);
  const [, type] = columns().find(([name]) => name === column) ?? [];
  if (one && type) one.textContent = `${column}   ${kindOf(type)}${rangeText(known)}`;
}

let isDescribing = false;
async function describeAll(list) {
  if (isDescribing || !state?.data || $("picture").dataset.settled !== "true" || state.data.rows > FEW_ROWS) return;
  isDescribing = true;
  for (const [name] of columns().slice(0, 24)) tell(list, name, await summary(name));
}

// ---- Histogram and range ------------------------------------------------------------------------------------------

function histogram() {
  const canvas = element("canvas", { width: 300, height: 56, "aria-hidden": "true" });
  const box = element("div", { className: "histogram", hidden: true }, canvas);
  const field = element("input", { type: "text", id: "range", placeholder: "low:high", spellcheck: false, "aria-label": "Range of the colours" });
  const log = element("input", { type: "checkbox", id: "range-log" });
  const reset = element("button", { type: "button", textContent: "All", title: "From the smallest to the largest value" });
  let known = null, ends = [0, 1];
  const isLog = () => /\blog\b/.test(option("--range"));
  // Shares of the width from values, and back.
  const share = v => isLog() ? Math.log(v / known.low) / Math.log(known.high / known.low) : (v - known.low) / (known.high - known.low);
  const valueAt = s => isLog() ? known.low * (known.high / known.low) ** s : known.low + s * (known.high - known.low);
  const text = () => `${isLog() ? "log," : ""}${shortened(ends[0])}:${shortened(ends[1])}`;
  const handles = [0, 1].map(i => {
    const handle = element("div", { className: "handle", role: "slider", tabIndex: 0, "aria-label": i ? "Upper end of the range" : "Lower end of the range" });
    const to = (s, moves) => {
      const value = Number(shortened(valueAt(Math.max(0, Math.min(1, s)))));
      if (i === 0 ? value >= ends[1] : value <= ends[0]) return;
      ends[i] = value;
      set({ "--range": text() }, moves);
    };
    handle.addEventListener("pointerdown", event => { handle.setPointerCapture(event.pointerId); handle.dataset.held = "1"; });
    const at = event => { const b = canvas.getBoundingClientRect(); return (event.clientX - b.left) / b.width; };
    handle.addEventListener("pointermove", event => { if (handle.dataset.held) to(at(event), true); });
    handle.addEventListener("pointerup", event => { delete handle.dataset.held; to(at(event), false); set({ "--range": text() }); });
    handle.addEventListener("keydown", event => {
      const by = { ArrowLeft: -0.02, ArrowDown: -0.02, ArrowRight: 0.02, ArrowUp: 0.02 }[event.key];
      if (!by) return;
      event.preventDefault();
      to(share(ends[i]) + by, false);
    });
    return handle;
  });
  box.append(...handles);
  field.addEventListener("change", () => set({ "--range": field.value.trim() }));
  reset.addEventListener("click", () => set({ "--range": "" }));
  log.addEventListener("change", () => set({ "--range": log.checked ? "log" : "" }));
  const show = () => {
    if (document.activeElement !== field) field.value = option("--range");
    log.checked = isLog();
    const legend = state?.legend, [low, high] = legend?.range ?? [];
    if (state?.chosen["--range"]) field.placeholder = state.chosen["--range"];
    box.hidden = !known?.bins || !legend?.range || !(known.high > known.low) || (isLog() && !(known.low > 0));
    if (box.hidden) return;
    const typed = option("--range").match(/^(?:log,)?(-?[\d.e+-]+):(-?[\d.e+-]+)$/);
    ends = typed ? [Number(typed[1]), Number(typed[2])] : [low, high];
    handles.forEach((handle, i) => {
      const s = Math.max(0, Math.min(1, share(ends[i])));
      handle.style.left = `${100 * s}%`;
      for (const [name, value] of Object.entries({ min: known.low, max: known.high, now: ends[i] })) handle.setAttribute(`aria-value${name}`, shortened(value));
    });
    drawBins(canvas, known.bins, ends.map(share), legend.bar);
  };
  onUpdate(() => {
    show();
    const column = colourColumn(), log = isLog();
    if (column) summary(column, log).then(told => { if (column === colourColumn()) { known = told; show(); } });
    else known = null;
  });
  return element("div", {}, box, element("div", { className: "row" }, element("label", { htmlFor: "range", textContent: "Range" }), field, reset,
    element("label", { className: "toggle" }, log, "log")));
}

// Bars in the colours that their values have.
function drawBins(canvas, bins, [from, to], bar) {
  const context = canvas.getContext("2d"), { width, height } = canvas, most = Math.sqrt(Math.max(...bins));
  context.clearRect(0, 0, width, height);
  bins.forEach((count, i) => {
    const s = Math.max(0, Math.min(1, ((i + 0.5) / bins.length - from) / Math.max(to - from, 1e-9)));
    context.fillStyle = bar.length ? bar[Math.round(s * (bar.length - 1))] : "#888";
    const tall = count === 0 ? 0 : Math.max(1, height * Math.sqrt(count) / most);
    context.fillRect(i * width / bins.length, height - tall, width / bins.length - 0.5, tall);
  });
}

// ---- Colour maps --------------------------------------------------------------------------------------------------

export function mapSection() {
  const grid = element("div", { className: "maps", role: "radiogroup", "aria-label": "Colour map" });
  const reversed = element("input", { type: "checkbox" });
  const chosen = () => option("--map") || state?.chosen["--map"] || "";
  for (const [name, colors] of Object.entries(page.maps)) {
    const input = element("input", { type: "radio", name: "--map", value: name, "aria-label": name });
    const patch = element("span", { title: name });
    patch.style.background = `linear-gradient(90deg, ${colors.join(", ")})`;
    input.addEventListener("change", () => set({ "--map": name + (reversed.checked ? "_r" : "") }));
    onUpdate(() => { input.checked = chosen().replace(/_r$/, "") === name; });
    grid.append(element("label", {}, input, patch));
  }
  reversed.addEventListener("change", () => { const name = chosen().replace(/_r$/, ""); set({ "--map": name + (reversed.checked ? "_r" : "") }); });
  onUpdate(() => { reversed.checked = /_r$/.test(chosen()); });
  return section("Colour map", ["--map"], grid, element("label", { className: "toggle" }, reversed, "reversed"));
}

// ---- Slices -------------------------------------------------------------------------------------------------------

const AXES = "xyz";
let bounds = null;  // of what is shown without slices
const plane = () => { const [, axis, at] = (option("--slice")[0] ?? "").match(/^([xyz])=(.+)$/) ?? []; return axis ? { axis: AXES.indexOf(axis), at: Number(at) } : null; };

async function findBounds() {
  const key = JSON.stringify([option("--select"), option("--frame"), option("--assembly"), option("--replicate")]);
  if (bounds?.key === key && (bounds.isWhole || plane())) return;
  const known = await (await own("bounds"))?.json();
  if (known) bounds = { key, isWhole: !plane(), low: known[0], high: known[1] };
  const cut = plane();
  if (cut && !bounds?.isWhole && bounds) {  // the other side is not known
    const reach = bounds.high[cut.axis] - bounds.low[cut.axis];
    bounds.low[cut.axis] -= reach;
    bounds.high[cut.axis] += reach;
  }
}

function setPlane(axis, at, moves) {
  const rest = option("--slice").slice(1);
  setStill({ "--slice": axis < 0 ? rest : [`${AXES[axis]}=${shortened(at)}`, ...rest] }, moves);
}

export function cutSection() {
  const group = element("div", { className: "segments", role: "radiogroup", "aria-label": "Cut" });
  const slider = element("input", { type: "range", id: "cut", min: 0, max: 1000, "aria-label": "Position of the cut" });
  const output = element("output", { htmlFor: "cut" });
  const span = axis => bounds ? bounds.high[axis] - bounds.low[axis] : 1;
  const cut = async axis => {
    await findBounds();
    if (axis === 3) axis = current() ? facing(current()).axis : 2;
    setPlane(axis, bounds && axis >= 0 ? (bounds.low[axis] + bounds.high[axis]) / 2 : 0, false);
  };
  ["off", "x", "y", "z", "view"].forEach((name, i) => {
    const input = element("input", { type: "radio", name: "cut", value: name });
    input.addEventListener("change", () => cut(i - 1));
    onUpdate(() => { input.checked = (plane()?.axis ?? -1) === i - 1; });
    group.append(element("label", {}, input, element("span", { textContent: name })));
  });
  const slide = moves => {
    const { axis } = plane();
    setPlane(axis, bounds.low[axis] + Number(slider.value) / 1000 * span(axis), moves);
  };
  slider.addEventListener("input", () => bounds && slide(true));
  slider.addEventListener("change", () => bounds && slide(false));
  const field = element("textarea", { id: "slice", rows: 1, placeholder: "z=10", spellcheck: false, "aria-label": "Slices" });
  field.addEventListener("change", () => set({ "--slice": field.value.split("\n").map(line => line.trim()).filter(Boolean) }));
  onUpdate(() => {
    const now = plane();
    slider.parentElement.hidden = !now;
    if (document.activeElement !== field) field.value = option("--slice").join("\n");
    if (now && !bounds) findBounds().then(() => drawPlane());
    if (!now || !bounds) return;
    slider.value = 1000 * (now.at - bounds.low[now.axis]) / span(now.axis);
    output.value = shortened(now.at);
  });
  makeHandle();
  return section("Cut", ["--slice"], group, element("div", { className: "row" }, element("label", { htmlFor: "cut", textContent: "Position" }), slider, output),
    element("div", { className: "row wide" }, field));
}

// A handle on the picture drags the plane along its axis.
function makeHandle() {
  const handle = $("plane");
  const middle = axis => { const out = bounds.low.map((low, i) => (low + bounds.high[i]) / 2); if (axis !== undefined) out[axis] = plane().at; return out; };
  let start = null;
  handle.addEventListener("pointerdown", event => {
    const now = plane(), { width, height } = size(), at = middle(now.axis), next = [...at];
    handle.setPointerCapture(event.pointerId);
    next[now.axis] += (bounds.high[now.axis] - bounds.low[now.axis]) / 100 || 1;
    const [a, b] = [at, next].map(point => project(current(), point, width, height));
    start = a && b && { ...now, x: event.clientX, y: event.clientY, dx: b.x - a.x, dy: b.y - a.y, step: next[now.axis] - at[now.axis] };
  });
  const drag = (event, moves) => {
    if (!start) return;
    const length = Math.max(start.dx ** 2 + start.dy ** 2, 0.01);
    const along = ((event.clientX - start.x) * start.dx + (event.clientY - start.y) * start.dy) / length;
    setPlane(start.axis, start.at + along * start.step, moves);
  };
  handle.addEventListener("pointermove", event => drag(event, true));
  handle.addEventListener("pointerup", event => { drag(event, false); start = null; });
  handle.addEventListener("keydown", event => {
    const by = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 }[event.key], now = plane();
    if (!by || !now || !bounds) return;
    event.preventDefault();
    setPlane(now.axis, now.at + by * (bounds.high[now.axis] - bounds.low[now.axis]) / 50, false);
  });
  drawPlane = () => {
    const now = plane(), { width, height } = size();
    handle.hidden = !now || !bounds || !current() || !width;
    if (handle.hidden) return;
    const at = project(current(), middle(now.axis), width, height);
    if (!at) return;
    handle.style.left = `${Math.max(12, Math.min(width - 12, at.x))}px`;
    handle.style.top = `${Math.max(12, Math.min(height - 12, at.y))}px`;
    handle.textContent = AXES[now.axis];
  };
  on("view", () => drawPlane());
  on("state", () => { if (view.options["--slice"] === undefined && $("picture").dataset.settled === "true") findBounds().then(() => drawPlane()); else drawPlane(); });
}
let drawPlane = () => {};
