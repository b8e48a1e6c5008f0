// SPDX-License-Identifier: Apache-2.0
// The objects of a scene, by name, from the text of the scene: each key is a setting.
import { $, command, element, on, onUpdate, option, own, set, state } from "./store.js";

// The keys of an inline table.
const keysOf = text => [...text.matchAll(/([\w.-]+) = (\[.*?\]|\{.*?\}|"[^"]*"|[^,}]+)/g)].map(([, key, value]) => [key, value.trim()]);

// The tables of a scene file as orrery writes it: [name of the table, [[key, value]]]. Numbers count [[tables]].
function tablesOf(text) {
  const out = [], counts = {};
  for (const line of text.split("\n")) {
    const many = line.match(/^\[\[(.+)\]\]$/), one = line.match(/^\[([^[].*)\]$/), key = line.match(/^([\w.-]+) = (.+)$/);
    if (many) out.push([`${many[1]}[${counts[many[1]] = (counts[many[1]] ?? -1) + 1}]`, []]);
    else if (one) out.push([one[1], []]);
    else if (key && out.at(-1)?.[0] === "material") out.splice(-1, 0, [`material.${key[1]}`, keysOf(key[2].slice(1, -1))]);
    else if (key && out.length > 0) out.at(-1)[1].push([key[1], key[2]]);
  }
  return out;
}

const settingOf = key => option("--set").find(line => line.startsWith(`${key}=`))?.slice(key.length + 1);

function field(key, value) {
  const change = event => {
    const others = option("--set").filter(line => !line.startsWith(`${key}=`)), typed = event.target.value.trim();
    set({ "--set": typed === "" || typed === value ? others : [...others, `${key}=${typed}`] });
  };
  const input = element("input", { type: "text", spellcheck: false, "aria-label": key, title: `--set ${key}=...`, onchange: change });
  onUpdate(() => { if (document.activeElement !== input) input.value = settingOf(key) ?? value; });
  return input;
}

function object([name, keys]) {
  const textOf = sought => keys.find(([key]) => key === sought)?.[1].replaceAll('"', "");
  const out = element("details", { className: "object" }, element("summary", { textContent: [textOf("name") ?? name, textOf("material")].filter(Boolean).join(" · ") }));
  out.dataset.name = name;
  out.ontoggle = () => {  // a scene may have many
    if (out.open && out.childElementCount === 1)
      out.append(...keys.map(([key, value]) => element("label", { className: "row" }, element("span", { textContent: key }), field(`${name}.${key}`, value))));
  };
  return out;
}

const GROUPS = [["Materials", /^material\./], ["Light and background", /^(background|light)/], ["Camera and image", /^(camera|image|color|render|annotation|animation)/],
                ["Layers", /^output/], ["Data", /^(points|rods)/], ["Spheres", /^sphere/], ["Rods", /^rod\[/]];

let isListed = false;
async function listObjects() {
  if (isListed || !state?.camera || command("--color-by")) return;
  isListed = true;
  const answer = await own("scene.toml?brief");
  if (!answer?.ok) return;
  const tables = tablesOf(await answer.text());
  for (const [title, form] of GROUPS) {
    const found = tables.filter(([name]) => form.test(name));
    if (found.length > 0) $("objects").append(element("h3", { textContent: title }), ...found.map(object));
  }
}
on("state", listObjects);

// Opens a picked object, such as "sphere[3]", and its material.
export function showObject(picked) {
  const material = picked.values.find(([key]) => key === "material")?.[1];
  for (const details of document.querySelectorAll(".object"))
    if (details.dataset.name === picked.title || details.dataset.name === `material.${material}`) {
      details.open = true;
      details.scrollIntoView({ block: "nearest" });
    }
}
