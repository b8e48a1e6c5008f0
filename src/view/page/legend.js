// SPDX-License-Identifier: Apache-2.0
// The legend on the picture: classes that a click hides, shows alone, makes translucent or colours.
import { $, element, on, option, state } from "./store.js";
import { colourColumn, summary } from "./data.js";
import { equals, hasRules, isAlone, isShown, isWritable, ruleValue, setAlone, setRule, setShown } from "./rules.js";

const GHOST = "0.25", MOST = 60;
const colours = new Map();  // by column and class: of hidden ones, too
const WATER = /^(HOH|WAT|H2O|SOL|TIP3?|TIP4P?|SPC)$/;

const short = count => count < 10000 ? String(count) : count < 1e6 ? `${Math.round(count / 1000)} k` : `${(count / 1e6).toPrecision(3)} M`;

function iconButton(text, label, isPressed, f) {
  const button = element("button", { type: "button", className: "icon", textContent: text, title: label, "aria-label": label, "aria-pressed": String(isPressed) });
  button.addEventListener("click", f);
  return button;
}

function classRow(column, value, count) {
  const isVisible = isShown(column, value), canSet = isWritable(column, value), condition = canSet ? equals(column, value) : "";
  const opacity = canSet ? ruleValue("--opacity", condition) : "", colour = colours.get(`${column} ${value}`) ?? "#999999";
  let patch = element("i");
  if (canSet && hasRules("--color")) {
    patch = element("input", { type: "color", value: colour, "aria-label": `Colour of ${value}` });
    patch.addEventListener("change", () => setRule("--color", condition, patch.value));
  }
  patch.style.background = colour;
  patch.style.opacity = isVisible ? opacity || 1 : 0.2;
  const name = element("button", { type: "button", className: "name", textContent: value || "(empty)", disabled: !canSet,
    title: `${isVisible ? "Hide" : "Show"} ${condition || value}`, "aria-pressed": String(isVisible) });
  name.addEventListener("click", () => setShown(column, value, !isVisible));
  const out = element("div", { className: isVisible ? "class" : "class off" }, patch, name,
    element("em", { textContent: isVisible ? opacity ? `${Math.round(opacity * 100)} %` : short(count) : "hidden" }));
  if (canSet) out.append(
    iconButton("◉", `Only ${value}`, isAlone(column, value), () => setAlone(column, value)),
    iconButton("◌", `${value} translucent`, opacity !== "", () => setRule("--opacity", condition, opacity ? "" : GHOST)));
  return out;
}

let shown = "", serial = 0;
async function show() {
  const legend = state?.legend, column = colourColumn(), box = $("legend"), mine = ++serial;
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
  if (isBar) {
    const bar = element("div", { className: "bar" });
    bar.style.background = `linear-gradient(90deg, ${legend.bar.filter((_, i) => i % 15 === 0).join(", ")})`;
    const [low, high] = legend.range, middle = legend.log ? Math.sqrt(low * high) : (low + high) / 2;
    parts.push(bar, element("div", { className: "ticks" }, ...[low, middle, high].map(v => element("span", { textContent: String(Number(v.toPrecision(3))) }))));
  }
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
  const column = state?.data?.columns.find(([name]) => name === "residue")?.[0];
  if (!column || watered || $("picture").dataset.settled !== "true") return;
  watered = true;
  const known = await summary(column), found = known?.classes?.filter(([name]) => WATER.test(name)) ?? [];
  for (const [name, count] of found) {
    const button = element("button", { type: "button", className: "water" });
    const tell = () => { button.textContent = `${isShown(column, name) ? "Hide" : "Show"} water (${name}, ${short(count)})`; };
    button.addEventListener("click", () => setShown(column, name, !isShown(column, name)));
    on("view", tell);
    tell();
    $("select").parentElement.after(button);
  }
}

on("view", show);
on("state", show);
on("settled", offerWater);
