// SPDX-License-Identifier: Apache-2.0
// The picture: its place in the window, its images, and what pointer, wheel and keys do to the camera.
import { alongAxis, centerOn, orbit, pan, roll, zoom } from "./camera.js";
import { $, current, emit, isPlaying, look, move, onImage, onUpdate, option, release, state, view } from "./store.js";

export const canvas = $("picture");
const context = canvas.getContext("2d");
const CLICK_px = 5;  // a click moves the pointer less

const stillness = matchMedia("(prefers-reduced-motion: reduce)");
const FADE_ms = 160;

// ---- Place --------------------------------------------------------------------------------------------------------

// The size of the picture in the window; its corner is that of #place.
export const size = () => ({ width: canvas.clientWidth, height: canvas.clientHeight });

// The picture has the shape of the image, and is as large as the window allows.
function layout() {
  const stage = $("stage").getBoundingClientRect();
  const width = Number(option("--width")) || state?.width || stage.width;
  const height = Number(option("--height")) || state?.height || stage.height;
  const scale = Math.min(stage.width / width, stage.height / height);
  const [w, h] = view.fills ? [stage.width, stage.height] : [width * scale, height * scale];
  const { style, dataset } = $("place");
  dataset.size = `${width} × ${height}`;
  style.width = `${w}px`;
  style.height = `${h}px`;
  style.left = `${(stage.width - w) / 2}px`;
  style.top = `${(stage.height - h) / 2}px`;
  $("stage").classList.toggle("framed", !view.fills);
}
onUpdate(layout);

// ---- Images -------------------------------------------------------------------------------------------------------

let fading = 0;
export function draw(bitmap, fades) {
  cancelAnimationFrame(fading);
  context.imageSmoothingQuality = "high";
  const end = performance.now() + (fades && !stillness.matches ? FADE_ms : 0);
  const step = now => {
    context.globalAlpha = now < end ? 0.3 : 1;
    context.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
    if (now < end) fading = requestAnimationFrame(step);
    else bitmap.close();
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
  draw(bitmap, image.isFinished && hadSize);
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

export function lookAlong(axis, side) {
  if (current()) look(alongAxis(current(), axis, side, state.up));
}

// What a key does to the camera; false: nothing.
export function cameraKey(event) {
  const from = current(), key = event.key, angle = Math.PI / 36;
  if (!from) return false;
  const turns = { ArrowLeft: [-angle, 0], ArrowRight: [angle, 0], ArrowUp: [0, angle], ArrowDown: [0, -angle] };
  const axis = "xyz".indexOf(key.toLowerCase());
  if (turns[key]) move(orbit(from, ...turns[key], state.up), false);
  else if (key === "r" || key === "R") move(roll(from, key === "r" ? angle : -angle), false);
  else if (key === "+" || key === "=") move(zoom(from, 0.9), false);
  else if (key === "-") move(zoom(from, 1 / 0.9), false);
  else if (axis >= 0 && key.length === 1) lookAlong(axis, event.shiftKey ? -1 : 1);
  else return false;
  return true;
}

