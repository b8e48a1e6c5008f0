# SPDX-License-Identifier: Apache-2.0
"""Docstrings of C++ and Python as Markdown.

Both have sentences, indented examples, and rows of a name, two or more spaces, and a text that may go on in indented lines.
"""

import inspect
import re

ROW = re.compile(r"(\S+(?: \S+)*) {2,}(\S.*)")


def escaped(text):
    """Text in which only code in backticks is markup."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if part.startswith("`") else re.sub(r"([*_<\[\]|\\])", r"\\\1", part) for part in parts)


def _row(name, text):
    name = name if name.startswith("`") or name[0].isupper() else f"`{name}`"
    return f"| {name} | {escaped(text)} |"


def markdown(docstring):
    """Returns the Markdown of a docstring."""
    out = []
    lines = inspect.cleandoc(docstring or "").splitlines()
    kind = ""  # of the lines before: "text", "row", "code"
    for line in lines:
        if not line.strip():
            out.append("")
            kind = "code" if kind == "code" else ""
        elif kind == "row" and line.startswith("  "):
            out[-1] = out[-1][:-2] + " " + escaped(line.strip()) + " |"
        elif line.startswith("    ") and kind in ("", "code"):
            out.append(line)
            kind = "code"
        elif found := ROW.fullmatch(line):
            if kind != "row":
                out += ["", "| | |", "|---|---|"]
            out.append(_row(*found.groups()))
            kind = "row"
        else:
            if kind == "row":
                out.append("")
            out.append(escaped(line.strip()))
            kind = "text"
    return "\n".join(out).strip() + "\n"
