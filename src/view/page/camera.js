// SPDX-License-Identifier: Apache-2.0
// Vectors are arrays of three numbers; a camera is { look_from, look_at, up, perspective, size }, where size is the
// vertical field of view in degrees or the width of the frame in scene units. All functions return new cameras.

const add = (a, b) => a.map((x, i) => x + b[i]);
const subtract = (a, b) => a.map((x, i) => x - b[i]);
const scale = (a, s) => a.map(x => x * s);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const normalized = a => scale(a, 1 / Math.hypot(...a));

// Rotates v about a unit vector.
function rotated(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scale(v, c), scale(cross(axis, v), s)), scale(axis, dot(axis, v) * (1 - c)));
}

function axes(camera) {
  const back = normalized(subtract(camera.look_from, camera.look_at));
  const right = normalized(cross(camera.up, back));
  return { back, right, up: cross(back, right) };
}

// Scene units per pixel at the distance of look_at, in an image of this size.
function unitsPerPixel(camera, width, height) {
  if (!camera.perspective) return camera.size / width;
  const distance = Math.hypot(...subtract(camera.look_from, camera.look_at));
  return 2 * distance * Math.tan(camera.size * Math.PI / 360) / height;
}

// Orbits about look_at: about `vertical` by `turn`, towards it by `tilt`, in radians. The horizon stays level; that of a
// camera that was rolled keeps its angle.
export function orbit(camera, turn, tilt, vertical) {
  const { back, right, up: above } = axes(camera), level = normalized(vertical);
  const isRolled = Math.abs(dot(right, level)) > 1e-6 || dot(above, level) < -1e-6;
  const up = isRolled ? normalized(camera.up) : level;
  const margin = 0.01;  // the camera never looks along `up`
  const elevation = Math.asin(Math.max(-1, Math.min(1, dot(back, up))));
  const limited = Math.max(-Math.PI / 2 + margin, Math.min(Math.PI / 2 - margin, elevation + tilt)) - elevation;
  const offset = subtract(camera.look_from, camera.look_at);
  return { ...camera, up, look_from: add(camera.look_at, rotated(rotated(offset, right, -limited), up, turn)) };
}

export function roll(camera, angle) {
  return { ...camera, up: rotated(axes(camera).up, axes(camera).back, angle) };
}

// Moves the scene with the pointer, in pixels of an image of this size.
export function pan(camera, dx, dy, width, height) {
  const unit = unitsPerPixel(camera, width, height), { right, up } = axes(camera);
  const shift = add(scale(right, -dx * unit), scale(up, dy * unit));
  return { ...camera, look_from: add(camera.look_from, shift), look_at: add(camera.look_at, shift) };
}

// Moves the camera so that it turns about a point.
export function centerOn(camera, point) {
  const shift = subtract(point, camera.look_at);
  return { ...camera, look_from: add(camera.look_from, shift), look_at: point };
}

// Shows `factor` times as much of the scene.
export function zoom(camera, factor) {
  if (!camera.perspective) return { ...camera, size: camera.size * factor };
  const offset = subtract(camera.look_from, camera.look_at);
  return { ...camera, look_from: add(camera.look_at, scale(offset, factor)) };
}

// Looks along an axis, 0 to 2, from its positive or its negative side; along `vertical`, as `plot --look-from` does.
export function alongAxis(camera, axis, side, vertical) {
  const distance = Math.hypot(...subtract(camera.look_from, camera.look_at));
  const direction = [0, 0, 0];
  direction[axis] = side;
  const isAlongUp = Math.abs(dot(normalized(vertical), direction)) > 0.99;
  const above = [[0, 0, side], [0, 0, -side], [0, side, 0]][axis];
  return { ...camera, look_from: add(camera.look_at, scale(direction, distance)), up: isAlongUp ? above : vertical };
}
