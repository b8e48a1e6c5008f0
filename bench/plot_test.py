#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of plot.py."""

import unittest
import xml.etree.ElementTree

import compare
import plot


def rates(**curves):
    """Rates of cases, the same for camera and secondary rays; one curve per keyword, starting at ten spheres."""
    return {
        f"accel/trace/cloud/{rays}/{way.replace('__', '/')}/{10 ** (i + 1)}": [rate]
        for rays in ("camera", "bounced")
        for way, values in curves.items()
        for i, rate in enumerate(values)
    }


class PlotTest(unittest.TestCase):
    def test_crossover_is_interpolated_on_log_axes(self):
        spheres, rate = plot.crossover([(10, 100), (1000, 1)], [(10, 10), (1000, 10)])
        self.assertAlmostEqual(spheres, 100)
        self.assertAlmostEqual(rate, 10)

    def test_crossover_is_the_last_one(self):
        slow = [(1, 10), (10, 10), (100, 10), (1000, 10)]
        fast = [(1, 1), (10, 20), (100, 1), (1000, 100)]
        self.assertTrue(100 < plot.crossover(slow, fast)[0] < 1000)

    def test_no_crossover(self):
        self.assertIsNone(plot.crossover([(1, 1), (10, 1)], [(1, 2), (10, 2)]))
        self.assertIsNone(plot.crossover([(1, 3), (10, 3)], [(1, 2), (10, 2)]))

    def test_both_panels_contain_every_curve_within_the_frame(self):
        text = "\n".join(plot.svg(plot.curves(rates(baseline=[1e6, 1e4], embree__exact=[5e5, 3e5]))))
        root = xml.etree.ElementTree.fromstring(text)
        circles = [c for c in root.iter() if c.tag.endswith("circle")]
        self.assertEqual(sum(c.get("r") == "2.5" for c in circles), 2 * 2 * 2)
        self.assertEqual(sum(c.get("r") == "7" for c in circles), 2)
        for c in circles:
            self.assertTrue(plot.TOP <= float(c.get("cy")) <= plot.TOP + plot.HEIGHT, c.attrib)

    def test_a_result_without_cloud_cases_is_an_error(self):
        with self.assertRaises(compare.BadInput):
            plot.curves({"accel/build/1000": [1.0]})


if __name__ == "__main__":
    unittest.main()
