// SPDX-License-Identifier: Apache-2.0
import { alongAxis, centerOn, orbit, pan, roll, zoom } from "./camera.js";

const $ = id => document.getElementById(id);
const canvas = $("picture"), context = canvas.getContext("2d");

// Options in the order of the page, by heading. Those that the server does not offer are not shown.
const GROUPS = {
  "Data": {
    "--color-by": "Colour by", "--map": "Colour map", "--range": "Range", "--select": "Select", "--slice": "Slice",
    "--representation": "Representation", "--bonds": "Bonds", "--vectors": "Vectors", "--radius-scale": "Radius scale",
  },
  "Look": {
    "--style": "Style", "--background": "Background", "--material": "Material", "--opacity": "Opacity",
    "--ground": "Ground", "--box": "Box", "--axes": "Axes", "--outline": "Outline",
  },
  "Camera": { "--perspective": "Perspective", "--center": "Centre" },
  "Annotation": { "--title": "Title", "--label": "Labels", "--scale-bar": "Scale bar", "--color-bar": "Colour bar" },
  "Image": { "--quality": "Quality", "--noise": "Noise", "--samples": "Samples", "--denoise": "Denoise", "--set": "Settings" },
};
const HINTS = {
  "--range": "low:high", "--select": "type == 2 && z > 0", "--slice": "z=10", "--opacity": "0.3, or type == 2: 0.3", "--vectors": "vx,vy,vz",
  "--radius-scale": "1", "--perspective": "degrees, such as 30", "--center": "id == 5", "--outline": "2",
  "--title": "t = {step * 0.005:.1f} ps", "--label": "id == 5: Fe", "--scale-bar": "auto, or 2 nm", "--noise": "0.02",
  "--set": "key=value, one per line",
};
const SIZES = [[640, 360], [960, 540], [1280, 720], [1920, 1080], [800, 800]];
const CHOICES = new Set(["--representation", "--style", "--material"]);  // of their values, and no others
const FITTED = new Set(["--perspective", "--center"]);  // by the camera of the data, not by one that was moved
const SETTLED_ms = 200;  // after the last step of the wheel or of a key
const CLICK_px = 4;      // a click moves the pointer less
const UNREACHABLE = "The program has ended, or cannot be reached.";

let state = null;
let camera = null;      // what a client has moved; null: that of the scene
let options = {};       // values that a client has set
let lastWish = 0, granted = 0, isMoving = false;
let shownFrame = 0, knownState = 0;
let isPlaying = false;
let heldRange = "";  // of one frame, while the slider is dragged

// The secret moves from the address to the storage of this tab, where a reload finds it. In a frame nobody sees the
// address, and browsers may refuse the storage.
let secret = new URLSearchParams(location.search).get("token");
if (window.top === window) {
  secret ??= sessionStorage.getItem("secret") ?? "";
  sessionStorage.setItem("secret", secret);
  history.replaceState(null, "", location.pathname);
}

const request = (path, options) => fetch(path, { ...options, headers: { Authorization: `Bearer ${secret}` } });

// ---- Wishes -------------------------------------------------------------------------------------------------------

let isSending = false, next = null;

// Sends what the client wants to see. While a wish is under way, only the last one waits.
async function wish(moves) {
  next = { options, camera, moves };
  isMoving = moves;
  showSettled();
  if (isSending) return;
  isSending = true;
  while (next) {
    const body = JSON.stringify(next);
    next = null;
    try {
      const answer = await request("wish", { method: "POST", body });
      if (answer.ok) lastWish = (await answer.json()).wish;
      else showProblem(await answer.text());
    } catch {
      showProblem(UNREACHABLE);
    }
  }
  isSending = false;
  showSettled();
}

// Whether the page shows the last wish.
const isSettled = () => !isSending && !next && !isMoving && granted >= lastWish;

function showSettled() {
  canvas.dataset.settled = isSettled();
  canvas.dataset.asked = lastWish;
}

let settle = 0;
function move(moved, isDragging) {
  camera = moved;
  wish(true);
  clearTimeout(settle);
  if (!isDragging) settle = setTimeout(() => wish(false), SETTLED_ms);
}

// The camera that a move starts from.
const current = () => camera ?? state?.camera;

function setOption(name, value) {
  options = { ...options, [name]: value };
  if (FITTED.has(name)) camera = null;
  if (name === "--quality") for (const other of ["--noise", "--samples", "--denoise"]) delete options[other];
  else if ((name === "--noise" || name === "--samples") && value !== "") delete options["--quality"];
  wish(false);
}

// ---- Images -------------------------------------------------------------------------------------------------------

async function showFrames() {
  for (;;) {
    let answer;
    try {
      answer = await request(`frame?after=${shownFrame}&state=${knownState}`);
    } catch {
      showProblem(UNREACHABLE);
      setTimeout(showFrames, 2000);
      return;
    }
    if (answer.status === 403) return showProblem("Open the address that the program printed.");
    const header = name => answer.headers.get(name);
    if (answer.status === 200) {
      shownFrame = Number(header("X-Frame"));
      const bitmap = await createImageBitmap(await answer.blob());
      const isFinished = header("X-Finished") === "1";
      // Sketches are small, and have the shape of the finished image but for rounding.
      const height = canvas.width * bitmap.height / bitmap.width;
      if (isFinished) [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
      else if (Math.abs(height / canvas.height - 1) > 0.03) canvas.height = Math.round(height);
      context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
      canvas.dataset.frame = shownFrame;
      canvas.dataset.shown = header("X-Wish");
      canvas.dataset.size = `${bitmap.width} x ${bitmap.height}`;
      bitmap.close();
      if (isFinished) granted = Math.max(granted, Number(header("X-Wish")));
      showStatus(header("X-Samples"), header("X-Noise"), isFinished);
    }
    const hasNewState = Number(header("X-State")) !== knownState;
    knownState = Number(header("X-State"));
    // While a camera moves, its frames are all there is to know.
    if (!state || (hasNewState && !isMoving) || (isPlaying && hasNewState)) await showState();
    showSettled();
    if (isPlaying && answer.status === 200) step();
  }
}

function showStatus(samples, noise, isFinished) {
  const words = [`${samples} samples per pixel`];
  if (noise) words.push(`noise ${noise}`);
  words.push(isFinished ? "finished" : "rendering");
  $("status").textContent = words.join(", ");
  for (const button of document.querySelectorAll("[data-file]")) button.disabled = !isFinished;
}

// ---- State --------------------------------------------------------------------------------------------------------

function showProblem(text) {
  $("problem").textContent = text;
  $("problem").hidden = text === "";
}

async function showState() {
  const answer = await request("state");
  if (!answer.ok) return;
  const isFirst = state === null;
  state = await answer.json();
  knownState = state.number;
  if (state.problem) granted = Math.max(granted, state.served);
  if (isFirst) makeControls();
  if (isFirst || (isSettled() && pointers.size === 0)) {  // perhaps another client's wish
    options = {};
    for (const [name, option] of Object.entries(state.options)) if (option.value) options[name] = option.value;
    camera = state.fitted ? null : state.camera;
  }
  const range = state.options["--range"];
  if (options["--frames"] && range.value && range.value === range.chosen) {  // it is that of all frames now
    options = { ...options, "--range": range.value };
    delete options["--frames"];
  }
  showProblem(state.problem);
  document.title = `${state.title} - orrery view`;
  $("file").textContent = state.title;
  $("command").value = state.command;
  $("film").hidden = state.film === "";
  if (state.activity) $("status").textContent = state.activity;
  $("legend").hidden = state.legend === "";
  if (state.legend) $("legend").src = "data:image/svg+xml," + encodeURIComponent(state.legend);
  $("notes").replaceChildren(...[...state.warnings, ...state.notes].map(note => element("li", { textContent: note })));
  updateControls();
}

// ---- Controls -----------------------------------------------------------------------------------------------------

function element(tag, properties, ...children) {
  const out = Object.assign(document.createElement(tag), properties);
  out.append(...children);
  return out;
}

// Adds the control of an option by `row(id, label, ...fields)`.
function addControl(name, label, row) {
  const option = state.options[name];
  const id = name.slice(2);
  const isChoice = CHOICES.has(name);
  const field = option.flag ? element("input", { id, type: "checkbox" })
    : isChoice ? element("select", { id })
    : option.lines ? element("textarea", { id, rows: 2, spellcheck: false })
    : element("input", { id, type: "text", spellcheck: false });
  field.placeholder = HINTS[name] ?? "";
  field.addEventListener("change", () =>
    setOption(name, option.flag ? (field.checked ? "on" : "") : field.value.trim()));
  if (option.values.length > 0 && !isChoice) {
    field.setAttribute("list", `${id}-values`);
    row(id, label, element("div", {}, field, element("datalist", { id: `${id}-values` })));
  } else {
    row(id, label, field);
  }
}

function makeControls() {
  const form = $("controls");
  let place = form;
  const row = (id, label, ...fields) => place.append(element("label", { htmlFor: id, textContent: label }), ...fields);
  for (const [heading, labels] of Object.entries(GROUPS)) {
    const known = Object.entries(labels).filter(([name]) => state.options[name]);
    if (known.length === 0) continue;
    const isSet = known.some(([name]) => state.options[name].value !== "");
    const open = isSet || heading === "Data" || heading === "Look" || !state.options["--style"];  // all, of a scene
    place = element("div", { className: "fields" });
    form.append(element("details", { open }, element("summary", { textContent: heading }), place));
    for (const [name, label] of known) addControl(name, label, row);
  }
  if (state.options["--width"]) {
    const size = element("select", { id: "size" }, ...SIZES.map(sizeOption));
    size.addEventListener("change", () => {
      const [width, height] = size.value.split(" ");
      options = { ...options, "--width": width, "--height": height };
      wish(false);
    });
    row("size", "Size", size);
  }
  if (state.options["--frame"]) {
    place = element("div", { className: "fields" });
    form.append(place);
    const slider = element("input", { id: "frame", type: "range", min: 1, value: 1 });
    slider.addEventListener("input", () => {
      holdCamera();
      const { chosen } = state.options["--range"];
      if (chosen && !options["--range"]) options = { ...options, "--range": heldRange = chosen };
      options = { ...options, "--frame": slider.value };
      wish(true);
    });
    slider.addEventListener("change", () => setOption("--frame", slider.value));
    const play = element("button", { id: "play", type: "button", textContent: "Play", ariaPressed: "false" });
    play.addEventListener("click", () => {
      isPlaying = !isPlaying;
      play.textContent = isPlaying ? "Pause" : "Play";
      play.ariaPressed = String(isPlaying);
      holdCamera();
      const range = state.options["--range"];
      const hasOwn = range.chosen === options["--range"] && range.chosen !== heldRange;
      if (!isPlaying) delete options["--frames"];
      else if (range.chosen && !hasOwn) options = { ...options, "--frames": "all" };  // for the range of all frames
      isPlaying ? step() : wish(false);
    });
    row("frame", "Frame", element("div", { className: "frames" }, slider,
      element("output", { id: "frame-number", htmlFor: "frame" }), play));
  }
}

function sizeOption([width, height]) {
  return element("option", { value: `${width} ${height}`, textContent: `${width} × ${height}` });
}

function fill(list, values) {
  list.replaceChildren(...values.map(value => element("option", { value, textContent: value })));
}

function updateControls() {
  for (const [name, option] of Object.entries(state.options)) {
    const field = $(name.slice(2));
    if (!field || (document.activeElement === field && field.type === "text")) continue;
    if (option.flag) {
      field.checked = option.value !== "";
      continue;
    }
    if (field.tagName === "SELECT" && field.length === 0) fill(field, option.values);
    const list = $(`${name.slice(2)}-values`);
    if (list && list.childElementCount !== option.values.length) fill(list, option.values);
    field.value = option.value || (field.tagName === "SELECT" ? option.chosen || option.values[0] : "");
    if (option.chosen && field.tagName !== "SELECT") field.placeholder = option.chosen;
  }
  if ($("size") && state.width > 0) {
    const shown = sizeOption([state.width, state.height]);
    for (const option of [shown, sizeOption(state.first_size)])
      if (![...$("size").options].some(other => other.value === option.value)) $("size").prepend(option);
    $("size").value = shown.value;
  }
  if ($("frame")) {
    const row = $("frame").parentElement;
    row.hidden = row.previousElementSibling.hidden = state.frames < 2;
    $("frame").max = state.frames;
    $("frame").value = frameNumber(state.options["--frame"].value);
    $("frame-number").value = `${$("frame").value} of ${state.frames}`;
  }
}

// Keeps the camera while frames change: it would follow the frame.
function holdCamera() {
  camera = current() ?? null;
}

// The number of a frame, from 1; `last` and negative numbers count from the end.
function frameNumber(value) {
  const number = value === "last" ? -1 : Number(value || 1);
  return number < 0 ? state.frames + 1 + number : number;
}

// Shows the next frame of a trajectory.
function step() {
  options = { ...options, "--frame": String(frameNumber(options["--frame"]) % state.frames + 1) };
  wish(true);
}

// ---- Pointer, wheel and keys --------------------------------------------------------------------------------------

const pointers = new Map();

function spread() {
  const [a, b] = [...pointers.values()];
  return { distance: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
}

let pressed = null;  // where the last pointer was pressed; null once it has been dragged

canvas.addEventListener("pointerdown", event => {
  canvas.setPointerCapture(event.pointerId);
  canvas.focus({ preventScroll: true });
  pressed = pointers.size === 0 && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
  pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
});

canvas.addEventListener("pointermove", event => {
  const before = pointers.get(event.pointerId), from = current();
  if (!before || !from) return;
  if (pressed && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) < CLICK_px) return;
  pressed = null;
  const box = canvas.getBoundingClientRect();
  const two = pointers.size === 2 ? spread() : null;
  pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  if (two) {
    const now = spread();
    const moved = pan(from, now.x - two.x, now.y - two.y, box.width, box.height);
    return move(zoom(moved, two.distance / Math.max(now.distance, 1)), true);
  }
  const dx = event.clientX - before.x, dy = event.clientY - before.y;
  if (event.buttons & 6 || event.ctrlKey) return move(pan(from, dx, dy, box.width, box.height), true);
  const perPixel = Math.PI / Math.min(box.width, box.height);
  if (event.shiftKey) return move(roll(from, dx * perPixel), true);
  move(orbit(from, -dx * perPixel, dy * perPixel, state.up), true);
});

function release(event) {
  if (!pointers.delete(event.pointerId) || pointers.size > 0) return;
  if (pressed) showPicked(event);
  else if (isMoving) wish(false);
}
canvas.addEventListener("pointerup", release);
canvas.addEventListener("pointercancel", release);
canvas.addEventListener("dblclick", async event => {
  const picked = await pick(event);
  if (picked && current()) {
    camera = centerOn(current(), picked.center);
    wish(false);
  }
});
canvas.addEventListener("contextmenu", event => event.preventDefault());
canvas.addEventListener("wheel", event => {
  event.preventDefault();
  if (current()) move(zoom(current(), Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.002)), false);
}, { passive: false });

function fit() {
  camera = null;
  wish(false);
}

function lookAlong(axis, side) {
  if (!current()) return;
  camera = alongAxis(current(), "xyz".indexOf(axis), side, state.up);
  wish(false);
}

canvas.addEventListener("keydown", event => {
  if (event.ctrlKey || event.metaKey || event.altKey || !current()) return;
  const angle = Math.PI / 36, key = event.key;
  const turns = { ArrowLeft: [-angle, 0], ArrowRight: [angle, 0], ArrowUp: [0, angle], ArrowDown: [0, -angle] };
  if (turns[key]) move(orbit(current(), ...turns[key], state.up), false);
  else if (key === "r" || key === "R") move(roll(current(), key === "r" ? angle : -angle), false);
  else if (key === "+" || key === "=") move(zoom(current(), 0.9), false);
  else if (key === "-") move(zoom(current(), 1 / 0.9), false);
  else if (key === "f" || key === "F") fit();
  else if ("xyz".includes(key.toLowerCase()) && key.length === 1) lookAlong(key.toLowerCase(), event.shiftKey ? -1 : 1);
  else if (key === "c") $("copy").click();
  else return;
  event.preventDefault();
});

$("fit").addEventListener("click", fit);
for (const button of document.querySelectorAll("[data-axis]"))
  button.addEventListener("click", event => lookAlong(button.dataset.axis, event.shiftKey ? -1 : 1));

// ---- Particles ----------------------------------------------------------------------------------------------------

// The sphere or rod at a position of the pointer; null: none.
async function pick(event) {
  const box = canvas.getBoundingClientRect();
  const x = (event.clientX - box.left) / box.width, y = (event.clientY - box.top) / box.height;
  const answer = await request(`pick?x=${x.toFixed(6)}&y=${y.toFixed(6)}`).catch(() => null);
  if (answer?.ok) return answer.json();
  showProblem(answer ? await answer.text() : UNREACHABLE);
  return null;
}

const shortened = number => String(Number(number.toPrecision(6)));

async function showPicked(event) {
  const picked = await pick(event);
  $("picked").hidden = !picked;
  if (!picked) return;
  $("picked-title").textContent = picked.title;
  const values = [["centre", picked.center.map(shortened).join(", ")], ["radius", shortened(picked.radius)], ...picked.values];
  $("picked-values").replaceChildren(...values.flatMap(([name, value]) =>
    [element("dt", { textContent: name }), element("dd", { textContent: value })]));
}

// ---- Results ------------------------------------------------------------------------------------------------------

// A link could not send the secret.
async function download(file) {
  const answer = await request(file).catch(() => null);
  if (!answer?.ok) return showProblem(answer ? await answer.text() : UNREACHABLE);
  const link = element("a", { href: URL.createObjectURL(await answer.blob()), download: file });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);  // when it has been saved
}

async function copy(text, button) {
  const label = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    $("command").value = text;
    $("command").select();
    button.textContent = "Press Ctrl+C";
  }
  setTimeout(() => { button.textContent = label; }, 1500);
}

$("copy").addEventListener("click", () => copy(state.command, $("copy")));
$("film").addEventListener("click", () => copy(state.film, $("film")));
for (const button of document.querySelectorAll("[data-file]"))
  button.addEventListener("click", () => download(button.dataset.file));
$("controls").addEventListener("submit", event => event.preventDefault());

showState().then(showFrames);
