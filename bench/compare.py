#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints ratios of benchmark results (Google Benchmark JSON with repetitions) as a table with their spread.

    compare.py OLD.json NEW.json              NEW relative to OLD, case by case
    compare.py RESULT.json --to CASE          every case relative to one case of the same run
    compare.py RESULT.json                    rates only

A rate is items per second; an item is a ray, an intersection test, a path or a sphere, depending on the case. Rates are
medians over the repetitions, and their spread is half the interquartile range. The interval of a ratio combines the
quartiles of both rates: if it contains 1, the difference is not significant.

Exit status: 0 on success; 1 if --fail-below LIMIT is given and the whole interval of a ratio is below LIMIT; 2 for
invalid input.
"""

import argparse
import json
import re
import statistics
import sys


class BadInput(Exception):
    """An input error; the message names the file and the problem."""


def read_rates(path):
    """Rates of all repetitions by case, sorted by case name."""
    try:
        with open(path, encoding="utf-8") as file:
            runs = list(json.load(file)["benchmarks"])
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    except (ValueError, KeyError, TypeError) as error:
        raise BadInput(f"{path}: not a Google Benchmark result (use --benchmark_out_format=json)") from error
    rates = {}
    for run in runs:
        if run.get("error_occurred"):
            raise BadInput(f"{path}: {run['name']}: {run.get('error_message', 'failed')}")
        if run.get("run_type") == "iteration" and "items_per_second" in run:
            rates.setdefault(run["name"], []).append(run["items_per_second"])
    if not rates:
        raise BadInput(f"{path}: contains no repetitions; was it run with --benchmark_report_aggregates_only?")
    return dict(sorted(rates.items(), key=lambda item: natural(item[0])))


def natural(name):
    """Sort key that compares numeric name components by value, so that 10 precedes 9000."""
    return [(part.isdigit(), int(part) if part.isdigit() else 0, part) for part in name.split("/")]


def quartiles(values):
    """First quartile, median and third quartile; minimum, median and maximum for fewer than four values."""
    if len(values) < 4:
        return min(values), statistics.median(values), max(values)
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
    return low, middle, high


def ratio(new, old):
    """Ratio of the medians, and its interval."""
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
    """Prints the table of (case, old rates, new rates). Returns the upper bounds of the ratios' intervals."""
    rows, uppers = [], []
    for case, old, new in pairs:
        middle, low, high = ratio(new, old)
        uppers.append(high)
        rows.append([case, rate_cell(old), rate_cell(new), f"{middle:.3g}", f"{low:.3g} .. {high:.3g}"])
    print_table(["case", old_name, new_name, "ratio", "interval"], rows)
    return uppers


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("result", nargs="+", metavar="RESULT.json", help="one result, or the old and the new result")
    parser.add_argument("--to", metavar="CASE", help="with one result: the reference case for all ratios")
    parser.add_argument("--filter", metavar="REGEX", default="", help="include only cases whose name matches REGEX")
    parser.add_argument("--fail-below", metavar="LIMIT", type=float,
                        help="exit with status 1 if the whole interval of a ratio is below LIMIT")
    options = parser.parse_args(arguments)
    if len(options.result) > 2 or (len(options.result) == 2 and options.to):
        parser.error("give two results, or one with --to")
    if options.fail_below is not None and len(options.result) == 1 and not options.to:
        parser.error("--fail-below requires a second result or --to")
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
            raise BadInput("the two results have no case in common that matches the filter")
        uppers = compare([(case, first[case], second[case]) for case in both], "old", "new")
        for case in sorted({case for case in [*first, *second] if wanted.search(case)} - set(both)):
            print(f"only in the {'first' if case in first else 'second'} result: {case}", file=sys.stderr)
    elif not cases:
        raise BadInput(f"{options.result[0]}: no case matches the filter")
    elif options.to:
        if options.to not in first:
            raise BadInput(f"{options.result[0]}: no case is named {options.to}")
        uppers = compare([(case, first[options.to], first[case]) for case in cases], "reference", "this case")
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
