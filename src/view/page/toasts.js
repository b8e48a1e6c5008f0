// SPDX-License-Identifier: Apache-2.0
// Messages over the picture. Errors stay until they are read, others leave by themselves.
import { $, element } from "./store.js";

const SHORT_ms = 4000;

// Shows a message once. `action`: [label, function]. Returns a function that removes it.
export function toast(text, { isError = false, action = null, key = text } = {}) {
  const box = $(isError ? "errors" : "notices");
  for (const old of box.children) if (old.dataset.key === key) old.remove();
  const close = element("button", { type: "button", className: "icon", textContent: "×", "aria-label": "Dismiss" });
  const out = element("div", { className: "toast" }, element("p", { textContent: text }));
  out.dataset.key = key;
  if (action) {
    const button = element("button", { type: "button", textContent: action[0] });
    button.addEventListener("click", action[1]);
    out.append(button);
  }
  out.append(close);
  close.addEventListener("click", () => out.remove());
  box.append(out);
  if (!isError) setTimeout(() => out.remove(), SHORT_ms);
  return () => out.remove();
}

export function dismiss(key) {
  for (const one of document.querySelectorAll(".toast")) if (one.dataset.key === key) one.remove();
}

export async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    toast(`Copied: ${what}`);
  } catch {  // not allowed, as in a frame
    const field = element("textarea", { value: text, "aria-label": what });
    document.body.append(field);
    field.select();
    const isCopied = document.execCommand("copy");
    field.remove();
    toast(isCopied ? `Copied: ${what}` : `Copying is not allowed here; select the command and press Ctrl+C.`);
  }
}
