# SPDX-License-Identifier: Apache-2.0
"""The reference of the C++ library: the declarations and docstrings of the public headers, a page for each room.

It reads headers in the format of .clang-format, not C++.
"""

import re

from docstrings import markdown

# The headers that a program uses, in the order of its calls. src/CMakeLists.txt names most of them PUBLIC; the others
# are included by those.
HEADERS = """
scene/scene.h scene/number_array.h scene/texture.h scene/validate.h load/load_scene.h compile/compile.h
compile/compiled_scene.h render/render.h render/settings.h render/result.h film/picture.h film/sums.h denoise/denoise.h
display/develop.h display/settings.h image/write.h image/header.h image/format.h preview/preview.h
base/error.h
""".split()


def _check_complete(src):
    """Exits with an error if src/CMakeLists.txt has a public header that is not listed here."""
    for room, names in re.findall(r"orrery_room\((\w+)[^)]*?\bPUBLIC ([\w./ \n]+)", (src / "CMakeLists.txt").read_text()):
        for name in names.split():
            if f"{room}/{name}" not in HEADERS:
                raise SystemExit(f"tools/site/cpp_reference.py: the public header {room}/{name} is missing")


def _items(text, room):
    """Yields docstring and lines of the declarations in the room's namespace; the docstring of the namespace first."""
    before, _, body = text.partition(f"\nnamespace orrery::{room} {{")
    yield "\n".join(re.findall(r"^///? ?(.*)", before.partition("#pragma once")[2], re.M)), []
    doc, lines, depth = [], [], 0
    for line in body.split("\n")[1:]:
        if line.startswith("}  // namespace orrery"):
            return
        if not lines and line.startswith("///"):
            doc.append(line[4:])
        elif not lines and (not line.strip() or line.startswith(("//", "#"))):
            doc = []
        else:
            lines.append(line)
            code = line.split("//")[0].rstrip()
            depth += sum(code.count(c) for c in "({") - sum(code.count(c) for c in ")}")
            if depth == 0 and code.endswith((";", "}")):
                yield "\n".join(doc), lines
                doc, lines = [], []


NAME = re.compile(r"(?:struct|class|enum class|using)\s+(\w+)|(operator\S+|\w+)\(|(\w+)(?:\[\w*\])?\s*(?:=|\{|;)")


def _declaration(lines):
    """Returns name and text of a declaration: without private members, and without the body of a function."""
    text = "\n".join(lines)
    first = re.sub(r"\[\[\w+\]\] |template <.*?>\s", "", text)
    name = next(filter(None, NAME.search(first).groups()))
    if re.match(r"(struct|class)\b", first):
        text = re.sub(r"\n+ private:\n.*?\n\}", "\n}", text, flags=re.S)
    elif not re.match(r"(enum|using|inline constexpr|constexpr \w+ k)\b", first):
        text = re.sub(r"\s*(\) *(?:const|noexcept|\s)*)\{.*", r"\1", text, flags=re.S).rstrip(" ;") + ";"
    return name, text


def _header(src, header):
    out = [f"## `{header}`\n"]
    for doc, lines in _items((src / header).read_text(), header.split("/")[0]):
        if not lines:
            out.append(markdown(doc))
            continue
        if re.fullmatch(r"(struct|class|enum class) \w+( : [\w:]+)?;", lines[0]):
            continue  # declared here, defined elsewhere
        name, text = _declaration(lines)
        title = f"### `{name}`\n"
        if title in out:  # an overload
            title = ""
        out += [title, f"```cpp\n{text}\n```\n", markdown(doc)]
    return out


def pages(src):
    """Returns the Markdown of the pages by file name: README.md and one a room."""
    _check_complete(src)
    out = {}
    index = [
        "# C++ reference\n",
        "The public headers of the C++ library; [examples/cpp](../../examples/cpp/README.md) is a program to start from.\n",
        "A CMake project finds the library by `find_package(orrery)`; `ROOM/NAME.h` belongs to the target `orrery::ROOM`.\n",
        "| header | declares |\n|---|---|",
    ]
    for room in dict.fromkeys(header.split("/")[0] for header in HEADERS):
        text = [f"# orrery::{room}\n", f"The public headers of the target and namespace `orrery::{room}`.\n"]
        for header in filter(lambda header: header.startswith(room + "/"), HEADERS):
            section = _header(src, header)
            names = [line[4:].strip() for line in section if line.startswith("### ")]
            text += section
            index.append(f"| [`{header}`]({room}.md#{re.sub(r'[^a-z_]', '', header)}) | {', '.join(names)} |")
        out[f"{room}.md"] = "\n".join(text)
    out["README.md"] = "\n".join(index) + "\n"
    return out
