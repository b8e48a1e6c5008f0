// SPDX-License-Identifier: Apache-2.0
// The state of the page, and the program that grants its wishes. The state is `view`: options by name (a string, a list
// of strings for one that is repeated, true for a flag), a camera or null for that of the data, and whether the image
// fills the window. It is in the address after #, and in the list that undo and redo walk.

export const $ = id => document.getElementById(id);

const SHAPES = ["circle", "line", "text"];
// Makes an element of a page, or a shape of SVG. Properties with a dash, and all of shapes, are attributes.
export function element(tag, properties = {}, ...children) {
  const isShape = SHAPES.includes(tag), out = document.createElementNS(`http://www.w3.org/${isShape ? "2000/svg" : "1999/xhtml"}`, tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined) continue;
    if (isShape || name.includes("-") || name === "role" || name === "list") out.setAttribute(name, value);
    else out[name] = value;
  }
  out.append(...children);
  return out;
}

// The result of a function; null if it throws, as that of storage that the browser refuses to a frame.
export function attempt(f) {
  try {
    return f();
  } catch {
    return null;
  }
}

const target = new EventTarget();
export const emit = (name, detail) => target.dispatchEvent(new CustomEvent(name, { detail }));
// Events: "view", the state of the page has changed; "state", that of the program; "settled"; "problem"; "click", on the picture.
export const on = (name, f) => target.addEventListener(name, event => f(event.detail));
// Calls a function now, and when the state of the page or of the program has changed.
export function onUpdate(f) {
  on("view", f);
  on("state", f);
  f();
}

export const UNREACHABLE = "orrery has ended, or cannot be reached.";
const SETTLED_ms = 250;       // after the last step of the wheel or of a key
const MOST_STEPS = 200;       // of undo
const MOST_PIXELS = 3840 * 2160;
const FITTED = new Set(["--perspective", "--center", "--look-from", "--zoom", "--up", "--fit", "--view"]);  // no moved camera

export let page = null;       // what the program offers
export let state = null;      // what it has told about the last wish of this page
export let view = { options: {}, camera: null, fills: false };
export let lastOption = "";   // that was changed last

const client = Array.from(crypto.getRandomValues(new Uint8Array(12)), byte => byte.toString(16).padStart(2, "0")).join("");
let lastWish = 0, granted = 0, isMoving = false, isSending = false, next = null;
let shownFrame = 0, knownState = 0, isReachable = true;
const steps = [];             // states as text
let step = -1;

// The secret moves from the address to the storage of this tab, where a reload finds it. In a frame nobody sees the
// address, and browsers may refuse the storage.
const isFramed = window.top !== window;
let secret = new URLSearchParams(location.search).get("token");
if (!isFramed) {
  secret ??= sessionStorage.getItem("secret") ?? "";
  sessionStorage.setItem("secret", secret);
  history.replaceState(null, "", location.pathname + location.hash);
}

// ---- Requests -----------------------------------------------------------------------------------------------------

export async function request(path, body) {
  const headers = { Authorization: `Bearer ${secret}` };
  const sent = body === undefined ? { headers } : { method: "POST", headers, body: JSON.stringify(body) };
  const answer = await fetch(path, sent).catch(() => null);
  if (isReachable !== Boolean(answer)) emit("reachable", isReachable = Boolean(answer));
  return answer;
}

// The JSON of an answer; null, with a message if there is one, if it is an error.
export async function ask(path, body, isQuiet) {
  const answer = await request(path, body);
  if (answer?.ok) return answer.json();
  if (answer && !isQuiet) emit("problem", (await answer.text()).trim());
  return null;
}

// The answer to a request about the image of this page; null: there is none. Waits until the scene is read, or the image is
// complete. If another page has asked since, the image is asked for again.
export async function own(path) {
  const address = `${path}${path.includes("?") ? "&" : "?"}client=${client}`;
  for (;;) {
    const answer = await request(address);
    if (answer?.status !== 409) return answer;
    if (isSettled() && state.problem) return null;
    if ((await answer.text()).startsWith("another") && !isSending) wish(false);
    await new Promise(done => setTimeout(done, 100));
  }
}

// ---- Wishes -------------------------------------------------------------------------------------------------------

// What is asked for, without what the page keeps for itself.
export const wanted = () => ({ options: view.options, camera: view.camera });

// The settings that give a scene this camera.
function settingsOf(camera) {
  if (!camera) return [];
  const vectors = ["look_from", "look_at", "up"].map(key => `camera.${key}=[${camera[key].join(", ")}]`);
  return [...vectors, `camera.${camera.perspective ? "vfov" : "width"}=${camera.size}`];
}

// A wish as the program reads it.
export const asked = ({ camera, ...rest }) => ({ ...rest, camera: settingsOf(camera) });

// Sends what the client wants to see. While a wish is under way, only the last one waits. Returns its number.
export async function wish(moves, changes = {}) {
  next = { ...wanted(), ...changes, moves, client };
  isMoving = moves;
  settled();
  if (isSending) return;
  isSending = true;
  while (next) {
    const body = next;
    next = null;
    const answer = await ask("wish", asked(body));
    if (answer) {
      lastWish = answer.wish;
      if (!next) emit("command", answer.command);
    } else {
      granted = lastWish;
    }
  }
  isSending = false;
  settled();
}

export const isSettled = () => !isSending && !next && !isMoving && granted >= lastWish;

function settled() {
  const { dataset } = $("picture");
  dataset.settled = isSettled();
  dataset.asked = lastWish;
  emit("settled");
}

// ---- Changes ------------------------------------------------------------------------------------------------------

export const control = name => page?.options.find(option => option.name === name);
export const option = name => view.options[name] ?? (control(name)?.repeatable ? [] : "");
export const command = name => Boolean(control(name));

// Options as the program sends them: all values are in lists.
function normalized(options) {
  const one = ([name, value]) => [name, value === true || control(name)?.repeatable ? value : value[0]];
  return Object.fromEntries(Object.entries(options).map(one));
}

const isEmpty = value => value === "" || value === false || value == null || value.length === 0;

// Changes options. `moves`: more changes follow at once, as of a slider that is dragged.
export function set(changes, moves = false) {
  const options = { ...view.options };
  for (const [name, value] of Object.entries(changes)) {
    delete options[name];
    if (!isEmpty(value)) options[name] = value;
    if (FITTED.has(name)) view.camera = null;
    if (name === "--color-by" && !("--range" in changes)) delete options["--range"];
    if (name === "--quality") for (const other of ["--noise", "--samples", "--denoise"]) delete options[other];
    if ((name === "--noise" || name === "--samples") && !isEmpty(value)) delete options["--quality"];
    lastOption = name;
  }
  view = { ...view, options };
  changed(moves);
}

// Changes an option whose control must not move the camera, which would follow what is shown.
export function setStill(changes, moves) {
  view.camera = current();
  set(changes, moves);
}

let settling = 0;
// Asks for a sketch. `isHeld`: release() follows.
function sketch(isHeld) {
  clearTimeout(settling);
  if (!isHeld) settling = setTimeout(() => changed(false), SETTLED_ms);
  wish(true);  // first: what the program knows is not about the new view
  emit("view");
}

// Shows another camera; null: that of the data.
export function move(camera, isHeld) {
  view = { ...view, camera };
  sketch(isHeld);
}

function show(changes) {
  view = { ...view, ...changes };
  changed(false);
}

export const look = camera => show({ camera });

export const release = () => isMoving && changed(false);

function changed(moves) {
  clearTimeout(settling);
  if (!moves) record();
  wish(moves);
  emit("view");
}

// Whether the scene of the last change has been read.
export const isRead = () => Boolean(state?.camera) && state.read === lastWish && !isSending && !isMoving && !state.activity && !state.problem;

// Why the last change cannot be shown; "": it can, or was stopped.
export const problem = () => state && state.problem !== "stopped" ? state.problem : "";

// The camera that a move starts from.
export const current = () => view.camera ?? state?.camera ?? null;

// ---- Address, undo and redo ---------------------------------------------------------------------------------------

export function textOf({ options, camera, fills }) {
  const out = new URLSearchParams();
  for (const [name, value] of Object.entries(options).sort()) {
    if (fills && (name === "--width" || name === "--height")) continue;
    for (const one of [value].flat()) out.append(name.slice(2), one === true ? "" : one);
  }
  if (camera) out.set(".camera", JSON.stringify(camera));
  if (fills) out.set(".window", "");
  return out.toString();
}

function viewOf(text) {
  const out = { options: {}, camera: null, fills: false };
  for (const [key, value] of new URLSearchParams(text)) {
    const known = control(`--${key}`);
    if (key === ".window") out.fills = true;
    else if (key === ".camera") out.camera = attempt(() => JSON.parse(value));
    else if (!known) emit("problem", `The address names --${key}, an option that this page does not have.`);
    else if (known.repeatable) (out.options[known.name] ??= []).push(value);
    else out.options[known.name] = known.type === "" ? true : value;
  }
  if (out.fills) Object.assign(out.options, windowSize());
  return out;
}

function record() {
  const text = textOf(view);
  if (text === steps[step]) return;
  steps.splice(step + 1, Infinity, text);
  if (steps.length > MOST_STEPS) steps.shift();
  step = steps.length - 1;
  if (!isFramed) attempt(() => history.pushState(null, "", `#${text}`));  // refused after too many in a short time
}

export const canStep = by => steps[step + by] !== undefined;

export const restore = text => show(viewOf(text));

export function undo(by = -1) {
  if (!canStep(by)) return;
  step += by;
  if (!isFramed) history.replaceState(null, "", `#${steps[step]}`);
  restore(steps[step]);
}

window.onpopstate = () => {
  const text = location.hash.slice(1), known = steps.lastIndexOf(text);
  if (known >= 0) step = known;
  if (text !== textOf(view)) restore(text);
};

// ---- Size ---------------------------------------------------------------------------------------------------------

// The size of the picture's place in pixels of the screen.
function windowSize() {
  const box = $("stage").getBoundingClientRect();
  const pixels = Math.min(devicePixelRatio || 1, Math.sqrt(MOST_PIXELS / Math.max(box.width * box.height, 1)));
  return { "--width": String(Math.max(16, Math.round(box.width * pixels))),
           "--height": String(Math.max(16, Math.round(box.height * pixels))) };
}

// Chooses the size: [width, height], or null for that of the window.
export function resize(size) {
  view = { ...view, fills: !size };
  set(size ? { "--width": String(size[0]), "--height": String(size[1]) } : windowSize());
}

function followWindow() {
  const size = windowSize(), isOther = view.fills && Object.entries(size).some(([name, value]) => value !== option(name));
  if (!isOther) return emit("view");
  view = { ...view, options: { ...view.options, ...size } };
  sketch(false);
}

// The page may move to a screen with other pixels.
function followPixels() {
  matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener("change", () => { followWindow(); followPixels(); }, { once: true });
}

// ---- Images and state ---------------------------------------------------------------------------------------------

async function showFrames() {
  for (;;) {
    const answer = await request(`frame?after=${shownFrame}&state=${knownState}`);
    if (!answer) {
      await new Promise(done => setTimeout(done, 1000));
      continue;
    }
    if (answer.status === 403) return emit("problem", "Open the address that the program printed.");
    const header = name => answer.headers.get(name);
    if (answer.status === 200) {
      shownFrame = Number(header("X-Frame"));
      if (header("X-Client") === client) {
        const number = Number(header("X-Wish")), isFinished = header("X-Finished") === "1";
        const blob = await answer.blob();
        await Promise.all(listeners.map(f => f({ blob, number, isFinished, isLast: number === lastWish && !isSending,
                                                 frame: shownFrame, samples: Number(header("X-Samples")),
                                                 noise: Number(header("X-Noise")) })));
        if (isFinished) granted = Math.max(granted, number);
      }
    }
    const hasNewState = Number(header("X-State")) !== knownState;
    knownState = Number(header("X-State"));
    // While a camera moves, its frames are all there is to know.
    if (!state || (hasNewState && (!isMoving || isPlaying))) await showState();
    settled();
  }
}

const listeners = [];
// Adds what is done with an image before the next one is asked for.
export const onImage = f => listeners.push(f);
export let isPlaying = false;  // frames, of which each state is wanted, and whose images time.js shows
export const setPlaying = value => { isPlaying = value; };

async function showState() {
  const told = await ask("state", undefined, true);
  if (!told) return;
  knownState = told.number;
  const isOwn = told.client === client;
  if (!isOwn && state) {
    emit("busy", told);
    if (!isSettled() && told.served >= told.asked && !document.hidden && !isSending) wish(isMoving);
    return;
  }
  const isCurrent = isOwn && told.asked === lastWish && !isSending && !next;
  if (isOwn && told.problem) granted = Math.max(granted, told.served);  // its answer may still be under way
  state = told;
  if (isCurrent) {  // the program may have corrected the wish
    if (!isMoving) view = { ...view, options: normalized(told.options) };
    if (told.fitted && !told.activity) view = { ...view, camera: null };
  }
  emit("state", isOwn);
}

document.addEventListener("visibilitychange", showState);

export async function start() {
  page = await ask("page");
  if (!page) return;
  view = location.hash.length > 1 ? viewOf(location.hash.slice(1))
    : { options: normalized(page.first), camera: null, fills: page.fills };
  if (view.fills) Object.assign(view.options, windowSize());
  steps.push(textOf(view));
  step = 0;
  emit("page");
  emit("view");
  new ResizeObserver(followWindow).observe($("stage"));
  followPixels();
  wish(false);
  showFrames();
}
