// SPDX-License-Identifier: Apache-2.0
// The page: tabs, actions, status, exports, keys.
import "./legend.js";
import { fit, cameraKey, canvas, lookAlong } from "./picture.js";
import { clearPicks, hidePicked } from "./picks.js";
import { makePanel } from "./panel.js";
import { $, ask, canStep, command, current, element, isSettled, on, onImage, option, own, page, resize, restore, start,
         state, textOf, undo, UNREACHABLE, view, wanted } from "./store.js";
import { copy, dismiss, toast } from "./toasts.js";
import * as time from "./time.js";

const SIZES = [[640, 360], [1280, 720], [1920, 1080], [3840, 2160], [1080, 1080], [1080, 1920]];
const TABS = ["data", "look", "camera", "annotate", "export"];

// ---- Tabs ---------------------------------------------------------------------------------------------------------

function openTab(id) {
  $(`for-${id}`).checked = true;
  for (const other of TABS) $(`tab-${other}`).hidden = other !== id;
}
for (const id of TABS) $(`for-${id}`).addEventListener("change", () => openTab(id));

// ---- Status -------------------------------------------------------------------------------------------------------

let quality = "";  // of the image that is shown, in words
onImage(({ samples, noise, isFinished }) => {
  quality = isFinished ? "Done" : samples <= 1 ? "Sketch" : samples < 4 ? "Refining" : samples < 16 ? "Refining: good enough to look at"
    : samples < 64 ? "Refining: good enough for a talk" : "Refining: good enough for print";
  $("status").title = `${samples} samples per pixel${noise ? `, noise ${noise}` : ""}`;
  tellStatus();
});

function tellStatus() {
  const { activity = "reading", progress = 0, problem = "" } = state ?? {};
  const isBusy = !isSettled(), isPreparing = isBusy && activity !== "";
  const words = { reading: `Reading ${page?.title ?? ""}`, "building the BVH": "Preparing the particles" };
  const text = problem ? (problem === "stopped" ? "Stopped" : "The last change has a problem") : isPreparing ? words[activity] ?? activity : quality || "Starting";
  if ($("status").textContent !== text) $("status").textContent = text;
  $("progress").hidden = !isBusy;
  $("stop").hidden = !isBusy;
  if (isPreparing && progress > 0) $("progress").value = progress;
  else $("progress").removeAttribute("value");
  $("undo").disabled = !canStep(-1);
  $("redo").disabled = !canStep(1);
}
on("settled", tellStatus);
on("state", () => {
  $("problem").textContent = canvas.dataset.problem = state.problem;
  if (state.problem && state.problem !== "stopped") {
    const isSeen = [...document.querySelectorAll(".message")].some(one => !one.hidden && one.offsetParent);
    if (!isSeen) toast(state.problem, { isError: true, key: "problem" });
  } else {
    dismiss("problem");
  }
  $("command").value = state.command;
  const notes = [...state.warnings, ...state.notes];
  if ($("notes").dataset.text !== notes.join("\n")) {
    $("notes").dataset.text = notes.join("\n");
    $("notes").replaceChildren(...notes.map(note => element("li", { textContent: note })));
  }
  tellStatus();
});
on("busy", told => { if (!isSettled()) $("status").textContent = `Another page is being rendered${told.activity ? `: ${told.activity}` : ""}`; });
on("command", text => { $("command").value = text; });
on("problem", text => toast(text, { isError: true }));
on("reachable", isReachable => {
  if (isReachable) dismiss("ended");
  else toast(UNREACHABLE, { isError: true, key: "ended", action: ["Copy command", copyCommand] });
});
$("stop").addEventListener("click", () => ask("cancel", {}));
$("undo").addEventListener("click", () => undo());
$("redo").addEventListener("click", () => undo(1));

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
  const list = $("size"), name = (w, h) => `${w} × ${h}`;
  list.append(element("option", { value: "", textContent: "as the window" }), ...SIZES.map(([w, h]) => element("option", { value: `${w} ${h}`, textContent: name(w, h) })));
  list.addEventListener("change", () => resize(list.value ? list.value.split(" ").map(Number) : null));
  for (const field of [$("width"), $("height")])
    field.addEventListener("change", () => resize([$("width").value, $("height").value].map(value => Math.max(1, Math.round(Number(value)) || 1))));
  on("view", () => {
    const [w, h] = [option("--width"), option("--height")].map(value => value || "");
    $("width").value = w || state?.width || "";
    $("height").value = h || state?.height || "";
    const value = view.fills ? "" : `${$("width").value} ${$("height").value}`;
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
  const answer = await ask(page.saves ? "film/start" : "film/command", filmWish());
  if (!answer) return;
  if (!page.saves) return copy(answer.command, "the command that makes this film");
  followFilm();
}

async function followFilm() {
  $("film-progress").hidden = $("film-cancel").hidden = false;
  $("film").disabled = true;
  for (;;) {
    const film = await ask("film", undefined, true);
    if (film) {
      $("film-progress").value = (film.progress?.progress ?? 0) / 100;
      $("film-state").textContent = film.is_running ? `Film: ${film.progress?.goal ?? "starting"}` : "";
      if (!film.is_running) {
        $("film-progress").hidden = $("film-cancel").hidden = true;
        $("film").disabled = false;
        const isMade = film.status === 0;
        return toast(isMade ? `Film saved: ${film.file}` : film.status === 75 || isFilmCancelled ? "The film was stopped; the same command goes on with it."
          : `No film: ${film.messages.join("\n")}`, { isError: !isMade });
      }
    }
    await new Promise(done => setTimeout(done, 300));
  }
}

// ---- Views with a name --------------------------------------------------------------------------------------------

function makeViews() {
  const place = `views of ${page.title}`, read = () => { try { return JSON.parse(localStorage.getItem(place)) ?? {}; } catch { return {}; } };
  let kept = read();
  const list = () => $("view-list").replaceChildren(...Object.entries(kept).map(([name, text]) => {
    const open = element("button", { type: "button", textContent: name }), remove = element("button", { type: "button", className: "icon", textContent: "×", "aria-label": `Forget ${name}` });
    open.addEventListener("click", () => restore(text));
    remove.addEventListener("click", () => { delete kept[name]; save(); });
    return element("li", {}, open, remove);
  }));
  const save = () => { try { localStorage.setItem(place, JSON.stringify(kept)); } catch { /* of this page only */ } list(); };
  $("keep").addEventListener("click", () => {
    const name = $("view-name").value.trim() || `View ${Object.keys(kept).length + 1}`;
    kept = { ...kept, [name]: textOf({ ...view, camera: current() }) };
    $("view-name").value = "";
    save();
  });
  list();
}

// ---- Keys ---------------------------------------------------------------------------------------------------------

const KEYS = [["Arrows, or drag", "turn"], ["Shift drag, R", "roll"], ["Right drag, Ctrl drag", "move"], ["Wheel, + and -", "zoom"], ["F", "fit"],
  ["X, Y, Z", "look along an axis; with Shift from the other side"], ["Click; Shift click", "pick; measure to another one"], ["Double click", "turn about a particle"],
  ["Delete; Esc", "hide what is picked; forget it"], ["Space; [ and ]", "play; frame before and after"], ["Ctrl+Z; Ctrl+Shift+Z", "undo; redo"],
  ["C; S", "copy the command; save a PNG"], ["1 to 5", "tabs"], ["?", "this list"]];
$("keys-list").append(...KEYS.flatMap(([key, what]) => [element("dt", { textContent: key }), element("dd", { textContent: what })]));
const ACTIONS = { c: copyCommand, s: () => download("picture.png"), " ": time.toggle, "[": () => time.step(-1), "]": () => time.step(1), Escape: clearPicks,
                  Delete: hidePicked, "?": () => $("keys").showModal() };

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
  else if ("12345".includes(key)) openTab(TABS[Number(key) - 1]);
  else if (!cameraKey(event)) return;
  event.preventDefault();
});

// ---- Start --------------------------------------------------------------------------------------------------------

for (const button of document.querySelectorAll("[data-file]")) button.addEventListener("click", () => download(button.dataset.file));
for (const button of document.querySelectorAll("[data-copy]")) button.addEventListener("click", copyCommand);
for (const button of document.querySelectorAll("[data-fit]")) button.addEventListener("click", fit);
for (const button of document.querySelectorAll("[data-axis]"))
  button.addEventListener("click", event => lookAlong(Number(button.dataset.axis), (event.shiftKey ? -1 : 1) * Number(button.dataset.side)));
for (const button of document.querySelectorAll("[data-tab]")) button.addEventListener("click", () => openTab(button.dataset.tab));
$("help").addEventListener("click", () => $("keys").showModal());
$("film").addEventListener("click", makeFilm);
$("film-cancel").addEventListener("click", () => { isFilmCancelled = true; ask("film/cancel", {}); });
$("hide-panel").addEventListener("click", () => {
  const isHidden = document.body.classList.toggle("wide");
  $("hide-panel").setAttribute("aria-expanded", String(!isHidden));
});

on("page", () => {
  document.title = `${page.title} - orrery view`;
  $("file").textContent = page.title;
  makeSizes();
  makePanel();
  makeViews();
  $("film").textContent = page.saves ? "Make the film" : "Copy the command of the film";
  $("film-bar").hidden = !page.films;
  on("state", () => { $("film-kind").options[0].disabled = !(state.frames > 1); });
  if (page.saves) ask("film", undefined, true).then(film => film?.is_running && followFilm());
});
openTab("data");
start();
