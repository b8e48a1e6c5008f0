#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the pages of the site: those of the repository, the references, and the navigation.

    pages.py FOLDER     the folder gets pages/ and mkdocs.yml
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import cpp_reference
import python_reference

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
LINK = re.compile(r"\[([^]]*)\]\(([^)#\s:]+)(#[^)]*)?\)")


def tracked(pattern):
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", pattern], cwd=ROOT, check=True, capture_output=True, text=True)
    return [pathlib.PurePath(line) for line in listed.stdout.splitlines() if not line.startswith(".")]


def title(page):
    """Returns the first heading of a page."""
    return (ROOT / page).read_text().partition("\n")[0].lstrip("# ")


def copy_page(page, folder):
    """Copies a page and the files that it links to.

    A link to a folder becomes one to its README.md; one whose text is the name of a page shows the title of that page.
    """

    def link(found):
        text, target, fragment = found.groups(default="")
        file = os.path.normpath(page.parent / target)
        if (ROOT / file / "README.md").is_file():
            return f"[{text}]({target.rstrip('/')}/README.md{fragment})"
        if text in (target, file) and text.endswith(".md") and (ROOT / file).is_file():
            return f"[{title(file)}]({target}{fragment})"
        if (ROOT / file).is_file():
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / file, folder / file)
        return found[0]

    text = LINK.sub(link, (ROOT / page).read_text())
    (folder / page).parent.mkdir(parents=True, exist_ok=True)
    (folder / page).write_text(text)


def navigation(pages, cpp_pages):
    """Returns the navigation as YAML: the sections of docs/README.md, the examples and the references."""
    sections = {"Home": ["README.md", "docs/README.md"]}
    section = ""
    for line in (ROOT / "docs/README.md").read_text().splitlines():
        if line.startswith("## "):
            section = line[3:]
        elif found := re.match(r"(?:\* |\| )\[[^]]*\]\(([^)]*\.md)\)", line):
            sections.setdefault(section, []).append(os.path.normpath("docs/" + found[1]))
    examples = sorted(str(page) for page in pages if page.match("examples/*/README.md"))
    out = {}
    for section, names in sections.items():
        out[section] = [name for name in names if name != "examples/README.md"]
        if section == "Home":
            out["Home"] += [name for name in ("CHANGELOG.md", "SECURITY.md") if (ROOT / name).is_file()]
            out["Examples"] = ["examples/README.md", *examples]
        elif "docs/python.md" in names:
            out["Reference"] = ["docs/scene-format.md", "docs/python-reference.md", *(f"docs/cpp/{name}" for name in cpp_pages)]
            out[section].remove("docs/scene-format.md")
    return "nav:\n" + "".join(f"  - {section}:\n" + "".join(f"    - {name}\n" for name in names) for section, names in out.items())


def main():
    folder = pathlib.Path(sys.argv[1])
    pages = tracked("*.md")
    for page in pages:
        copy_page(page, folder / "pages")
    docs = folder / "pages/docs"
    (docs / "python-reference.md").write_text(python_reference.page(ROOT / "src/python/orrery"))
    cpp_pages = cpp_reference.pages(ROOT / "src")
    (docs / "cpp").mkdir()
    for name, text in cpp_pages.items():
        (docs / "cpp" / name).write_text(text)
    for name in ("site.css", "favicon.svg"):
        shutil.copy(HERE / name, docs / name)
    order = ["README.md", *(name for name in cpp_pages if name != "README.md")]
    (folder / "mkdocs.yml").write_text((HERE / "mkdocs.yml").read_text() + navigation(pages, order))


main()
