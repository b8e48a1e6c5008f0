#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Time and memory of building orrery, from a new clone of HEAD and without a compiler cache.

    bench/build.py [program] [tests] [loop]

program  ./run.sh to the first output, and once more with nothing to build
tests    what ./test.sh compiles beyond a program with all instruction sets: tests, benchmarks, the Python package
loop     a developer's loop with the preset `dev`: one source is touched; a runnable program, then its tests

Without arguments, all three. Prints processor seconds, which other programs change little, wall seconds, and the memory of
the largest process. The clone is in $TMPDIR, and needs 3 GB.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

root = pathlib.Path(__file__).resolve().parent.parent
environment = {**os.environ, "CCACHE_DISABLE": "1"}

# A source, the test programs that compile or link it, and its tests.
loop_files = {
    "src/kernel/scatter-inl.h": (["unit_kernel", "statistical"], "KernelScatter|StatisticalBsdf"),
    "src/scene/schema.cpp": (["unit_scene"], "SceneSchema|SceneReference"),
    "src/data/lammps.cpp": (["unit_data"], "DataLammps"),
    "src/points/selection.cpp": (["unit_points"], "PointsSelection"),
}


def run(label, *command):
    """Runs a command in the clone and prints what it took."""
    begin = time.monotonic()
    with open(clone / "bench.log", "wb") as log:
        process = subprocess.Popen([str(word) for word in command], cwd=clone, env=environment, stdout=log, stderr=log)
        _, status, used = os.wait4(process.pid, 0)
    if status:
        sys.exit(f"{label}: failed\n" + (clone / "bench.log").read_text(errors="replace")[-3000:])
    cpu = used.ru_utime + used.ru_stime
    print(f"{label:44} {cpu:7.1f} s CPU {time.monotonic() - begin:7.1f} s wall {used.ru_maxrss / 1024:6.0f} MB", flush=True)


def program():
    run("./run.sh, the first time", "./run.sh", "--version")
    run("./run.sh, nothing to build", "./run.sh", "--version")


def tests():
    run("the program with all instruction sets", "./run.sh", "--install", clone / "installed")
    run("tests, benchmarks and Python beyond it", "./test.sh", "-N")


def loop():
    run("cmake --preset dev", "cmake", "--preset", "dev")
    targets = {target for programs, _ in loop_files.values() for target in programs}
    run("preset dev: program and four tests", "cmake", "--build", "--preset", "dev", "--target", "orrery", *targets)
    for file, (programs, names) in loop_files.items():
        os.utime(clone / file)
        run(f"{file}: program", "cmake", "--build", "--preset", "dev", "--target", "orrery")
        run(f"{file}: test programs", "cmake", "--build", "--preset", "dev", "--target", *programs)
        run(f"{file}: ctest", "ctest", "--preset", "dev", "--no-tests=error", "-j", os.cpu_count(), "-R", names)


parts = {"program": program, "tests": tests, "loop": loop}
chosen = sys.argv[1:] or list(parts)
if unknown := [word for word in chosen if word not in parts]:
    sys.exit(f"{unknown[0]}: write {', '.join(parts)}, or nothing for all")
with tempfile.TemporaryDirectory() as folder:
    clone = pathlib.Path(folder) / "orrery"
    subprocess.run(["git", "clone", "-q", root, clone], check=True)
    print(f"{os.cpu_count()} cores, other load {os.getloadavg()[0]:.1f}")
    for part in chosen:
        parts[part]()
