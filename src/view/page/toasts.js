// SPDX-License-Identifier: Apache-2.0
// Messages over the picture. Errors stay until they are read, others leave by themselves.
import { $, element } from "./store.js";

const SHORT_ms = 4000;

export function dismiss(key) {
  for (const one of document.querySelectorAll(".toast")) if (one.dataset.key === key) one.remove();
}

// Shows a message once. `action`: [label, function].
export function toast(text, { isError = false, action = null, key = text } = {}) {
  const box = $(isError ? "errors" : "notices");
  dismiss(key);
  const out = element("div", { className: "toast" }, element("p", { textContent: text }));
  out.dataset.key = key;
  if (action) out.append(element("button", { type: "button", textContent: action[0], onclick: action[1] }));
  out.append(element("button", { type: "button", className: "icon", textContent: "×", "aria-label": "Dismiss", onclick: () => out.remove() }));
  box.append(out);
  if (!isError) setTimeout(() => out.remove(), SHORT_ms);
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
