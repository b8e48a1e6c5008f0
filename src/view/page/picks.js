// SPDX-License-Identifier: Apache-2.0
// Particles that have been picked: marks over the picture, distances and angles, and what one does next.
import { angle, distance, project, shortest } from "./camera.js";
import { $, current, element, on, onUpdate, option, own, set, setStill, state } from "./store.js";
import { canvas, center, size } from "./picture.js";
import { GHOST, equals, isWritable, setRule } from "./rules.js";
import { showObject } from "./scene.js";
import { toast } from "./toasts.js";

// Columns that say what a particle belongs to, and what all with the same value are called.
const SCOPES = [[/^(residue_number|resid|res_id)$/i, "residue"], [/^(residue|resname)$/i, "kind of residue"],
                [/^(chain|subchain|segment)$/i, "chain"], [/^(mol|molecule|mol_id|molecule-id)$/i, "molecule"],
                [/^(cluster|cluster_id|grain_id|grain)$/i, "cluster"]];

let picks = [];       // up to three
let isMeasuring = false;
let scope = 0;
let serial = 0;       // of requests: only the answer to the last one counts

const shortened = number => String(Number(number.toPrecision(6)));

// What is at a place of the picture; null: the background; undefined: it is not known.
async function pick(event) {
  const box = canvas.getBoundingClientRect(), mine = ++serial;
  const share = (place, length) => Math.max(0, Math.min(1, place / length)).toFixed(6);
  const answer = await own(`pick?x=${share(event.clientX - box.left, box.width)}&y=${share(event.clientY - box.top, box.height)}`);
  if (!answer || mine !== serial) return undefined;
  if (answer.ok) return answer.json();
  toast(await answer.text(), { isError: true });
}

on("click", async event => {
  const adds = isMeasuring || event.shiftKey;
  const picked = await pick(event);
  if (picked === undefined) return;
  const others = adds ? picks.filter(one => one.title !== picked?.title) : [];
  keep(picked ? [...others, picked].slice(-3) : others);
});

canvas.ondblclick = async event => {
  const picked = await pick(event);
  if (picked) center(picked.center);
};

function keep(picked) {
  picks = picked;
  isMeasuring = false;
  scope = 0;
  show();
}

export const clearPicks = () => keep([]);

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
  const chain = values.get("chain"), ofChain = chain !== undefined && isWritable("chain", chain) ? `${equals("chain", chain)} && ` : "";
  for (const [form, label] of SCOPES) {
    const column = [...values.keys()].find(name => form.test(name));
    if (column) add(`${label} ${values.get(column)}`, column, label === "residue" ? ofChain : "");
  }
  for (const column of new Set([data.element, data.type])) if (column) add(`${column} ${values.get(column)}`, column);
  return out;
}

// ---- Marks --------------------------------------------------------------------------------------------------------

// Draws the marks where the camera sees the particles.
function drawMarks() {
  const marks = $("marks"), camera = current(), { width, height } = size();
  if (!camera || picks.length === 0 || !width) return marks.replaceChildren();
  const places = picks.map(picked => project(camera, picked.center, width, height));
  const parts = [];
  for (let i = 1; i < picks.length; ++i) {
    const [a, b] = [places[i - 1], places[i]];
    if (!a || !b) continue;
    parts.push(element("line", { x1: a.x, y1: a.y, x2: b.x, y2: b.y }));
    const length = shortened(distance(shortest(picks[i - 1].center, picks[i].center, state.data?.box)));
    parts.push(element("text", { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 - 8 }, length));
  }
  places.forEach((place, i) => {
    if (!place) return;
    const r = Math.max(7, Math.min(picks[i].radius * place.scale + 3, 60));
    parts.push(element("circle", { cx: place.x, cy: place.y, r, class: "halo" }), element("circle", { cx: place.x, cy: place.y, r }));
    if (picks.length > 1) parts.push(element("text", { x: place.x + r + 8, y: place.y + 4 }, String(i + 1)));
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
  const gap = picks.length > 1 ? 48 : 26;  // the numbers of the marks stay in sight
  card.style.left = `${Math.max(8, x + gap + w < stage.width ? x + gap : x - 26 - w)}px`;
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
  $("scopes").replaceChildren(element("legend", { textContent: "Acts on" }), ...scopes.map(scopeButton));
  $("scopes").hidden = scopes.length === 0;
  const measure = action("Measure", "Then click another one; or click it with Shift", () => {
    isMeasuring = !isMeasuring;
    show();
  });
  measure.setAttribute("aria-pressed", String(isMeasuring));
  $("picked-actions").replaceChildren(action("Centre", "Turn about it from now on; double click", () => center(last.center)), measure,
                                      ...scopes.length > 0 ? actions(last, scopes[scope]) : []);
  showObject(last);
  drawMarks();
}

const action = (textContent, title, onclick) => element("button", { type: "button", textContent, title, onclick });

function scopeButton([label, condition], i) {
  const choose = () => {
    scope = i;
    show();
    $(`scope-${i}`).focus();
  };
  const input = element("input", { type: "radio", name: "scope", id: `scope-${i}`, checked: i === scope, onchange: choose });
  return element("label", { className: "chip", title: condition }, input, label);
}

// What can be done with the set that a picked particle stands for.
function actions(picked, [, condition, column]) {
  const select = one => setStill({ "--select": [...option("--select").filter(line => line !== one), one] });
  const label = `${condition}: ${new Map(picked.values).get(column)}`;
  return [action("Hide", `--select '!(${condition})'; key Delete`, hidePicked),
          action("Only", `--select '${condition}'`, () => select(condition)),
          action("Ghost", `--opacity '${condition}: ${GHOST}'`, () => setRule("--opacity", condition, GHOST)),
          action("Colour by", `--color-by ${column}`, () => set({ "--color-by": column })),
          action("Label", `--label '${label}'`, () => set({ "--label": [...option("--label"), label] })),
          kinds(condition, "Representation of these", "--representation", "As ..."), kinds(condition, "Material of these", "--material", "Of ...")];
}

// Gives the set one of the values of an option.
function kinds(condition, label, name, hint) {
  const names = document.querySelector(`[data-option="${name}"][data-values]`).dataset.values.split(" ");
  return element("select", { "aria-label": label, onchange: event => setRule(name, condition, event.target.value) },
    element("option", { value: "", textContent: hint }), ...names.map(value => element("option", { value, textContent: value })));
}

export function hidePicked() {
  const condition = picks.length > 0 && scopesOf(picks.at(-1))[scope]?.[1];
  if (!condition) return;
  clearPicks();
  setStill({ "--select": [...option("--select"), `!(${condition})`] });
}

let frame = "";
onUpdate(() => {
  if (frame !== option("--frame")) clearPicks();  // they have moved
  frame = option("--frame");
  drawMarks();
});
window.addEventListener("resize", drawMarks);
