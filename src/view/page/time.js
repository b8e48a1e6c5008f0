// SPDX-License-Identifier: Apache-2.0
// The frames of a trajectory: timeline and play. Frames that were rendered are kept, and further ones are rendered ahead
// of the one that is shown, so that a loop is smooth.
import { $, current, isPlaying, on, onImage, onUpdate, option, problem, set, setPlaying, state, view, wanted, wish } from "./store.js";
import { frameNumber } from "./data.js";
import { canvas, draw } from "./picture.js";
import { toast } from "./toasts.js";

const AHEAD = 60;             // frames
const MOST_BYTES = 256 << 20;
const cache = new Map();      // images by frame
let cached = "", bytes = 0;   // of which state the images are
let shown = 1, asked = 0, timer = 0, held = "";

const count = () => state?.frames ?? 1;
const key = () => JSON.stringify({ ...view, camera: current(), options: { ...view.options, "--frame": "", "--frames": "" } });

function keep() {
  if (cached === key()) return;
  cached = key();
  cache.clear();
  bytes = 0;
}

// The frame after one, or before it; null: there is none.
function after(frame, by = 1) {
  const next = frame + by;
  if (next >= 1 && next <= count()) return next;
  return $("loop").checked ? (by > 0 ? 1 : count()) : null;
}

const asksFor = frame => ({ ...wanted(), options: { ...view.options, "--frame": String(frame) }, camera: current() });

// Asks for the next frame that is missing.
function render() {
  keep();
  let frame = shown;
  for (let i = 0; i < AHEAD && frame !== null; ++i, frame = after(frame))
    if (!cache.has(frame)) {
      if (bytes > MOST_BYTES) return;
      asked = frame;
      wish(true, asksFor(frame));
      return;
    }
  asked = 0;
}

async function display(frame) {
  shown = frame;
  const blob = cache.get(frame), bitmap = blob && await createImageBitmap(blob);
  if (bitmap && frame === shown) draw(bitmap);
  tell();
}

function tick() {
  timer = setTimeout(tick, 1000 / Number($("speed").value));
  const next = after(shown);
  if (next === null) return stop();
  if (cache.has(next)) display(next);
  if (asked === 0) render();
}

onImage(({ blob, isLast }) => {
  if (!isPlaying) return;
  canvas.dataset.played = asked;
  if (asked > 0 && isLast) add(blob);
});

function add(blob) {
  keep();
  cache.set(asked, blob);
  bytes += blob?.size ?? 0;
  render();
}

// A frame that cannot be shown is left out.
on("state", () => {
  if (!isPlaying || asked === 0 || !problem()) return;
  toast(problem(), { isError: true });
  add(null);
});

function start() {
  setPlaying(true);
  shown = frameNumber();
  view.camera = current();
  const { "--range": range } = state.chosen;
  if (range && (!option("--range") || option("--range") === held)) view.options["--frames"] = "all";  // for the range of all frames
  asked = 0;
  render();
  timer = setTimeout(tick, 0);
  tell();
}

function stop() {
  setPlaying(false);
  clearTimeout(timer);
  delete view.options["--frames"];
  show(shown);
}

export const toggle = () => isPlaying ? stop() : start();

// Shows a frame with the camera and the range of the one before.
function show(frame, moves = false) {
  view.camera = current();
  const { "--range": range } = state.chosen;
  const changes = { "--frame": frame === 1 ? "" : String(frame) };
  if (range && !option("--range")) changes["--range"] = held = range;
  set(changes, moves);
}

export function step(by) {
  const next = after(frameNumber(), by);
  if (count() > 1 && !isPlaying && next !== null) show(next);
}

function tell() {
  const isMany = count() > 1, frame = isPlaying ? shown : frameNumber();
  $("time").hidden = !isMany;
  if (!isMany) return;
  $("play").textContent = isPlaying ? "❚❚" : "▶";
  $("play").setAttribute("aria-label", isPlaying ? "Pause" : "Play");
  $("frame").max = count();
  if (document.activeElement !== $("frame") || isPlaying) $("frame").value = frame;
  const words = [`frame ${frame} / ${count()}`], data = isPlaying || problem() || state.asked !== Number(canvas.dataset.asked) ? null : state.data;
  if (data?.step !== undefined) words.push(`step ${data.step.toLocaleString("en")}`);
  for (const [name, value] of data?.header ?? []) if (/^time$/i.test(name)) words.push(`time ${Number(value.toPrecision(6))}`);
  $("frame-number").value = words.join(" · ");
  $("ahead").style.width = `${cached === key() ? 100 * cache.size / count() : 0}%`;
}

function slide(moves) {
  const frame = Number($("frame").value);
  if (isPlaying) shown = frame;
  else show(frame, moves);
}
$("frame").oninput = () => slide(true);
$("frame").onchange = () => slide(false);
onUpdate(tell);
