// SPDX-License-Identifier: Apache-2.0
// The page: tabs, actions, status, exports, keys.
import "./legend.js";
import { makeDataControls } from "./data.js";
import { fit, cameraKey, canvas, lookAlong } from "./picture.js";
import { clearPicks, hidePicked } from "./picks.js";
import { makePanel } from "./panel.js";
import { $, ask, asked, attempt, canStep, command, current, element, isSettled, on, onImage, onUpdate, option, own, page, problem, resize, restore, start, state, textOf,
         undo, UNREACHABLE, view, wanted } from "./store.js";
import { copy, dismiss, toast } from "./toasts.js";
import * as time from "./time.js";

const TABS = ["data", "look", "camera", "annotate", "export"];

// ---- Status -------------------------------------------------------------------------------------------------------

// The image that is shown, in words.
const QUALITY = [[1, "Sketch"], [4, "Refining"], [16, "Refining: good enough to look at"], [64, "Refining: good enough for a talk"], [Infinity, "Refining: good enough for print"]];
let quality = "";
onImage(({ samples, noise, isFinished }) => {
  quality = isFinished ? "Done" : QUALITY.find(([most]) => samples <= most)[1];
  $("status").title = `${samples} samples per pixel${noise ? `, noise ${noise}` : ""}`;
  tellStatus();
});

function tellStatus() {
  const { activity = "reading", progress = 0 } = state ?? {}, isPreparing = !isSettled() && activity !== "";
  const doing = { reading: progress < 1 ? `Reading ${page?.title ?? ""}` : "Choosing sizes, colours and a view",
                  compiling: "Preparing the particles", building: "Building the search tree" }[activity];
  const text = problem() ? "The last change has a problem" : state?.problem ? "Stopped" : isPreparing ? doing : quality || "Starting";
  if ($("status").textContent !== text) $("status").textContent = text;
  $("progress").hidden = $("stop").hidden = isSettled();
  if (isPreparing && progress > 0 && progress < 1) $("progress").value = progress;
  else $("progress").removeAttribute("value");
  $("undo").disabled = !canStep(-1);
  $("redo").disabled = !canStep(1);
}
on("settled", tellStatus);
function tellState() {
  canvas.dataset.problem = state.problem;
  dismiss("problem");
  // The section of the option has it as well, but may be out of sight.
  if (problem() && ![...document.querySelectorAll(".message")].some(one => one.offsetParent)) toast(problem(), { isError: true, key: "problem" });
  $("command").value = state.command;
  $("notes").replaceChildren(...[...state.warnings, ...state.notes].map(note => element("li", { textContent: note })));
  $("film-kind").options[0].disabled = !(state.frames > 1);
  tellStatus();
}
on("busy", ({ activity }) => { if (!isSettled()) $("status").textContent = `Another page is being rendered${activity ? `: ${activity}` : ""}`; });
on("command", text => { $("command").value = text; });
on("problem", text => toast(text, { isError: true }));
on("reachable", isReachable => {
  if (isReachable) dismiss("ended");
  else toast(UNREACHABLE, { isError: true, key: "ended", action: ["Copy command", copyCommand] });
});

// ---- Exports ------------------------------------------------------------------------------------------------------

const copyCommand = () => copy($("command").value, "the command that makes this picture");

// Saves a file of the program. A link could not send the secret.
async function download(file) {
  if (!isSettled()) toast(`${file} is saved when the picture is complete.`, { key: "save" });
  const answer = await own(file);
  if (!answer) return;
  if (!answer.ok) return toast(await answer.text(), { isError: true });
  const link = element("a", { href: URL.createObjectURL(await answer.blob()), download: file });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);  // when it has been saved
  toast(`Saved: ${file}`, { key: "save" });
}

function makeSizes() {
  const list = $("size"), fields = [$("width"), $("height")];
  list.onchange = () => resize(list.value ? list.value.split(" ").map(Number) : null);
  for (const field of fields) field.onchange = () => resize(fields.map(({ value }) => Math.max(1, Math.round(Number(value)) || 1)));
  onUpdate(() => {
    for (const field of fields) field.value = option(`--${field.id}`) || state?.[field.id] || "";
    const value = view.fills ? "" : fields.map(field => field.value).join(" ");
    if (![...list.options].some(one => one.value === value)) list.append(element("option", { value, textContent: value.replace(" ", " × ") }));
    list.value = value;
  });
}

// A program that is stopped before it can answer ends with another status than 75.
let isFilmCancelled = false;

// The wish for a film: frames of the file, or an orbit.
function filmWish() {
  const { options, camera } = wanted(), seconds = Number($("film-seconds").value) || 4, fps = Number($("film-fps").value) || 24;
  const out = { ...options };
  if (!command("--style")) {  // a scene
    const count = Math.max(2, Math.round(seconds * fps));
    out["--set"] = [...(options["--set"] ?? []), `animation.turntable=${count}`];
    out["--frames"] = `1-${count}`;
    return { options: out, camera };
  }
  if (fps !== 24) out["--fps"] = String(fps);
  if ($("film-kind").value === "frames") {
    delete out["--frame"];
    out["--frames"] = "all";
    return { options: out, camera: current() };
  }
  return { options: { ...out, "--turntable": `${seconds}s` }, camera };
}

async function makeFilm() {
  isFilmCancelled = false;
  const answer = await ask(page.saves ? "film/start" : "film/command", asked(filmWish()));
  if (answer && page.saves) followFilm();
  else if (answer) copy(answer.command, "the command that makes this film");
}

function cancelFilm() {
  isFilmCancelled = true;
  ask("film/cancel", {});
}

async function followFilm() {
  for (;;) {
    const film = await ask("film", undefined, true);
    if (film) {
      const { is_running: isRunning, progress, status } = film, isMade = status === 0;
      $("film-progress").hidden = $("film-cancel").hidden = !isRunning;
      $("film").disabled = isRunning;
      $("film-progress").value = (progress?.progress ?? 0) / 100;
      $("film-state").textContent = isRunning ? `Film: ${progress?.goal ?? "starting"}` : "";
      if (!isRunning) return toast(isMade ? `Film saved: ${film.file}` : status === 75 || isFilmCancelled ? "The film was stopped; the same command goes on with it."
        : `No film: ${film.messages.join("\n")}`, { isError: !isMade });
    }
    await new Promise(done => setTimeout(done, 300));
  }
}

// ---- Views with a name --------------------------------------------------------------------------------------------

function makeViews() {
  const place = `views of ${page.title}`;
  const keep = views => {
    attempt(() => localStorage.setItem(place, JSON.stringify(views)));
    $("view-list").replaceChildren(...Object.entries(views).map(([name, text]) => element("li", {},
      element("button", { type: "button", textContent: name, onclick: () => restore(text) }),
      element("button", { type: "button", className: "icon", textContent: "×", "aria-label": `Forget ${name}`,
                          onclick: () => keep(Object.fromEntries(Object.entries(views).filter(([other]) => other !== name))) }))));
    $("keep").onclick = () => {
      keep({ ...views, [$("view-name").value.trim() || `View ${Object.keys(views).length + 1}`]: textOf({ ...view, camera: current() }) });
      $("view-name").value = "";
    };
  };
  keep(attempt(() => JSON.parse(localStorage.getItem(place))) ?? {});
}

// ---- Keys ---------------------------------------------------------------------------------------------------------

// What a key does, and a button that has the key, or another name, in `data-key`.
const ACTIONS = { c: copyCommand, s: () => download("picture.png"), " ": time.toggle, "[": () => time.step(-1), "]": () => time.step(1), f: fit,
                  Escape: clearPicks, Delete: hidePicked, "?": () => $("keys").showModal(),
                  undo: () => undo(), redo: () => undo(1), stop: () => ask("cancel", {}), film: makeFilm, "cancel film": cancelFilm,
                  panel: () => $("hide-panel").setAttribute("aria-expanded", String(!document.body.classList.toggle("wide"))) };
TABS.forEach((id, i) => { ACTIONS[i + 1] = () => $(`for-${id}`).click(); });

document.addEventListener("keydown", event => {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key, at = event.target;
  if (at.closest("dialog[open]") || !page) return;
  const isTyping = at.matches("textarea, select, input:not([type=checkbox], [type=radio], [type=range])");
  if (event.ctrlKey || event.metaKey) {
    if (isTyping || !["z", "y"].includes(key)) return;
    undo(key === "y" || event.shiftKey ? 1 : -1);
  } else if (isTyping || event.altKey || (at !== canvas && at !== document.body && (key === " " || /^(Arrow|Esc)/.test(key)))) {
    return;
  } else if (ACTIONS[key]) ACTIONS[key]();
  else if (!cameraKey(event)) return;
  event.preventDefault();
});

// ---- Start --------------------------------------------------------------------------------------------------------

const each = (selector, f) => document.querySelectorAll(selector).forEach(button => { button.onclick = event => f(button.dataset, event); });
each("[data-key]", ({ key }) => ACTIONS[key]());
each("[data-file]", ({ file }) => download(file));
each("[data-axis]", ({ axis, side }, { shiftKey }) => lookAlong(Number(axis), (shiftKey ? -1 : 1) * Number(side)));

on("page", () => {
  const isScene = !command("--color-by");
  document.title = `${page.title} - orrery view`;
  $("file").textContent = page.title;
  $("name-data").textContent = isScene ? "Scene" : "Data";
  $("for-look").disabled = $("for-look").parentElement.hidden = isScene;
  makeDataControls();
  makePanel();
  makeSizes();
  makeViews();
  $("film").textContent = page.saves ? "Make the film" : "Copy the command of the film";
  $("film-bar").hidden = $("films").hidden = !page.films;
  on("state", tellState);
  if (page.saves) ask("film", undefined, true).then(film => film?.is_running && followFilm());
});
start();
