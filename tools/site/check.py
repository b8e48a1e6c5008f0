#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the links and images of a site, and that it loads nothing from other servers. Links to other sites are not followed.

    check.py SITE       exit status 1 if anything is wrong
"""

import html.parser
import os
import pathlib
import sys
import urllib.parse

LINKS = {"a": "href", "link": "href", "img": "src", "script": "src", "source": "src", "video": "src"}


class Page(html.parser.HTMLParser):
    """What a page links to, and the fragments that it has."""

    def __init__(self, text):
        super().__init__()
        self.links, self.fragments = [], {""}
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.fragments.update(attributes[key] for key in ("id", "name") if attributes.get(key))
        address = attributes.get(LINKS.get(tag))
        if address is not None:
            self.links.append((tag, address))


def fault(site, pages, page, tag, address):
    """Returns what is wrong with a link; empty: nothing."""
    parts = urllib.parse.urlsplit(address)
    if parts.scheme or parts.netloc:
        return "" if tag == "a" or parts.scheme == "data" else "loaded from another server"
    path = os.path.normpath(page.parent / urllib.parse.unquote(parts.path)) if parts.path else page
    target = site / path
    if target.is_dir():
        target = target / "index.html"
    if not target.is_file():
        return "no such file"
    if target.stat().st_size == 0:
        return "an empty file"
    fragment = urllib.parse.unquote(parts.fragment)
    known = pages.get(target.relative_to(site))
    if fragment and known and fragment not in known.fragments:
        return "no such heading"
    return ""


def main():
    site = pathlib.Path(sys.argv[1])
    files = [file for file in site.rglob("*.html") if file.name != "404.html"]  # whose addresses begin at the server's root
    pages = {file.relative_to(site): Page(file.read_text()) for file in files}
    faults = []
    for page, content in sorted(pages.items()):
        for tag, address in content.links:
            if what := fault(site, pages, page, tag, address):
                faults.append(f"{page}: {address}: {what}")
    for line in dict.fromkeys(faults):
        print(line)
    links = sum(len(content.links) for content in pages.values())
    images = sum(tag == "img" for content in pages.values() for tag, _ in content.links)
    print(f"{len(pages)} pages, {links} links, {images} images: {len(set(faults))} faults")
    sys.exit(1 if faults or not pages else 0)


main()
