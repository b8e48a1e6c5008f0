// SPDX-License-Identifier: Apache-2.0
// The legend on the picture: classes that a click hides, shows alone, makes translucent or colours.
import { $, element, isRead, isSettled, on, onUpdate, option, state } from "./store.js";
import { colourColumn, summary } from "./data.js";
import { GHOST, equals, isAlone, isShown, isWritable, ruleValue, setAlone, setRule, setShown } from "./rules.js";

const MOST = 60;
const colours = new Map();  // by column and class: of hidden ones, too
const WATER = /^(HOH|WAT|H2O|SOL|TIP3?|TIP4P?|SPC)$/;

const short = count => count < 10000 ? String(count) : count < 1e6 ? `${Math.round(count / 1000)} k` : `${(count / 1e6).toPrecision(3)} M`;

function iconButton(textContent, title, isPressed, onclick) {
  return element("button", { type: "button", className: "icon", textContent, title, "aria-label": title, "aria-pressed": String(isPressed), onclick });
}

function classRow(column, value, count) {
  const isVisible = isShown(column, value), canSet = isWritable(column, value), condition = canSet ? equals(column, value) : "";
  const opacity = canSet ? ruleValue("--opacity", condition) : "", colour = colours.get(`${column} ${value}`) ?? "#999999";
  const patch = canSet ? element("input", { type: "color", value: colour, "aria-label": `Colour of ${value}`, onchange: () => setRule("--color", condition, patch.value) })
    : element("i");
  patch.style.background = colour;
  patch.style.opacity = isVisible ? opacity || 1 : 0.2;
  const name = element("button", { type: "button", className: "name", textContent: value || "(empty)", disabled: !canSet, "aria-pressed": String(isVisible),
    title: `${isVisible ? "Hide" : "Show"} ${condition || value}`, onclick: () => setShown(column, value, !isVisible) });
  const out = element("div", { className: isVisible ? "class" : "class off" }, patch, name,
    element("em", { textContent: isVisible ? opacity ? `${Math.round(opacity * 100)} %` : short(count) : "hidden" }));
  if (canSet) out.append(
    iconButton("◉", `Only ${value}`, isAlone(column, value), () => setAlone(column, value)),
    iconButton("◌", `${value} translucent`, opacity !== "", () => setRule("--opacity", condition, opacity ? "" : GHOST)));
  return out;
}

function colourBar({ bar, range: [low, high], log }) {
  const out = element("div", { className: "bar" }), middle = log ? Math.sqrt(low * high) : (low + high) / 2;
  out.style.background = `linear-gradient(90deg, ${bar.filter((_, i) => i % 15 === 0).join(", ")})`;
  return [out, element("div", { className: "ticks" }, ...[low, middle, high].map(v => element("span", { textContent: String(Number(v.toPrecision(3))) })))];
}

let shown = "", serial = 0;
let column = "";  // of the legend
async function show() {
  if (isRead()) column = colourColumn();
  const legend = state?.legend, box = $("legend"), mine = ++serial;
  const isBar = Boolean(legend?.bar.length && legend.range), hasClasses = Boolean(legend?.labels.length);
  const known = hasClasses && column ? await summary(column) : null;
  if (mine !== serial) return;
  const classes = known?.classes ?? legend?.labels.map(([label]) => [label, 0]) ?? [];
  const key = JSON.stringify([legend, classes.length, column, option("--select"), option("--opacity"), option("--color")]);
  if (key === shown) return;
  shown = key;
  for (const [label, colour] of legend?.labels ?? []) colours.set(`${column} ${label}`, colour);
  box.hidden = !isBar && !hasClasses;
  const focused = document.activeElement?.closest?.("#legend") ? document.activeElement.title : "";
  const parts = [element("h2", { textContent: legend?.title ?? "" })];
  if (isBar) parts.push(...colourBar(legend));
  if (hasClasses) {
    const sorted = [...classes].slice(0, MOST).sort(([a], [b]) => a.localeCompare(b, "en", { numeric: true }));
    parts.push(element("div", { className: "classes" }, ...sorted.map(([value, count]) => classRow(column, value, count))));
    const more = (known?.distinct ?? legend.labels.length) - sorted.length;
    if (more > 0) parts.push(element("p", { textContent: `and ${more.toLocaleString("en")} more` }));
  }
  box.replaceChildren(...parts);
  if (focused) [...box.querySelectorAll("button")].find(button => button.title.endsWith(focused.replace(/^(Hide|Show) /, "")))?.focus();
}

// Water has a button of its own: it is what hides the rest.
let watered = false;
async function offerWater() {
  if (watered || !isSettled() || !state?.data?.columns.some(([name]) => name === "residue")) return;
  watered = true;
  const known = await summary("residue"), found = known?.classes?.filter(([name]) => WATER.test(name)) ?? [];
  for (const [name, count] of found) {
    const button = element("button", { type: "button", className: "water", onclick: () => setShown("residue", name, !isShown("residue", name)) });
    $("select").after(button);
    onUpdate(() => { button.textContent = `${isShown("residue", name) ? "Hide" : "Show"} water (${name}, ${short(count)})`; });
  }
}

onUpdate(show);
on("settled", offerWater);
