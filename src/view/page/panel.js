// SPDX-License-Identifier: Apache-2.0
// The controls, by tab. Each section is headed by the options that it sets; options of the program that no section has
// are listed under "More", so that a new one needs no change here.
import { $, command, control, element, lastOption, on, option, page, set, setStill, state } from "./store.js";
import { columnSection, cutSection, mapSection } from "./data.js";
import { listObjects } from "./scene.js";
import { baseOf, hasRules, rulesOf, withBase } from "./rules.js";

const TAB_OF = { "Data options": "data", "Look options": "look", "View options": "camera", "Annotation options": "annotate" };
const PLACED = new Set(["--frame", "--frames", "--width", "--height", "--color-by", "--map", "--range", "--slice", "--set"]);
const HINTS = {
  "--select": "type == 2 && z > 0", "--opacity": "type == 2: 0.3", "--representation": "chain == \"A\": sticks",
  "--title": "t = {step * 0.005:.1f} ps", "--label": "id == 5: Fe", "--center": "id == 5", "--background": "navy or #203040",
  "--scale-bar": "auto, or 2 nm", "--vectors": "vx,vy,vz", "--set": "key=value",
};

const updates = [];  // called when the state has changed
export const onUpdate = f => { updates.push(f); };

// An option as it is typed.
function typed(name) {
  const word = value => /^[\w@%+=:,./-]+$/.test(value) ? value : `'${value.replaceAll("'", "'\\''")}'`;
  return [option(name)].flat().map(value => value === "" ? "" : value === true ? name : `${name} ${word(value)}`).join(" ").trim();
}

// A section of a tab. `names`: the options that it sets, those first that head it while nothing is set.
export function section(title, names, ...parts) {
  const code = element("code");
  const message = element("p", { className: "message", role: "alert", hidden: true });
  onUpdate(() => {
    const set = names.map(typed).filter(text => text !== "").join(" ");
    code.textContent = set || names[0];
    code.className = set ? "on" : "";
    const isFaulty = Boolean(state?.problem) && names.includes(lastOption);
    message.hidden = !isFaulty;
    message.textContent = isFaulty ? state.problem : "";
  });
  return element("section", {}, element("h3", {}, title, " ", code), ...parts.filter(Boolean), message);
}

let rows = 0;
export function row(label, ...fields) {
  const [field] = fields;
  field.id ||= `field-${++rows}`;
  return element("div", { className: "row" }, element("label", { htmlFor: field.id, textContent: label }), ...fields);
}

const isEdited = field => document.activeElement === field;

// ---- Kinds of controls --------------------------------------------------------------------------------------------

function textField(name, id = name.slice(2)) {
  const { repeatable, help } = control(name);
  const field = repeatable ? element("textarea", { rows: 1, title: help }) : element("input", { type: "text", title: help });
  field.spellcheck = false;
  field.placeholder = HINTS[name] ?? "";
  field.id = id;
  field.addEventListener("change", () => {
    const value = field.value.trim();
    set({ [name]: repeatable ? value.split("\n").map(line => line.trim()).filter(Boolean) : value });
  });
  onUpdate(() => {
    if (isEdited(field)) return;
    field.value = [option(name)].flat().join("\n");
    if (state?.chosen[name]) field.placeholder = state.chosen[name];
    if (repeatable) field.rows = Math.min(6, Math.max(1, option(name).length));
  });
  return field;
}

function toggle(name, label) {
  const box = element("input", { type: "checkbox", id: name.slice(2) });
  box.addEventListener("change", () => set({ [name]: box.checked }));
  onUpdate(() => { box.checked = option(name) === true; });
  return element("label", { className: "toggle", title: control(name).help }, box, label);
}

// A choice among a few words, without a condition. `otherwise`: what the empty value is called.
function segments(name, values, otherwise) {
  const group = element("div", { className: "segments", role: "radiogroup", "aria-label": name, id: name.slice(2) });
  for (const value of values) {
    const input = element("input", { type: "radio", name, value });
    input.addEventListener("change", () => set({ [name]: withBase(name, value === otherwise ? "" : value) }));
    onUpdate(() => { input.checked = (baseOf(name) || state?.chosen[name] || otherwise) === value; });
    group.append(element("label", {}, input, element("span", { textContent: value.replaceAll("-", " ") })));
  }
  return group;
}

// A slider for a number. `otherwise`: the value without the option. While it is dragged, only sketches are drawn.
function slider(label, name, { min, max, step, otherwise, unit = "" }) {
  const field = element("input", { type: "range", min, max, step, id: name.slice(2) });
  const output = element("output", { htmlFor: field.id });
  const change = moves => {
    const value = Number(field.value) === otherwise ? "" : field.value;
    setStill({ [name]: withBase(name, value) }, moves);
  };
  field.addEventListener("input", () => change(true));
  field.addEventListener("change", () => change(false));
  onUpdate(() => {
    const value = baseOf(name);
    if (!isEdited(field) || Number(field.value) !== Number(value)) field.value = value === "" ? otherwise : value;
    output.value = `${value === "" ? otherwise : value}${unit}`;
  });
  return element("div", { className: "row" }, element("label", { htmlFor: field.id, textContent: label }), field, output);
}

// The values under conditions of an option, a line each.
const rules = name => hasRules(name) && element("details", { open: rulesOf(name).length > 0 },
  element("summary", { textContent: "By condition" }), textField(name, `${name.slice(2)}-rules`));

function colours(name) {
  const wheel = element("input", { type: "color", id: "background-colour", "aria-label": "Other background" });
  wheel.addEventListener("change", () => set({ [name]: wheel.value }));
  const swatches = ["", "white", "#e8eaed", "#20242a", "black"].map(value => {
    const button = element("button", { type: "button", className: "swatch", textContent: value ? "" : "auto",
                                       "aria-label": value || "Background of the style", title: value || "Of the style" });
    if (value) button.style.background = value;
    button.addEventListener("click", () => set({ [name]: value }));
    onUpdate(() => button.setAttribute("aria-pressed", String(option(name) === value)));
    return button;
  });
  return element("div", { className: "row swatches" }, ...swatches, wheel, textField(name));
}

// A control for any option.
function anyControl({ name, type, values, repeatable, help }) {
  if (type === "") return toggle(name, help);
  const label = name.slice(2).replaceAll("-", " ");
  if (values.length === 0 || repeatable) return row(label, textField(name));
  const list = element("select", { id: name.slice(2), title: help }, element("option", { value: "", textContent: "default" }),
                       ...values.map(value => element("option", { value, textContent: value })));
  list.addEventListener("change", () => set({ [name]: list.value }));
  onUpdate(() => { list.value = option(name); });
  return row(label, list);
}

// ---- Tabs ---------------------------------------------------------------------------------------------------------

const placed = name => command(name) && PLACED.add(name);
const ifHas = (name, make) => placed(name) && make(name);

function dataTab() {
  if (!command("--color-by")) return sceneTab();
  return [columnSection(), mapSection(),
    ifHas("--select", name => section("Show", [name], element("div", { className: "row wide" }, textField(name)))),
    cutSection(),
    ifHas("--representation", name => section("As", [name, "--radius-scale", "--opacity"],
      segments(name, control(name).values.length ? control(name).values : ["spheres", "ball-and-stick", "sticks", "trace", "points"], "spheres"),
      rules(name),
      ifHas("--radius-scale", () => slider("Size", "--radius-scale", { min: 0.1, max: 3, step: 0.05, otherwise: 1, unit: "×" })),
      ifHas("--opacity", () => slider("Opacity", "--opacity", { min: 0, max: 1, step: 0.05, otherwise: 1 })),
      rules("--opacity"))),
    ifHas("--bonds", name => section("Bonds and arrows", [name, "--vectors"], row("Bonds", textField(name)),
                                     ifHas("--vectors", () => row("Arrows", textField("--vectors")))))];
}

const lookTab = () => [
  ifHas("--style", name => section("Light", [name], segments(name, control(name).values, "studio"))),
  ifHas("--material", name => section("Material", [name], segments(name, control(name).values, "matte"))),
  ifHas("--background", name => section("Background", [name], colours(name))),
  ifHas("--depth-cue", name => section("Depth", [name], slider("Depth cue", name, { min: 0, max: 1, step: 0.05, otherwise: 0 }))),
  ifHas("--outline", name => section("Outline", [name], slider("Width", name, { min: 0, max: 6, step: 0.5, otherwise: 0, unit: " px" }))),
  command("--ground") && section("Around it", ["--ground", "--box", "--axes"], ...[["--ground", "Ground"], ["--box", "Box of the simulation"],
    ["--axes", "Axes"]].map(([name, label]) => ifHas(name, () => toggle(name, label))))];

const cameraTab = () => [
  element("section", {}, element("h3", { textContent: "Direction" }), $("directions")),
  ifHas("--perspective", name => section("Perspective", [name], slider("Field", name, { min: 0, max: 90, step: 5, otherwise: 0, unit: "°" }))),
  ifHas("--center", name => section("Turn about", [name], element("div", { className: "row wide" }, textField(name)))),
  element("section", {}, element("h3", { textContent: "Views with a name" }), $("views"))];

const annotateTab = () => command("--title") ? [
  ifHas("--title", name => section("Title", [name], element("div", { className: "row wide" }, textField(name)))),
  ifHas("--scale-bar", name => section("Scale bar", [name], row("Length", textField(name)), scaleBar(name))),
  ifHas("--color-bar", name => section("Legend", [name], control(name).type === "" ? toggle(name, "In the image") : row("In the image", textField(name)))),
  ifHas("--label", name => section("Labels", [name], element("div", { className: "row wide" }, textField(name)))),
] : [element("section", {}, element("p", { textContent: "Text is a setting of the scene: annotation.title and the like, in the tab Export." }))];

function scaleBar(name) {
  const button = element("button", { type: "button", textContent: "Automatic" });
  button.addEventListener("click", () => set({ [name]: option(name) === "auto" ? "" : "auto" }));
  return element("div", { className: "row" }, element("span"), button);
}

const exportTab = () => [
  section("Size", ["--width", "--height"], $("sizes")),
  section("Quality", ["--quality", "--noise", "--samples", "--denoise"],
    ifHas("--quality", name => segments(name, control(name).values, "good")),
    ...["--noise", "--samples"].map(name => ifHas(name, () => row(name === "--noise" ? "Noise" : "Samples", textField(name)))),
    ifHas("--denoise", name => toggle(name, "Denoise"))),
  section("Image", ["-o picture.png"], $("images")),
  page.films && section("Film", ["--frames", "--turntable"], $("films")),
  section("Settings", ["--set"], element("div", { className: "row wide" }, textField("--set")))];

// The objects of a scene, by name; a setting for each key.
function sceneTab() {
  const list = element("div", { id: "objects" });
  on("state", () => { if (state.served > 0 && list.childElementCount === 0) listObjects(list); });
  return [element("section", {}, element("h3", {}, "Scene ", element("code", { textContent: "--set" })), list)];
}

export function makePanel() {
  for (const [id, make] of Object.entries({ data: dataTab, look: lookTab, camera: cameraTab, annotate: annotateTab, export: exportTab }))
    $(`tab-${id}`).append(...make().filter(Boolean));
  for (const id of ["data", "look", "camera", "annotate", "export"]) {
    const rest = page.options.filter(({ name, heading }) => !PLACED.has(name) && (TAB_OF[heading] ?? "export") === id);
    if (rest.length === 0) continue;
    $(`tab-${id}`).append(element("details", { className: "more" }, element("summary", { textContent: "More options" }), ...rest.map(anyControl)));
  }
  if (!command("--color-by")) {
    $("for-data").textContent = "Scene";
    $("for-look").hidden = true;
  }
  const update = () => updates.forEach(f => f());
  on("view", update);
  on("state", update);
  update();
}
