// SPDX-License-Identifier: Apache-2.0
// Vectors are arrays of three numbers; a camera is { look_from, look_at, up, perspective, size }, where size is the
// vertical field of view in degrees or the width of the frame in scene units. All functions return new cameras.

const add = (a, b) => a.map((x, i) => x + b[i]);
const subtract = (a, b) => a.map((x, i) => x - b[i]);
const scale = (a, s) => a.map(x => x * s);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const distance = v => Math.hypot(...v);
const normalized = a => scale(a, 1 / distance(a));

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

// Scene units per pixel at a distance, in an image of this size.
const unitsPerPixel = (camera, depth, width, height) =>
  camera.perspective ? 2 * depth * Math.tan(camera.size * Math.PI / 360) / height : camera.size / width;

const reach = camera => distance(subtract(camera.look_from, camera.look_at));

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

const shifted = (camera, by) => ({ ...camera, look_from: add(camera.look_from, by), look_at: add(camera.look_at, by) });

// Moves the scene with the pointer, in pixels of an image of this size.
export function pan(camera, dx, dy, width, height) {
  const unit = unitsPerPixel(camera, reach(camera), width, height), { right, up } = axes(camera);
  return shifted(camera, add(scale(right, -dx * unit), scale(up, dy * unit)));
}

// Moves the camera so that it turns about a point.
export const centerOn = (camera, point) => shifted(camera, subtract(point, camera.look_at));

// Shows `factor` times as much of the scene.
export function zoom(camera, factor) {
  if (!camera.perspective) return { ...camera, size: camera.size * factor };
  const offset = subtract(camera.look_from, camera.look_at);
  return { ...camera, look_from: add(camera.look_at, scale(offset, factor)) };
}

// Looks along an axis, 0 to 2, from its positive or its negative side; along `vertical`, as `plot --look-from` does.
export function alongAxis(camera, axis, side, vertical) {
  const direction = [0, 1, 2].map(i => i === axis ? side : 0);
  const isAlongUp = Math.abs(dot(normalized(vertical), direction)) > 0.99;
  const above = [[0, 0, side], [0, 0, -side], [0, side, 0]][axis];
  return { ...camera, look_from: add(camera.look_at, scale(direction, reach(camera))), up: isAlongUp ? above : vertical };
}

// Where a point is in an image of this size: x and y in pixels, and pixels per scene unit there; null: behind the camera.
export function project(camera, point, width, height) {
  const { back, right, up } = axes(camera), offset = subtract(point, camera.look_from);
  const depth = -dot(offset, back);
  if (camera.perspective && depth <= 0) return null;
  const scaled = 1 / unitsPerPixel(camera, depth, width, height);
  return { x: width / 2 + scaled * dot(offset, right), y: height / 2 - scaled * dot(offset, up), scale: scaled };
}

// The axis, 0 to 2, that points most at the camera, and the side.
export function facing(camera) {
  const { back } = axes(camera);
  const axis = [0, 1, 2].reduce((best, i) => Math.abs(back[i]) > Math.abs(back[best]) ? i : best, 0);
  return { axis, side: Math.sign(back[axis]) || 1 };
}

// The shortest vector between two points of a periodic box: `box` has `edges` and `periodic`; null: no box.
export function shortest(a, b, box) {
  const direct = subtract(b, a);
  if (!box) return direct;
  const [u, v, w] = box.edges, volume = dot(u, cross(v, w));
  if (!volume) return direct;
  const shares = [cross(v, w), cross(w, u), cross(u, v)].map(normal => dot(direct, normal) / volume);
  const near = shares.map((share, i) => box.periodic[i] ? -Math.round(share) : 0);
  let best = direct;
  for (let n = 0; n < 27; ++n) {
    const around = [n % 3 - 1, Math.floor(n / 3) % 3 - 1, Math.floor(n / 9) - 1];
    const image = box.edges.reduce((sum, edge, i) => add(sum, scale(edge, box.periodic[i] ? near[i] + around[i] : 0)), direct);
    if (distance(image) < distance(best)) best = image;
  }
  return best;
}

// The angle between two vectors in degrees.
export const angle = (a, b) => Math.acos(Math.max(-1, Math.min(1, dot(normalized(a), normalized(b))))) * 180 / Math.PI;
