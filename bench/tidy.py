#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Converts a Google Benchmark result to the form that is checked in, on standard output.

    tidy.py RESULT.json >TIDY.json

Writes one repetition per line, so that diffs are readable. Omits aggregates, which compare.py computes from the
repetitions, and the host name, which is private. The output is still a valid Google Benchmark result.
"""

import json
import sys

KEPT_CONTEXT = ("date", "processor", "num_cpus", "mhz_per_cpu", "cpu_scaling_enabled", "load_avg", "instruction_set",
                "compiler", "build", "library_build_type", "embree", "revision")
DROPPED = {"family_index", "per_family_instance_index", "run_name", "repetitions", "threads"}


def rounded(value):
    """Six significant digits exceed the resolution of the clocks."""
    return float(f"{value:.6g}") if isinstance(value, float) else value


def tidy(result):
    context = {key: result["context"][key] for key in KEPT_CONTEXT if key in result["context"]}
    runs = [run for run in result["benchmarks"] if run.get("run_type") == "iteration"]
    runs.sort(key=lambda run: (run["name"], run.get("repetition_index", 0)))
    kept = [{key: rounded(value) for key, value in run.items() if key not in DROPPED} for run in runs]
    lines = ",\n".join("  " + json.dumps(run) for run in kept)
    return f'{{"context": {json.dumps(context, indent=2)},\n"benchmarks": [\n{lines}\n]}}\n'


if __name__ == "__main__":
    try:
        with open(sys.argv[1], encoding="utf-8") as file:
            sys.stdout.write(tidy(json.load(file)))
    except IndexError:
        sys.exit("tidy.py: error: no result given; usage: tidy.py RESULT.json")
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"tidy.py: error: {sys.argv[1]}: {error}")
