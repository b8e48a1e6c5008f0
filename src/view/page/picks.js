// SPDX-License-Identifier: Apache-2.0
// Particles that have been picked: marks over the picture, distances and angles, and what one does next.
import { angle, distance, project, shortest } from "./camera.js";
import { $, element, current, on, own, option, set, setStill, state, view } from "./store.js";
import { center, setClicks, size } from "./picture.js";
import { hasRules, equals, isWritable, setRule } from "./rules.js";
import { showObject } from "./scene.js";
import { toast } from "./toasts.js";

const GHOST = "0.25";
// Columns that say what a particle belongs to, and what all with the same value are called.
const SCOPES = [[/^(residue_number|resid|res_id)$/i, "residue"], [/^(residue|resname)$/i, "kind of residue"],
                [/^(chain|subchain|segment)$/i, "chain"], [/^(mol|molecule|mol_id|molecule-id)$/i, "molecule"],
                [/^(cluster|cluster_id|grain_id|grain)$/i, "cluster"]];
const SVG = "http://www.w3.org/2000/svg";

let picks = [];       // up to three
let isMeasuring = false;
let scope = 0;
let serial = 0;       // of requests: only the answer to the last one counts

export const shortened = number => String(Number(number.toPrecision(6)));

async function pick(event) {
  const box = $("picture").getBoundingClientRect(), mine = ++serial;
  const x = (event.clientX - box.left) / box.width, y = (event.clientY - box.top) / box.height;
  const clamped = value => Math.max(0, Math.min(1, value)).toFixed(6);
  const answer = await own(`pick?x=${clamped(x)}&y=${clamped(y)}`);
  if (!answer || mine !== serial) return undefined;
  if (answer.ok) return answer.json();
  toast(await answer.text(), { isError: true });
  return undefined;
}

setClicks(async event => {
  const adds = isMeasuring || event.shiftKey;
  const picked = await pick(event);
  if (picked === undefined) return;
  isMeasuring = false;
  if (!picked) picks = adds ? picks : [];
  else if (!adds) picks = [picked];
  else if (!picks.some(one => one.title === picked.title)) picks = [...picks, picked].slice(-3);
  scope = 0;
  show();
}, async event => {
  const picked = await pick(event);
  if (picked) center(picked.center);
});

export function clearPicks() {
  picks = [];
  isMeasuring = false;
  show();
}

// ---- What it belongs to -------------------------------------------------------------------------------------------

// The sets of particles that a picked one stands for: [label, condition, column], the smallest first.
function scopesOf(picked) {
  const data = state?.data, values = new Map(picked.values), out = [];
  if (!data || !/^row /.test(picked.title)) return out;
  const add = (label, column, also = "") => {
    const value = values.get(column);
    if (value !== undefined && isWritable(column, value)) out.push([label, also + equals(column, value), column]);
  };
  if (data.id) add("this one", data.id);
  for (const [form, label] of SCOPES) {
    const column = [...values.keys()].find(name => form.test(name));
    if (!column) continue;
    const chain = [...values.keys()].find(name => name === "chain");
    const also = label === "residue" && chain && isWritable(chain, values.get(chain)) ? `${equals(chain, values.get(chain))} && ` : "";
    add(`${label} ${values.get(column)}`, column, also);
  }
  for (const column of new Set([data.element, data.type])) if (column) add(`${column} ${values.get(column)}`, column);
  return out;
}

// ---- Marks --------------------------------------------------------------------------------------------------------

function svg(tag, attributes, text = "") {
  const out = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) out.setAttribute(name, value);
  out.textContent = text;
  return out;
}

// Draws the marks where the camera sees the particles.
export function drawMarks() {
  const marks = $("marks"), camera = current(), { width, height } = size();
  if (!camera || picks.length === 0 || !width) return marks.replaceChildren();
  const places = picks.map(picked => project(camera, picked.center, width, height));
  const parts = [];
  for (let i = 1; i < picks.length; ++i) {
    const [a, b] = [places[i - 1], places[i]];
    if (!a || !b) continue;
    parts.push(svg("line", { x1: a.x, y1: a.y, x2: b.x, y2: b.y }));
    const length = shortened(distance(shortest(picks[i - 1].center, picks[i].center, state.data?.box)));
    parts.push(svg("text", { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 - 8 }, length));
  }
  places.forEach((place, i) => {
    if (!place) return;
    const r = Math.max(7, Math.min(picks[i].radius * place.scale + 3, 60));
    parts.push(svg("circle", { cx: place.x, cy: place.y, r, class: "halo" }), svg("circle", { cx: place.x, cy: place.y, r }));
    if (picks.length > 1) parts.push(svg("text", { x: place.x + r + 8, y: place.y + 4 }, String(i + 1)));
  });
  marks.replaceChildren(...parts);
  placeCard(places.filter(Boolean).sort((a, b) => a.x - b.x).at(-1));
}

// Keeps the card beside the rightmost mark, within the picture.
function placeCard(place) {
  const card = $("picked"), stage = $("stage").getBoundingClientRect(), frame = $("place").getBoundingClientRect();
  if (card.hidden || !place || matchMedia("(max-width: 700px)").matches) return;
  const x = frame.left - stage.left + place.x, y = frame.top - stage.top + place.y;
  const { offsetWidth: w, offsetHeight: h } = card;
  card.style.left = `${x + 26 + w < stage.width ? Math.max(8, x + 26) : Math.max(8, x - 26 - w)}px`;
  card.style.top = `${Math.max(58, Math.min(y - 30, stage.height - h - 8))}px`;
}

// ---- Card ---------------------------------------------------------------------------------------------------------

function measures() {
  const box = state.data?.box, out = [];
  const between = (a, b) => shortest(picks[a].center, picks[b].center, box);
  for (let i = 1; i < picks.length; ++i) {
    const near = distance(between(i - 1, i)), direct = distance(shortest(picks[i - 1].center, picks[i].center, null));
    const text = direct - near > 1e-6 * direct ? `${shortened(near)}, through the periodic boundary; ${shortened(direct)} as drawn` : shortened(near);
    out.push([`distance ${i} to ${i + 1}`, text]);
  }
  if (picks.length === 3) out.push(["angle at 2", `${shortened(angle(between(1, 0), between(1, 2)))}°`]);
  return out;
}

function show() {
  const last = picks.at(-1), card = $("picked");
  card.hidden = !last;
  if (!last) return drawMarks();
  const values = [["centre", last.center.map(shortened).join(", ")], ["radius", shortened(last.radius)], ...last.values];
  $("picked-title").textContent = last.title;
  const rows = list => list.flatMap(([name, value]) => [element("dt", { textContent: name }), element("dd", { textContent: value })]);
  $("measures").replaceChildren(...rows(measures()));
  $("picked-values").replaceChildren(...rows(values));
  const scopes = scopesOf(last);
  scope = Math.min(scope, Math.max(scopes.length - 1, 0));
  const chips = scopes.map(([label, condition], i) => {
    const input = element("input", { type: "radio", name: "scope", id: `scope-${i}`, checked: i === scope });
    input.addEventListener("change", () => { scope = i; show(); $(`scope-${i}`).focus(); });
    return element("label", { className: "chip", title: condition }, input, label);
  });
  $("scopes").replaceChildren(...chips);
  $("scopes").hidden = chips.length === 0;
  const action = (text, title, f, isPressed) => {
    const button = element("button", { type: "button", textContent: text, title, "aria-pressed": isPressed });
    button.addEventListener("click", f);
    return button;
  };
  const [, condition, column] = scopes[scope] ?? [];
  const select = one => setStill({ "--select": [...option("--select").filter(line => line !== one), one] });
  const parts = [
    action("Centre", "Turn about it from now on; double click", () => center(last.center)),
    action("Measure", "Then click another one; or click it with Shift", () => { isMeasuring = !isMeasuring; show(); }, String(isMeasuring)),
  ];
  if (condition) {
    parts.push(action("Hide", `--select '!(${condition})'; key Delete`, hidePicked),
               action("Only", `--select '${condition}'`, () => select(condition)),
               action("Ghost", `--opacity '${condition}: ${GHOST}'`, () => setRule("--opacity", condition, GHOST)),
               action("Colour by", `--color-by ${column}`, () => set({ "--color-by": column })),
               action("Label", `--label '${condition}: ...'`, () => {
                 const value = new Map(last.values).get(column);
                 set({ "--label": [...option("--label"), `${condition}: ${value}`] });
               }));
    if (hasRules("--representation"))
      parts.push(kinds(condition));
  }
  $("picked-actions").replaceChildren(...parts);
  showObject(last);
  drawMarks();
}

// Shows the set as another representation.
function kinds(condition) {
  const names = ["spheres", "ball-and-stick", "sticks", "trace", "points"];
  const list = element("select", { "aria-label": "Representation of these" }, element("option", { value: "", textContent: "As ..." }),
                       ...names.map(value => element("option", { value, textContent: value })));
  list.addEventListener("change", () => setRule("--representation", condition, list.value));
  return list;
}

export function hidePicked() {
  const condition = picks.length > 0 && scopesOf(picks.at(-1))[scope]?.[1];
  if (!condition) return;
  clearPicks();
  setStill({ "--select": [...option("--select"), `!(${condition})`] });
}

$("picked-close").addEventListener("click", clearPicks);
let shownFrame = "";
on("view", () => {
  const frame = String(view.options["--frame"] ?? "");
  if (frame !== shownFrame && picks.length > 0) clearPicks();  // they have moved
  shownFrame = frame;
  drawMarks();
});
on("state", drawMarks);
window.addEventListener("resize", drawMarks);
