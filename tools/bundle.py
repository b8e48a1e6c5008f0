#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Bundles a build with the libraries that it needs: an archive that runs on any Linux, or a wheel of the Python package.

    bundle.py archive BUILD FILE.tar.xz [PRESET]    tools/portable.sh; PRESET is that of xz, 0 to 9
    bundle.py wheel BUILD FOLDER                    tools/wheel.sh; prints the file

The build has the targets orrery, orrery_static and, for the wheel, orrery_python, and stub libraries. Libraries come from
Debian packages, whose licences are bundled. SOURCE_DATE_EPOCH is the time of all files, so that two builds of a commit
give the same bytes. Needs patchelf. Exit status: 77 where a tool is missing.
"""

import base64
import hashlib
import json
import lzma
import os
import pathlib
import re
import shutil
import stat
import subprocess
import sys
import tarfile
import tempfile
import time
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
EPOCH = int(os.environ["SOURCE_DATE_EPOCH"])
LIBEXEC = "libexec/orrery"
LOADER = "/lib64/ld-linux-x86-64.so.2"
FONT = pathlib.Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")
# What a wheel may expect of the system: the libraries of every manylinux tag that orrery uses.
SYSTEM = re.compile(r"(ld-linux-x86-64|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+))\.so\.\d+")


def output(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def patchelf(*words):
    output("patchelf", *words)


def needed(file):
    return re.findall(r"NEEDED +(\S+)", output("objdump", "-p", file))


def install(build, prefix, *components):
    for component in components:
        output("cmake", "--install", build, "--prefix", prefix, "--component", component, "--strip")


def binaries(prefix):
    """The program and its modules."""
    return [prefix / LIBEXEC / "orrery-program", *sorted(prefix.glob(f"{LIBEXEC}/*.so"))]


def stubs(prefix):
    return {stub.name: stub for stub in sorted(prefix.glob(f"{LIBEXEC}/*-stubs/*"))}


def libraries(files, stubs):
    """The libraries that files load, by soname, except those for which there are stubs."""
    folders = ":".join(sorted({str(stub.parent) for stub in stubs.values()}))
    found = {}
    for line in output("ldd", *files, env={"LD_LIBRARY_PATH": folders, "PATH": os.environ["PATH"]}).splitlines():
        if line.rstrip().endswith("not found"):
            sys.exit(f"bundle.py: {line.strip()}")
        match = re.match(r"\s*(\S+) => (/\S+)", line)
        if match and match[1] not in stubs:
            found[match[1]] = pathlib.Path(match[2])
    return dict(sorted(found.items()))


def names_of(file):
    """The names of a file that dpkg may know: it has the files of /lib below /usr/lib, or the other way round."""
    return {str(file), str(file.resolve()), str(file).replace("/usr/lib/", "/lib/", 1), str(file).replace("/lib", "/usr/lib", 1)}


def packages_of(files):
    """The Debian packages of files: name -> version, source, its version."""
    names = {name for file in files for name in names_of(file)}
    search = subprocess.run(["dpkg-query", "-S", *names], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    rows = [line.split(": ", 1) for line in search.stdout.splitlines() if not line.startswith("diversion by ")]
    owner_of = {name: owner for owner, name in rows}
    for file in files:
        if not names_of(file) & set(owner_of):
            sys.exit(f"bundle.py: no Debian package has {file}")
    form = "${Package}\t${Version}\t${source:Package}\t${source:Version}\n"
    rows = output("dpkg-query", "-W", "-f", form, *set(owner_of.values())).splitlines()
    return dict(sorted((row.split("\t")[0], row.split("\t")[1:]) for row in rows))


def add_licences(packages, documents):
    """The licences of packages, and where their sources are."""
    folder = documents / "licenses"
    folder.mkdir(parents=True)
    for package in packages:
        shutil.copy(f"/usr/share/doc/{package}/copyright", folder / package)
    shutil.copytree("/usr/share/common-licenses", folder / "common-licenses")
    system = re.search(r'PRETTY_NAME="(.*)"', pathlib.Path("/etc/os-release").read_text())[1]
    text = f"Libraries of {system}, which are not changed except for their names and search\n" \
           "paths. The licence of each is in the file of its name; common-licenses has the texts that several refer to. The\n" \
           "sources are the source packages of these versions, at https://snapshot.debian.org/package/SOURCE/VERSION/.\n\n"
    rows = [f"{name} {version}: source package {source} {source_version}\n"
            for name, (version, source, source_version) in packages.items()]
    (folder / "README").write_text(text + "".join(rows))


def complete_sbom(packages, file):
    """Adds the packages whose libraries are bundled and that the SBOM of the build does not list."""
    sbom = json.loads(file.read_text())
    listed = {name for package in sbom["packages"] for reference in package.get("externalRefs", [])
              for name in re.findall(r"pkg:deb/\w+/([^@]+)@", reference["referenceLocator"])}
    distribution = re.search(r"^ID=(\w+)", pathlib.Path("/etc/os-release").read_text(), re.M)[1]
    for name, (version, _, _) in packages.items():
        escaped = name.replace("+", "%2B")
        if escaped in listed:
            continue
        identifier = "SPDXRef-deb-" + re.sub("[^A-Za-z0-9.-]", "x", name)
        locator = f"pkg:deb/{distribution}/{escaped}@{version.replace('+', '%2B')}"
        sbom["packages"].append({
            "SPDXID": identifier, "name": name, "versionInfo": version, "downloadLocation": "NOASSERTION",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": locator}],
            "licenseDeclared": "NOASSERTION", "licenseConcluded": "NOASSERTION", "copyrightText": "NOASSERTION",
            "filesAnalyzed": False, "primaryPackagePurpose": "LIBRARY"})  # fmt: skip
        sbom["relationships"].append({"spdxElementId": "SPDXRef-orrery", "relationshipType": "CONTAINS",
                                      "relatedSpdxElement": identifier})
    file.write_text(json.dumps(sbom, indent=2) + "\n")


def add_shared(prefix, files):
    """Font, licences and SBOM."""
    fonts = prefix / "share/orrery/fonts"
    fonts.mkdir(parents=True)
    shutil.copy(FONT, fonts)
    packages = packages_of([*files, FONT])
    documents = prefix / "share/doc/orrery"
    add_licences(packages, documents)
    complete_sbom(packages, documents / "orrery.spdx.json")


def make_archive(build, archive, work, preset="6"):
    tree = work / archive.name.removesuffix(".tar.xz")
    install(build, tree, "runtime")
    shutil.copy(build / "src/orrery-static", tree / "bin/orrery")
    output("strip", tree / "bin/orrery")
    found = libraries(binaries(tree), stubs(tree))
    (tree / "lib").mkdir()
    for name, file in found.items():
        copy = tree / "lib" / name
        shutil.copy(file, copy)
        patchelf("--remove-rpath", copy)  # the search would begin there, outside the archive
    # Of all ways to name the folder, only this one precedes LD_LIBRARY_PATH and permits any character in a path.
    patchelf("--force-rpath", "--set-rpath", "$ORIGIN/../../lib", tree / LIBEXEC / "orrery-program")
    shutil.copy(LOADER, tree / LIBEXEC / "orrery-loader")
    add_shared(tree, [*found.values(), pathlib.Path(LOADER)])
    for name in output("git", "-C", ROOT, "ls-files", "examples").splitlines():
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tree / name)
    (tree / "scenes").symlink_to("share/doc/orrery/scenes")
    for file in sorted((ROOT / "tools/portable").iterdir()):
        shutil.copy(file, tree)

    def entry(info):
        info.uid = info.gid = 0
        info.uname = info.gname = ""
        info.mtime = EPOCH
        info.mode = 0o755 if info.mode & stat.S_IXUSR else 0o644
        return info

    # The command is last: without it, an archive that was not unpacked completely cannot be started.
    command = tree / "bin/orrery"
    names = [tree, *sorted(path for path in tree.rglob("*") if path != command), command]
    filters = [{"id": lzma.FILTER_X86}, {"id": lzma.FILTER_LZMA2, "preset": int(preset)}]
    with lzma.open(archive, "wb", filters=filters) as packed, tarfile.open(fileobj=packed, mode="w", format=tarfile.GNU_FORMAT) as tar:
        for path in names:
            tar.add(path, path.relative_to(work), recursive=False, filter=entry)


def graft(package, files, stub_of):
    """Copies libraries into the package under names of their own, so that other packages with the same libraries keep theirs."""
    found = {name: file for name, file in libraries(files, stub_of).items() if not SYSTEM.fullmatch(name)}
    folder = package / "lib"
    folder.mkdir()
    new_name = {}
    for name, file in {**found, **stub_of}.items():
        stem, _, rest = name.partition(".so")
        new_name[name] = f"{stem}-{hashlib.sha256(file.read_bytes()).hexdigest()[:8]}.so{rest}"
        shutil.copy(file, folder / new_name[name])
        patchelf("--set-soname", new_name[name], folder / new_name[name])
    for file in [*files, *folder.iterdir()]:
        renamed = [word for name in needed(file) if name in new_name for word in ("--replace-needed", name, new_name[name])]
        origin = "$ORIGIN/" + os.path.relpath(folder, file.parent)
        patchelf(*renamed, file)
        patchelf("--force-rpath", "--set-rpath", origin, file)  # patchelf 0.14 mixes up both in one call
    return found


def oldest_glibc(files):
    """The version of glibc that files need, and with it, as a manylinux tag, all that they expect of the system. Exits if
    they need another library than SYSTEM, or a later libstdc++ than such systems have: GCC 12 in Debian 12, 14 in 13."""
    minors = {"GLIBC_2": {0}, "GLIBCXX_3.4": {0}}
    names = {file.name for file in files}
    for file in files:
        for name in needed(file):
            if name not in names and not SYSTEM.fullmatch(name):
                sys.exit(f"bundle.py: {file.name} needs {name}, which is not in the wheel")
        for version, minor in re.findall(r"\b(GLIBC_2|GLIBCXX_3\.4)\.(\d+)", output("objdump", "-p", file)):
            minors[version].add(int(minor))
    glibc = max(minors["GLIBC_2"])
    if max(minors["GLIBCXX_3.4"]) > (30 if glibc <= 36 else 33):
        sys.exit(f"bundle.py: the wheel needs a later libstdc++ than systems with glibc 2.{glibc} have")
    return glibc


def metadata(build):
    """The metadata of pyproject.toml, for the Python of the build."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    version = re.search(r"^project\(orrery VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]
    python = re.search(r"_orrery\.cpython-3(\d+)-", next(build.glob("lib/python3/dist-packages/orrery/_orrery.*")).name)[1]
    lines = [
        "Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {version}", f"Summary: {project['description']}",
        f"License: {project['license']['text']}", *(f"Author: {author['name']}" for author in project["authors"]),
        f"Keywords: {','.join(project['keywords'])}",
        *(f"Project-URL: {name}, {url}" for name, url in project.get("urls", {}).items()),
        *(f"Classifier: {name}" for name in project["classifiers"]), f"Requires-Python: ==3.{python}.*",
        *(f"Requires-Dist: {name}" for name in project["dependencies"]), "Description-Content-Type: text/markdown",
    ]  # fmt: skip
    return version, f"cp3{python}", "\n".join(lines) + "\n\n" + (ROOT / project["readme"]).read_text()


def make_wheel(build, folder, work):
    version, python, text = metadata(build)
    tree = work / "tree"
    package = tree / "orrery"
    install(build, package, "runtime")
    shutil.copytree(build / "lib/python3/dist-packages/orrery", package, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    extension = next(package.glob("_orrery.*.so"))
    output("strip", "--strip-unneeded", extension)
    stub_of = stubs(package)
    files = [*binaries(package), extension]
    found = graft(package, files, stub_of)
    for name in {stub.parent for stub in stub_of.values()}:
        shutil.rmtree(name)
    add_shared(package, found.values())
    tag = f"{python}-{python}-manylinux_2_{oldest_glibc([*files, package / 'bin/orrery', *(package / 'lib').iterdir()])}_x86_64"

    info = f"orrery-{version}.dist-info"
    (tree / info).mkdir()
    (tree / info / "METADATA").write_text(text)
    (tree / info / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: orrery\nRoot-Is-Purelib: false\nTag: {tag}\n")
    (tree / info / "entry_points.txt").write_text("[console_scripts]\norrery = orrery._command:run\n")
    wheel = folder / f"orrery-{version}-{tag}.whl"
    record = ""
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as packed:

        def add(name, content, mode):
            entry = zipfile.ZipInfo(name, time.gmtime(max(EPOCH, 315532800))[:6])  # since 1980
            entry.external_attr = (stat.S_IFREG | mode) << 16
            packed.writestr(entry, content, zipfile.ZIP_DEFLATED)

        for path in sorted(path for path in tree.rglob("*") if path.is_file()):
            name, content = str(path.relative_to(tree)), path.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record += f"{name},sha256={digest},{len(content)}\n"
            add(name, content, 0o755 if path.stat().st_mode & stat.S_IXUSR else 0o644)
        add(f"{info}/RECORD", record + f"{info}/RECORD,,\n", 0o644)
    print(wheel)


def main():
    missing = [name for name in ("patchelf", "dpkg-query", "objdump") if shutil.which(name) is None]
    if missing or not pathlib.Path(LOADER).exists():
        print(f"skipped: {' '.join(missing) or LOADER} not found")
        sys.exit(77)
    kind, build, target = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve()
    os.environ["LC_ALL"] = "C.UTF-8"
    (target.parent if kind == "archive" else target).mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        {"archive": make_archive, "wheel": make_wheel}[kind](build, target, pathlib.Path(work), *sys.argv[4:])


main()
