#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Turns benchmark results (Google Benchmark's JSON, with repetitions) into a table of ratios with their spread.

    compare.py OLD.json NEW.json              NEW against OLD, case by case
    compare.py RESULT.json --to CASE          every case against one case of the same run
    compare.py RESULT.json                    rates alone

A rate is items per second: rays, tests, paths or spheres, as the case says. Each is the median of its repetitions;
its spread is half the distance of the quartiles. A ratio's spread puts the quartiles of both against each other: if its
interval holds 1, the two can't be told apart.

Exit status: 0; with --fail-below LIMIT it is 1 where a whole interval lies below LIMIT; 2 where input makes no sense.
"""

import argparse
import json
import re
import statistics
import sys


class BadInput(Exception):
    """What is wrong with a file, and where."""


def read_rates(path):
    """Rates of all repetitions by case, cases in the order of their names."""
    try:
        with open(path, encoding="utf-8") as file:
            runs = list(json.load(file)["benchmarks"])
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    except (ValueError, KeyError, TypeError) as error:
        raise BadInput(f"{path}: not a result of Google Benchmark (--benchmark_out_format=json)") from error
    rates = {}
    for run in runs:
        if run.get("error_occurred"):
            raise BadInput(f"{path}: {run['name']}: {run.get('error_message', 'failed')}")
        if run.get("run_type") == "iteration" and "items_per_second" in run:
            rates.setdefault(run["name"], []).append(run["items_per_second"])
    if not rates:
        raise BadInput(f"{path}: holds no repetitions; was it run with --benchmark_report_aggregates_only?")
    return dict(sorted(rates.items(), key=lambda item: natural(item[0])))


def natural(name):
    """Sorts 10 before 9000, part by part."""
    return [(part.isdigit(), int(part) if part.isdigit() else 0, part) for part in name.split("/")]


def quartiles(values):
    """First quartile, median, third; of a few values the outermost ones stand for the quartiles."""
    if len(values) < 4:
        return min(values), statistics.median(values), max(values)
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
    return low, middle, high


def ratio(new, old):
    """Median ratio and its interval."""
    new_low, new_middle, new_high = quartiles(new)
    old_low, old_middle, old_high = quartiles(old)
    return new_middle / old_middle, new_low / old_high, new_high / old_low


def in_units(rate):
    for limit, unit in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if rate >= limit:
            return f"{rate / limit:.3g} {unit}"
    return f"{rate:.3g}"


def rate_cell(values):
    low, middle, high = quartiles(values)
    return f"{in_units(middle)}/s ±{100 * (high - low) / 2 / middle:.0f} %"


def print_table(header, rows):
    widths = [max(len(row[i]) for row in [header, *rows]) for i in range(len(header))]
    for row in [header, ["-" * width for width in widths], *rows]:
        print("| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |")


def compare(pairs, old_name, new_name):
    """Prints the table of (case, old rates, new rates); gives the upper ends of the ratios' intervals."""
    rows, uppers = [], []
    for case, old, new in pairs:
        middle, low, high = ratio(new, old)
        uppers.append(high)
        rows.append([case, rate_cell(old), rate_cell(new), f"{middle:.3g}", f"{low:.3g} .. {high:.3g}"])
    print_table(["case", old_name, new_name, "ratio", "interval"], rows)
    return uppers


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("result", nargs="+", metavar="RESULT.json", help="one result, or the old and the new one")
    parser.add_argument("--to", metavar="CASE", help="with one result: the case that all others are set against")
    parser.add_argument("--filter", metavar="REGEX", default="", help="only cases whose name this is found in")
    parser.add_argument("--fail-below", metavar="LIMIT", type=float, help="exit with 1 where a ratio is surely below")
    options = parser.parse_args(arguments)
    if len(options.result) > 2 or (len(options.result) == 2 and options.to):
        parser.error("give two results, or one with --to")
    if options.fail_below is not None and len(options.result) == 1 and not options.to:
        parser.error("--fail-below needs ratios: a second result, or --to")
    try:
        wanted = re.compile(options.filter)
    except re.error as error:
        parser.error(f"--filter {options.filter}: {error}")

    first = read_rates(options.result[0])
    cases = [case for case in first if wanted.search(case)]
    uppers = []
    if len(options.result) == 2:
        second = read_rates(options.result[1])
        both = [case for case in cases if case in second]
        if not both:
            raise BadInput("the two results have no case in common that passes the filter")
        uppers = compare([(case, first[case], second[case]) for case in both], "old", "new")
        for case in sorted({case for case in [*first, *second] if wanted.search(case)} - set(both)):
            print(f"only in {'the first' if case in first else 'the second'}: {case}", file=sys.stderr)
    elif not cases:
        raise BadInput(f"{options.result[0]}: no case passes the filter")
    elif options.to:
        if options.to not in first:
            raise BadInput(f"{options.result[0]}: has no case {options.to}")
        uppers = compare([(case, first[options.to], first[case]) for case in cases], "that case", "this case")
    else:
        print_table(["case", "rate"], [[case, rate_cell(first[case])] for case in cases])
    return int(options.fail_below is not None and any(upper < options.fail_below for upper in uppers))


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except BadInput as bad_input:
        print(f"compare.py: error: {bad_input}", file=sys.stderr)
        sys.exit(2)
    except BrokenPipeError:
        sys.exit(0)
