// SPDX-License-Identifier: Apache-2.0
// Conditions on columns as text, and the options that hold them: --select, and those of the form CONDITION: VALUE.
import { option, setStill, state } from "./store.js";

export const nameOf = column => /^[A-Za-z_][A-Za-z0-9_.]*(\[\d+\])*$/.test(column) ? column : `\`${column}\``;
export const isText = column => state?.data?.columns.find(([name]) => name === column)?.[1] === "text";
const quoted = text => text.includes('"') ? `'${text}'` : `"${text}"`;
export const literal = (column, value) => isText(column) ? quoted(value) : value;

// Strings have no escapes: one with both quotes cannot be written. Nor can a name with a backquote.
export const isWritable = (column, value) =>
  !column.includes("`") && !/[\n\r]/.test(column + value) && !(value.includes('"') && value.includes("'")) &&
  (isText(column) || Number.isFinite(Number(value)));

export const equals = (column, value) => `${nameOf(column)} == ${literal(column, value)}`;

// ---- Classes that are hidden or alone, in lines of --select -------------------------------------------------------

const escaped = text => text.replace(/[.*+?^${}()|[\]\\`]/g, "\\$&");
const valuesIn = text => (text.match(/"[^"]*"|'[^']*'|[^,\s]+/g) ?? []).map(one => one.replace(/^(["'])(.*)\1$/, "$2"));

// The line of --select that lists classes of a column: its index, whether it hides them, and their values.
function classLine(column) {
  const name = escaped(nameOf(column));
  const form = new RegExp(`^(?:${name} (==|!=) (.+)|${name} (in) \\[(.*)\\]|(!)\\(${name} in \\[(.*)\\]\\))$`);
  for (const [index, line] of option("--select").entries()) {
    const [sign, list] = (line.match(form) ?? []).slice(1).filter(part => part !== undefined);
    if (sign && !/ (&&|\|\||and|or) /.test(list)) return { index, hides: sign.startsWith("!"), values: valuesIn(list) };
  }
  return null;
}

export function isShown(column, value) {
  const line = classLine(column);
  return !line || line.values.includes(value) !== line.hides;
}

// Whether a class is the only one that is shown.
export function isAlone(column, value) {
  const line = classLine(column);
  return Boolean(line) && !line.hides && line.values.length === 1 && line.values[0] === value;
}

function setClasses(column, hides, values) {
  const lines = [...option("--select")], known = classLine(column), name = nameOf(column);
  const list = values.map(value => literal(column, value));
  const text = list.length === 1 ? `${name} ${hides ? "!=" : "=="} ${list[0]}`
    : hides ? `!(${name} in [${list.join(", ")}])` : `${name} in [${list.join(", ")}]`;
  if (known) lines.splice(known.index, 1);
  if (values.length > 0) lines.push(text);
  setStill({ "--select": lines });
}

export function setShown(column, value, isVisible) {
  const line = classLine(column) ?? { hides: true, values: [] };
  const others = line.values.filter(one => one !== value);
  const isListed = line.hides !== isVisible;
  if (!line.hides && !isListed && others.length === 0) return;  // the last one that is shown
  setClasses(column, line.hides, isListed ? [...others, value] : others);
}

export const setAlone = (column, value) =>
  isAlone(column, value) ? setClasses(column, true, []) : setClasses(column, false, [value]);

// ---- Rules: CONDITION: VALUE --------------------------------------------------------------------------------------

export const GHOST = "0.25";  // opacity of what is translucent

// The values of an option without a condition, and its rules. A colon within brackets or quotes is none of a rule.
const isRule = text => /:/.test(text.replace(/"[^"]*"|'[^']*'|`[^`]*`|\[[^\]]*\]/g, ""));
export const baseOf = name => [option(name)].flat().find(one => !isRule(one)) ?? "";
export const rulesOf = name => [option(name)].flat().filter(isRule);

export function withBase(name, value) {
  if (!Array.isArray(option(name))) return value;
  return [...(value === "" ? [] : [value]), ...rulesOf(name)];
}

export const ruleValue = (name, condition) =>
  rulesOf(name).find(rule => rule.startsWith(`${condition}: `))?.slice(condition.length + 2) ?? "";

// Sets the value under a condition; "": none.
export function setRule(name, condition, value) {
  const rest = option(name).filter(rule => !rule.startsWith(`${condition}: `));
  setStill({ [name]: value === "" ? rest : [...rest, `${condition}: ${value}`] });
}
