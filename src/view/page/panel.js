// SPDX-License-Identifier: Apache-2.0
// Connects the controls of view.html with the options that they set. Options that no section has are listed under "More",
// so that a new one needs no change here.
import { command, control, element, lastOption, onUpdate, option, page, problem, set, setStill, state } from "./store.js";
import { baseOf, withBase } from "./rules.js";

const TAB_OF = { "Data options": "data", "Look options": "look", "View options": "camera", "Annotation options": "annotate" };

// An option as it is typed.
function typed(name) {
  const word = value => /^[\w@%+=:,./-]+$/.test(value) ? value : `'${value.replaceAll("'", "'\\''")}'`;
  return [option(name)].flat().map(value => value === "" ? "" : value === true ? name : `${name} ${word(value)}`).join(" ").trim();
}

// Heads a section with the options that it sets, and shows the problem of the last change under it.
function head(section, names) {
  const code = element("code"), message = element("p", { className: "message", role: "alert" });
  section.querySelector("h2").append(" ", code);
  section.append(message);
  onUpdate(() => {
    const set = names.map(typed).filter(text => text !== "").join(" ");
    code.textContent = set || names[0];
    code.className = set ? "on" : "";
    message.textContent = names.includes(lastOption) ? problem() : "";
  });
}

// Fills a group with a radio button for each value. `show`: shows a value in a span.
export function choices(group, values, { name, chosen, choose, show = (span, value) => { span.textContent = value.replaceAll("-", " "); } }) {
  for (const value of values) {
    const span = element("span");
    show(span, value);
    const input = element("input", { type: "radio", name, value, title: value, "aria-label": span.textContent || value, onchange: () => choose(value) });
    onUpdate(() => { input.checked = chosen() === value; });
    group.append(element("label", {}, input, span));
  }
}

// ---- Kinds of controls --------------------------------------------------------------------------------------------

function bindText(field, name) {
  const { repeatable } = control(name), hint = field.placeholder;
  field.spellcheck = false;
  field.onchange = () => {
    const lines = field.value.split("\n").map(line => line.trim()).filter(Boolean);
    set({ [name]: repeatable ? lines : lines[0] ?? "" });
  };
  onUpdate(() => {
    if (document.activeElement === field) return;
    field.value = [option(name)].flat().join("\n");
    field.placeholder = state?.chosen[name] || hint || "";
    if (repeatable) field.rows = Math.min(6, Math.max(1, option(name).length));
  });
}

function bindBox(field, name) {
  field.onchange = () => set({ [name]: field.checked });
  onUpdate(() => { field.checked = option(name) === true; });
}

// A slider for a number. While it is dragged, only sketches are drawn.
function bindSlider(field, name) {
  const otherwise = field.defaultValue;  // without the option
  const change = moves => setStill({ [name]: withBase(name, field.value === otherwise ? "" : field.value) }, moves);
  field.oninput = () => change(true);
  field.onchange = () => change(false);
  onUpdate(() => {
    field.value = baseOf(name) || otherwise;
    field.nextElementSibling.value = (baseOf(name) || otherwise) + (field.dataset.unit ?? "");
  });
}

// A choice among a few words, without a condition.
function bindChoices(group, name) {
  const { otherwise, values = control(name).values.join(" ") } = group.dataset;
  const chosen = () => baseOf(name) || state?.chosen[name] || otherwise;
  choices(group, values.split(" "), { name, chosen, choose: value => set({ [name]: withBase(name, value === otherwise ? "" : value) }) });
}

// A button for one value.
function bindButton(button, name) {
  if (button.className === "swatch") button.style.background = button.value;
  button.onclick = () => set({ [name]: option(name) === button.value ? "" : button.value });
  onUpdate(() => button.setAttribute("aria-pressed", String(option(name) === button.value)));
}

const BINDS = { checkbox: bindBox, range: bindSlider, button: bindButton };
function bind(field) {
  const name = field.dataset.option;
  field.title ||= control(name).help;
  const isGroup = field.type === undefined;
  (isGroup ? bindChoices : BINDS[field.type] ?? bindText)(field, name);
}

// A control for any option.
function anyControl({ name, type, values, repeatable, help }) {
  const isFlag = type === "", hasList = values.length > 0 && !repeatable;
  const field = element(repeatable ? "textarea" : hasList ? "select" : "input", { id: name.slice(2) });
  field.dataset.option = name;
  if (hasList) field.append(...["", ...values].map(value => element("option", { value, textContent: value || "default" })));
  if (!isFlag) return element("label", { className: "row" }, element("span", { textContent: name.slice(2).replaceAll("-", " ") }), field);
  field.type = "checkbox";
  return element("label", { className: "toggle" }, field, help);
}

export function makePanel() {
  const isData = command("--color-by"), placed = new Set(["--frame"]);
  for (const section of document.querySelectorAll("[data-for]")) section.hidden = isData;
  for (const section of document.querySelectorAll("[data-sets]")) {
    const names = section.dataset.sets.split(" ").filter(command);
    for (const name of names) placed.add(name);
    if (names.length > 0) head(section, names);
    else section.remove();
  }
  for (const tab of document.querySelectorAll(".tab")) {
    const rest = page.options.filter(({ name, heading }) => !placed.has(name) && `tab-${TAB_OF[heading] ?? "export"}` === tab.id);
    if (rest.length > 0) tab.append(element("details", { className: "more" }, element("summary", { textContent: "More options" }), ...rest.map(anyControl)));
  }
  for (const field of document.querySelectorAll("[data-option]")) {
    if (command(field.dataset.option)) bind(field);
    else (field.closest(".row, .toggle") ?? field).hidden = true;
  }
}
