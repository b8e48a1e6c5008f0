// SPDX-License-Identifier: Apache-2.0
// Returns what is inaccessible in what the page shows now, a text for each finding: names, labels, roles, headings,
// landmarks, references, contrast and the size of targets. The rules are those of WCAG 2.2, AA.
const findings = [], all = selector => [...document.querySelectorAll(selector)];
const describe = e => `<${e.tagName.toLowerCase()}${e.id ? ` id=${e.id}` : ""} class="${e.className}"> ${(e.ariaLabel || e.textContent).trim().slice(0, 30)}`;
const report = (rule, e, detail = "") => findings.push(`${rule}: ${describe(e)} ${detail}`);
const modal = document.querySelector("dialog[open]");
const isVisible = e => e.checkVisibility({ visibilityProperty: true }) && (!modal || modal.contains(e));
const shown = selector => all(selector).filter(isVisible);

// ---- Names, labels and roles
const textOf = e => (e?.textContent ?? "").trim();
const labels = e => [...e.labels ?? []].map(textOf).join(" ");
const referred = e => (e.getAttribute("aria-labelledby") ?? "").split(" ").map(id => textOf(document.getElementById(id))).join(" ").trim();
const TARGETS = "button, input, select, textarea, summary, a[href], [role=slider], [tabindex='0']";
for (const e of shown(TARGETS)) {
  const isField = e.matches("input, select, textarea");
  const content = isField || e.matches("[role=img]") ? "" : textOf(e);
  const label = e.getAttribute("aria-label") || referred(e) || labels(e) || content;
  if (!label && (isField || !e.title) && !e.matches("dl")) report("no name", e);
  if (e.ariaLabel && /[a-z0-9]/i.test(content) && !e.ariaLabel.toLowerCase().includes(content.toLowerCase())) report("the name lacks the text", e);
  if (e.tabIndex > 0) report("positive tabindex", e);
}
const ROLES = { img: ["canvas"], radiogroup: ["div"], slider: ["div"], status: ["div", "span", "p"], alert: ["div", "p"] };
for (const e of all("[role]")) if (!ROLES[e.getAttribute("role")]?.includes(e.tagName.toLowerCase())) report("role", e, e.getAttribute("role"));
for (const e of shown("[role=slider]")) if (["min", "max", "now"].some(name => !Number.isFinite(parseFloat(e.getAttribute(`aria-value${name}`))))) report("slider without value", e);
for (const e of shown("[role=radiogroup]")) if (!e.querySelector("input[type=radio]")) report("empty group", e);
for (const e of shown("input[type=radio]")) if (!e.closest("[role=radiogroup], fieldset")) report("radio button without a group", e);
for (const e of shown("svg, canvas, img")) if (!e.closest("[aria-hidden=true]") && !e.ariaLabel) report("image without a name", e);
for (const e of all("[aria-hidden=true]")) if (e.querySelector(TARGETS)) report("hidden from readers, but not from the keyboard", e);

// ---- References
const ids = all("[id]").map(e => e.id);
for (const e of all("[id]")) if (ids.filter(id => id === e.id).length > 1) report("duplicate id", e);
for (const e of all("[for], [aria-controls], [aria-labelledby], [aria-describedby]"))
  for (const name of ["for", "aria-controls", "aria-labelledby", "aria-describedby"])
    for (const id of (e.getAttribute(name) ?? "").split(" ").filter(Boolean)) if (!ids.includes(id)) report(`${name} of nothing`, e, id);

// ---- Structure
if (!document.documentElement.lang || !document.title) findings.push("no language or no title");
if (all("main").length !== 1 || all("h1").filter(e => e.checkVisibility()).length !== 1) findings.push("not one main and one h1");
let level = 1;
for (const e of shown("h1, h2, h3, h4")) {
  const now = Number(e.tagName[1]);
  if (now > level + 1) report("skipped level of heading", e);
  level = now;
}
const texts = [];
for (const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT); walker.nextNode();)
  if (walker.currentNode.data.trim() && isVisible(walker.currentNode.parentElement)) texts.push(walker.currentNode.parentElement);
for (const e of new Set(texts)) if (!e.closest("main, aside, header, section[aria-label], dialog")) report("outside of the landmarks", e);

// ---- Contrast
const parse = color => {
  const [r, g, b, a = 1] = color.match(/[\d.]+/g).map(Number);
  return { rgb: [r, g, b], a };
};
const over = (top, under, a) => top.map((v, i) => v * a + under[i] * (1 - a));
const luminance = rgb => rgb.map(v => v / 255).map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4).reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
const ratio = (a, b) => {
  const [light, dark] = [luminance(a), luminance(b)].sort((x, y) => y - x);
  return (light + 0.05) / (dark + 0.05);
};
// The background of an element: for chips on the picture it may be anything, black or white at the extremes.
function backgrounds(e) {
  const { rgb, a } = parse(getComputedStyle(e).backgroundColor);
  if (a === 1) return [rgb];
  const behind = e.id === "stage" ? [[0, 0, 0], [255, 255, 255]] : e.parentElement ? backgrounds(e.parentElement) : [[255, 255, 255]];
  return behind.map(under => over(rgb, under, a));
}
const isOnPicture = e => e.closest("#stage") !== null;
for (const e of new Set([...texts, ...shown("input, select, textarea")])) {
  const style = getComputedStyle(e), { rgb, a } = parse(style.color);
  if (e.closest(":disabled, option, .toggle:has(:disabled), [aria-hidden=true]") || e.matches("input[type=color], input[type=range]") || style.clipPath !== "none") continue;
  const list = isOnPicture(e) && backgrounds(e).length === 1 && e.closest("#stage > *") === null ? [[0, 0, 0], [255, 255, 255]] : backgrounds(e);
  const least = Math.min(...list.map(back => ratio(over(rgb, back, a), back)));
  const isLarge = parseFloat(style.fontSize) >= 24 || (parseFloat(style.fontSize) >= 18.66 && Number(style.fontWeight) >= 700);
  if (least < (isLarge ? 3 : 4.5)) report("contrast", e, least.toFixed(2));
}

// ---- Targets: 24 pixels, or as much room around the middle
const middle = box => [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
const isScrolledAway = (e, box) => {
  for (let around = e.parentElement; around; around = around.parentElement) {
    const { top, bottom } = around.getBoundingClientRect();
    if (getComputedStyle(around).overflowY !== "visible" && (middle(box)[1] < top || middle(box)[1] > bottom)) return true;
  }
  return false;
};
const boxes = shown(TARGETS).map(e => {
  const isCovered = getComputedStyle(e).opacity === "0";  // its label is what one sees
  return { e, box: (isCovered ? e.closest("label") : e).getBoundingClientRect() };
}).filter(({ e, box }) => box.width > 0 && !e.matches("canvas") && !isScrolledAway(e, box));  // a canvas is under them
for (const { e, box } of boxes) {
  if (Math.min(box.width, box.height) >= 24 || e.matches("input[type=range], input[type=checkbox], input[type=radio]:not(.segments *)")) continue;
  const [x, y] = middle(box);
  const isNear = boxes.some(other => other.e !== e && !other.e.contains(e) && !e.contains(other.e) &&
    Math.hypot(Math.max(other.box.left - x, 0, x - other.box.right), Math.max(other.box.top - y, 0, y - other.box.bottom)) < 12);
  if (isNear) report("small target", e, `${box.width} x ${box.height}`);
}
return findings;
