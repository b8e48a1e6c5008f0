#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Processor time and page faults of starting `orrery`, medians of alternating runs.

    bench/start.py build/src/orrery [RUNS]

`info` loads no module. The smallest render writes an EXR, so that it loads OpenImageIO: as installed, without the stub
libraries, and without huge pages.
"""
import os
import pathlib
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

orrery = pathlib.Path(sys.argv[1]).resolve()
runs = int(sys.argv[2]) if len(sys.argv) > 2 else 15


def cost(command, **environment):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env={**os.environ, **environment})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, after.ru_minflt - before.ru_minflt


with tempfile.TemporaryDirectory() as work:
    work = pathlib.Path(work)
    scene = work / "one.toml"
    scene.write_text('[image]\nwidth = 16\nheight = 9\n[material.m]\ntype = "lambertian"\nalbedo = [0.5, 0.5, 0.5]\n'
                     '[[sphere]]\ncenter = [0, 0, -1]\nradius = 0.5\nmaterial = "m"\n')
    copied = work / "copied"
    (copied / "bin").mkdir(parents=True)
    shutil.copy2(orrery, copied / "bin")
    shutil.copytree(orrery.parent / "../libexec/orrery", copied / "libexec/orrery", ignore=shutil.ignore_patterns("*stubs*"))
    render = ["render", scene, "-o", work / "one.exr", "-q", "--samples", "1"]
    cases = {
        "info": lambda: cost([orrery, "info", scene]),
        "smallest render": lambda: cost([orrery, *render]),
        "  without stub libraries": lambda: cost([copied / "bin/orrery", *render]),
        "  without huge pages": lambda: cost([orrery, *render], GLIBC_TUNABLES="glibc.malloc.hugetlb=0"),
    }
    measured = {name: [] for name in cases}
    for _ in range(runs):
        for name, measure in cases.items():
            measured[name].append(measure())
    for name, values in measured.items():
        seconds, faults = (statistics.median(column) for column in zip(*values))
        print(f"{name:28} {seconds:6.3f} s {faults:8.0f} page faults")
