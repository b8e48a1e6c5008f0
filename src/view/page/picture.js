// SPDX-License-Identifier: Apache-2.0
// The picture: its place in the window, its images, and what pointer, wheel and keys do to the camera.
import { alongAxis, centerOn, orbit, pan, roll, zoom } from "./camera.js";
import { $, current, emit, isPlaying, look, move, onImage, onUpdate, option, release, state, view } from "./store.js";

export const canvas = $("picture");
const context = canvas.getContext("2d");
const CLICK_px = 5;  // a click moves the pointer less

const stillness = matchMedia("(prefers-reduced-motion: reduce)");
const FADE_ms = 160;
const FULL_SAMPLES = 8;  // per pixel, with which an image has replaced its sketch: single samples may be black

// ---- Place --------------------------------------------------------------------------------------------------------

// The size of the picture in the window; its corner is that of #place.
export const size = () => ({ width: canvas.clientWidth, height: canvas.clientHeight });

// The picture has the shape of the image. The style sheet makes it as large as the window allows.
function layout() {
  const [width, height] = ["width", "height"].map(name => Number(option(`--${name}`)) || state?.[name] || 1);
  $("place").dataset.size = `${width} × ${height}`;
  $("place").style.setProperty("--shape", width / height);
  $("stage").classList.toggle("framed", !view.fills);
}
onUpdate(layout);

// ---- Images -------------------------------------------------------------------------------------------------------

let fading = 0, sketch = null;

function paint(bitmap, opacity) {
  context.globalAlpha = opacity;
  context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
}

// Draws an image; `share`: how much of it covers the last sketch.
export function draw(bitmap, { fades = false, share = 1 } = {}) {
  cancelAnimationFrame(fading);
  context.imageSmoothingQuality = "high";
  const end = performance.now() + (fades && !stillness.matches ? FADE_ms : 0);
  const step = now => {
    if (share < 1 && sketch) paint(sketch, 1);
    paint(bitmap, now < end ? 0.3 : sketch ? share : 1);
    if (now < end) fading = requestAnimationFrame(step);
    else if (bitmap !== sketch) bitmap.close();
  };
  step(performance.now());
}

onImage(async image => {
  if (isPlaying) return;
  const bitmap = await createImageBitmap(image.blob);
  // Sketches are small, and have the shape of the finished image but for rounding.
  const height = canvas.width * bitmap.height / bitmap.width;
  const hadSize = canvas.width === bitmap.width && canvas.height === bitmap.height;
  if (image.isFinished && !hadSize) [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
  else if (Math.abs(height / canvas.height - 1) > 0.03) canvas.height = Math.round(height);
  const { dataset } = canvas;
  dataset.frame = image.frame;
  dataset.shown = image.number;
  dataset.size = `${bitmap.width} x ${bitmap.height}`;
  const isSketch = image.samples === 0;
  if (isSketch) sketch?.close();
  if (isSketch) sketch = bitmap;
  draw(bitmap, { fades: image.isFinished && hadSize, share: image.isFinished || isSketch ? 1 : Math.min(1, image.samples / FULL_SAMPLES) });
});

// ---- Pointer and wheel --------------------------------------------------------------------------------------------

const pointers = new Map();

function spread() {
  const [a, b] = [...pointers.values()];
  return { distance: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2,
           angle: Math.atan2(b.y - a.y, b.x - a.x) };
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
    const turned = Math.atan2(Math.sin(now.angle - two.angle), Math.cos(now.angle - two.angle));
    return move(roll(zoom(moved, two.distance / Math.max(now.distance, 1)), turned), true);
  }
  const dx = event.clientX - before.x, dy = event.clientY - before.y;
  if (event.buttons & 6 || event.ctrlKey) return move(pan(from, dx, dy, box.width, box.height), true);
  const perPixel = Math.PI / Math.min(box.width, box.height);
  if (event.shiftKey) return move(roll(from, dx * perPixel), true);
  move(orbit(from, -dx * perPixel, dy * perPixel, state.up), true);
});

function released(event) {
  if (!pointers.delete(event.pointerId) || pointers.size > 0) return;
  if (pressed && event.type === "pointerup") emit("click", event);
  else release();
}
canvas.addEventListener("pointerup", released);
canvas.addEventListener("pointercancel", released);
canvas.addEventListener("contextmenu", event => event.preventDefault());
canvas.addEventListener("wheel", event => {
  event.preventDefault();
  const step = Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.002;
  if (current()) move(zoom(current(), Math.exp(step)), false);
}, { passive: false });

// ---- Camera -------------------------------------------------------------------------------------------------------

export const fit = () => look(null);
export const center = point => current() && look(centerOn(current(), point));
export const lookAlong = (axis, side) => current() && look(alongAxis(current(), axis, side, state.up));

const STEP = Math.PI / 36;  // of a key
// Moves the camera by a key; false: it is none that does.
export function cameraKey(event) {
  const from = current(), axis = ["x", "y", "z"].indexOf(event.key.toLowerCase());
  const turn = (right, up) => () => orbit(from, right * STEP, up * STEP, state.up);
  const moves = { ArrowLeft: turn(-1, 0), ArrowRight: turn(1, 0), ArrowUp: turn(0, 1), ArrowDown: turn(0, -1),
                  r: () => roll(from, STEP), R: () => roll(from, -STEP), "+": () => zoom(from, 0.9), "=": () => zoom(from, 0.9), "-": () => zoom(from, 1 / 0.9) };
  if (axis >= 0) lookAlong(axis, event.shiftKey ? -1 : 1);
  else if (from && moves[event.key]) move(moves[event.key](), false);
  return axis >= 0 || event.key in moves;
}

