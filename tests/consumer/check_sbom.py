#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks an installed orrery.spdx.json.

    check_sbom.py PREFIX

The document must have what SPDX 2.3 requires of it, and list every library that the installed binaries load. Libraries
are compared by the source of their Debian packages; without dpkg that comparison is skipped.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys

prefix = pathlib.Path(sys.argv[1])
sbom = json.loads((prefix / "share/doc/orrery/orrery.spdx.json").read_text(encoding="utf-8"))
packages = {package["SPDXID"]: package for package in sbom["packages"]}


def output(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def check_form() -> None:
    """Clauses 6, 7 and 11 of the specification: required fields, identifiers, dates, and ends of relationships."""
    assert sbom["spdxVersion"] == "SPDX-2.3" and sbom["dataLicense"] == "CC0-1.0" and sbom["SPDXID"] == "SPDXRef-DOCUMENT"
    assert re.fullmatch(r"https://[^#\s]+-[0-9a-f-]{36}", sbom["documentNamespace"]), sbom["documentNamespace"]
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", sbom["creationInfo"]["created"])
    for creator in sbom["creationInfo"]["creators"]:
        assert re.match(r"(Person|Organization|Tool): \S", creator), creator
    assert len(packages) == len(sbom["packages"]), "an SPDXID occurs twice"
    for identifier, package in packages.items():
        assert re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", identifier), identifier
        for key in ("name", "downloadLocation", "licenseDeclared", "licenseConcluded", "copyrightText"):
            assert package[key], (identifier, key)
        assert package["filesAnalyzed"] is False, identifier
    known = {"SPDXRef-DOCUMENT", *packages}
    types = {"DESCRIBES", "DYNAMIC_LINK", "STATIC_LINK"}
    for relationship in sbom["relationships"]:
        assert {relationship["spdxElementId"], relationship["relatedSpdxElement"]} <= known, relationship
        assert relationship["relationshipType"] in types, relationship
    related = {relationship["relatedSpdxElement"] for relationship in sbom["relationships"]}
    version = output(str(prefix / "bin/orrery"), "--version").split()[1]
    assert packages["SPDXRef-orrery"]["versionInfo"] == version
    assert related == set(packages), f"without relationship: {set(packages) - related}"


def loaded_files() -> set[str]:
    """The shared libraries that the installed binaries name."""
    found = set()
    for binary in [prefix / "bin/orrery", prefix / "libexec/orrery/orrery-program", *prefix.glob("libexec/orrery/*.so"), *prefix.glob("lib/python3*/dist-packages/orrery/*.so")]:
        names = set(re.findall(r"NEEDED +(\S+)", output("objdump", "-p", str(binary))))
        for line in output("ldd", str(binary)).splitlines():
            match = re.match(r"\s*(\S+) => (/\S+)", line)
            if match and match[1] in names:
                found.add(match[2])
    assert any("libembree" in file for file in found), found
    return found


def check_libraries() -> None:
    def sources(*names: str) -> set[str]:
        # Packages that are needed only for the build may be missing here.
        query = subprocess.run(["dpkg-query", "-W", "-f", "${source:Package}\n", *names], capture_output=True, text=True)
        return set(query.stdout.split())

    # dpkg knows the files of /lib below /usr/lib or the other way round.
    file_of = {}
    for file in loaded_files():
        for name in (file, str(pathlib.Path(file).resolve()), file.replace("/lib/", "/usr/lib/", 1)):
            file_of[name] = file
    search = subprocess.run(["dpkg-query", "-S", *file_of], capture_output=True, text=True)
    owner_of = {file_of[name]: owner for owner, name in (line.split(": ", 1) for line in search.stdout.splitlines())
                if name in file_of}  # not diversions
    ownerless = set(file_of.values()) - set(owner_of)
    assert not ownerless, f"no package owns {ownerless}"
    owners = set(owner_of.values())
    listed: dict[str, set[str]] = {"DYNAMIC_LINK": set(), "STATIC_LINK": set()}
    for relationship in sbom["relationships"][1:]:
        for reference in packages[relationship["relatedSpdxElement"]]["externalRefs"]:
            name = re.fullmatch(r"pkg:deb/[a-z]+/([^@]+)@\S+", reference["referenceLocator"])[1]
            listed[relationship["relationshipType"]].add(name.replace("%2B", "+"))
    loaded, dynamic = sources(*owners), sources(*listed["DYNAMIC_LINK"])
    assert loaded <= dynamic, f"loaded, but not listed as DYNAMIC_LINK: {loaded - dynamic}"
    assert dynamic <= loaded, f"listed as DYNAMIC_LINK, but not loaded: {dynamic - loaded}"
    assert listed["STATIC_LINK"]


check_form()
if shutil.which("dpkg-query"):
    check_libraries()
