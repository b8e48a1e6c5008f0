#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of compare.py."""

import contextlib
import io
import json
import os
import tempfile
import unittest

import compare
import tidy


class CompareTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, name, cases):
        path = os.path.join(self.folder.name, name)
        runs = [
            {"name": case, "run_type": "iteration", "items_per_second": rate}
            for case, rates in cases.items()
            for rate in rates
        ]
        # Aggregates are in the same list and must not be counted as repetitions.
        runs += [{"name": f"{case}_mean", "run_type": "aggregate", "items_per_second": 1e99} for case in cases]
        with open(path, "w", encoding="utf-8") as file:
            json.dump({"context": {}, "benchmarks": runs}, file)
        return path

    def run_main(self, *arguments):
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
            status = compare.main(list(arguments))
        return status, out.getvalue()

    def test_ratio_uses_medians(self):
        middle, low, high = compare.ratio([20, 22, 24, 26, 400], [10, 11, 12, 13, 14])
        self.assertEqual(middle, 2)
        self.assertEqual((low, high), (22 / 13, 26 / 11))

    def test_cases_are_sorted_by_number(self):
        path = self.write("a.json", {"a/1000": [1], "a/20": [1], "a/3": [1]})
        self.assertEqual(list(compare.read_rates(path)), ["a/3", "a/20", "a/1000"])

    def test_new_relative_to_old(self):
        old = self.write("old.json", {"a": [10, 10, 10], "gone": [1]})
        new = self.write("new.json", {"a": [15, 15, 15]})
        status, text = self.run_main(old, new)
        self.assertEqual(status, 0)
        self.assertIn("| a    | 10/s ±0 % | 15/s ±0 % | 1.5   | 1.5 .. 1.5 |", text)
        self.assertNotIn("gone", text)

    def test_one_case_relative_to_another(self):
        path = self.write("a.json", {"list": [2e6], "embree": [8e6]})
        self.assertRegex(self.run_main(path, "--to", "list")[1], r"embree +\| 2 M/s ±0 % \| 8 M/s ±0 % \| 4 ")

    def test_fails_only_if_the_whole_interval_is_below_the_limit(self):
        old = self.write("old.json", {"a": [10, 10, 10, 10]})
        wide = self.write("wide.json", {"a": [5, 8, 8, 12]})
        slow = self.write("slow.json", {"a": [8, 8, 8, 8]})
        self.assertEqual(self.run_main(old, wide, "--fail-below", "0.89")[0], 0)  # the quartiles are 7.25 and 9
        self.assertEqual(self.run_main(old, wide, "--fail-below", "0.91")[0], 1)
        self.assertEqual(self.run_main(old, slow, "--fail-below", "0.9")[0], 1)

    def test_invalid_input_is_an_error(self):
        path = os.path.join(self.folder.name, "x.json")
        for text in ("", "[]", "{}", '{"benchmarks": 3}', '{"benchmarks": []}'):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            with self.assertRaises(compare.BadInput, msg=text):
                compare.read_rates(path)
        with self.assertRaises(compare.BadInput):
            compare.read_rates(os.path.join(self.folder.name, "missing.json"))

    def test_tidy_keeps_rates_and_drops_the_host_name(self):
        path = self.write("a.json", {"a/10": [1.5, 2.5], "a/9": [1.0]})
        with open(path, encoding="utf-8") as file:
            result = json.load(file)
        result["context"] = {"host_name": "nobody's business", "num_cpus": 2}
        text = tidy.tidy(result)
        small = os.path.join(self.folder.name, "tidy.json")
        with open(small, "w", encoding="utf-8") as file:
            file.write(text)
        self.assertEqual(compare.read_rates(small), compare.read_rates(path))
        self.assertNotIn("host_name", text)
        self.assertNotIn("aggregate", text)


if __name__ == "__main__":
    unittest.main()
