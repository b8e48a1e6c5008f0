#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes src/points/color_map_tables.cpp: knots of the published colour maps.

Between the knots the program interpolates linearly. They are chosen so that no entry of a published table of 256 colours
differs by more than 1/255; the largest deviation of each map is printed. Exit status 1 if it is larger.

    tools/color_maps.py BATLOW.CPT > src/points/color_map_tables.cpp

BATLOW.CPT is /usr/share/gmt/cpt/SCM/batlow.cpt of the Debian package gmt-common. Needs python3-matplotlib.
"""
import re
import sys
import textwrap

import numpy as np
from matplotlib import colormaps

# Deviation that the choice of knots allows, in units of 1/255. The rest of 1/255 is for the rounding of batlow.
TOLERANCE = 0.5

# The control points of fast, which is linear in CIELAB between them: t, r, g, b.
FAST = np.array([
    [0, 0.0564, 0.0564, 0.47],
    [0.17159223942480895, 0.243, 0.46035, 0.81],
    [0.2984914818394138, 0.3568143826543521, 0.7450246485363142, 0.954367702893722],
    [0.4321287371255907, 0.6882, 0.93, 0.91791],
    [0.5, 0.8994959551205902, 0.944646394975174, 0.7686567142818399],
    [0.5882260353170073, 0.957107977357604, 0.8338185108985666, 0.5089156299842102],
    [0.7061412605695164, 0.9275207599610714, 0.6214389091739178, 0.31535705838676426],
    [0.8476395308725272, 0.8, 0.352, 0.16],
    [1, 0.59, 0.0767, 0.119475]])

# All maps, in the order of the tables.
CONTINUOUS = ["fast", "coolwarm", "viridis", "magma", "inferno", "plasma", "cividis", "batlow", "turbo"]
CATEGORICAL = ["tab10", "okabe-ito", "set2"]

OKABE_ITO = ["E69F00", "56B4E9", "009E73", "F0E442", "0072B2", "D55E00", "CC79A7", "000000"]

XYZ_FROM_REC709 = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
                            [0.0193339, 0.1191920, 0.9503041]])
WHITE_D65 = np.array([0.95047, 1.0, 1.08883])


def lab_from_srgb(srgb):
    linear = np.where(srgb > 0.04045, ((srgb + 0.055) / 1.055)**2.4, srgb / 12.92)
    x = linear @ XYZ_FROM_REC709.T / WHITE_D65
    f = np.where(x > (6 / 29)**3, np.cbrt(x), x / (3 * (6 / 29)**2) + 4 / 29)
    return np.stack([116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])], 1)


def srgb_from_lab(lab):
    y = (lab[:, 0] + 16) / 116
    f = np.stack([y + lab[:, 1] / 500, y, y - lab[:, 2] / 200], 1)
    x = np.where(f > 6 / 29, f**3, 3 * (6 / 29)**2 * (f - 4 / 29)) * WHITE_D65
    linear = np.clip(x @ np.linalg.inv(XYZ_FROM_REC709).T, 0, 1)
    return np.where(linear > 0.0031308, 1.055 * np.maximum(linear, 1e-9)**(1 / 2.4) - 0.055, 12.92 * linear)


def fast():
    lab, t = lab_from_srgb(FAST[:, 1:]), np.linspace(0, 1, 256)
    return srgb_from_lab(np.stack([np.interp(t, FAST[:, 0], lab[:, k]) for k in range(3)], 1))


def batlow(path):
    """The published table, rounded to 8 bits as GMT distributes it."""
    rows = [line.split() for line in open(path) if re.match(r"\d\.\d+\s", line)]
    codes = [row[1] for row in rows] + [rows[-1][3]]
    return np.array([[int(x) for x in code.split("/")] for code in codes]) / 255


def smoothed(table):
    """Undoes most of the rounding to 8 bits by local cubic fits: the maps are smooth."""
    out = table.copy()
    for i in range(len(table)):
        x = np.arange(max(0, i - 4), min(len(table), i + 5))
        for k in range(3):
            out[i, k] = np.polyfit(x - i, table[x, k], 3)[-1]
    return out


def knots(table):
    """The longest segments from left to right that deviate by at most TOLERANCE."""
    chosen = [0]
    while chosen[-1] < len(table) - 1:
        begin = chosen[-1]
        end = begin + 1
        for last in range(begin + 1, len(table)):
            share = (np.arange(begin, last + 1) - begin)[:, None] / (last - begin)
            line = table[begin] + (table[last] - table[begin]) * share
            if np.abs(line - table[begin:last + 1]).max() * 255 > TOLERANCE:
                break
            end = last
        chosen.append(end)
    return chosen


def emit_knots(name, table, source):
    at = knots(source)
    values = np.round(source[at], 4)
    drawn = np.stack([np.interp(np.arange(256), at, values[:, k]) for k in range(3)], 1)
    deviation = np.abs(drawn - table).max() * 255
    print(f"{name}: {len(at)} knots, largest deviation {deviation:.2f}/255", file=sys.stderr)
    rows = [f"{{{i}, {r:.4f}, {g:.4f}, {b:.4f}}}" for i, (r, g, b) in zip(at, values)]
    lines = [", ".join(rows[i:i + 3]) for i in range(0, len(rows), 3)]
    print(f"constexpr ColorMapRow {constant(name)}[] = {{\n    " + ",\n    ".join(lines) + "};\n")
    return deviation <= 1


def emit_colors(name, hex_codes):
    print(f"constexpr std::uint32_t {constant(name)}[] = {{" + ", ".join("0x" + code.upper() for code in hex_codes) + "};\n")


def constant(name):
    return "k" + "".join(word.capitalize() for word in name.split("-"))


def hex_codes(name):
    return ["%02X%02X%02X" % tuple(round(255 * x) for x in color[:3]) for color in colormaps[name].colors]


def emit_table(kind, names):
    rows = ", ".join(f'{{"{name}",~{constant(name)}}}' for name in names)
    print(f"constexpr {kind}Table k{kind}[] = {{")
    print(textwrap.fill(rows, 115, initial_indent="    ", subsequent_indent="    ").replace("~", " ") + "};\n")


def main():
    own = {"fast": fast(), "batlow": batlow(sys.argv[1])}
    good = True
    print(HEADER)
    for name in CONTINUOUS:
        table = own[name] if name in own else colormaps[name](np.arange(256))[:, :3]
        good = emit_knots(name, table, smoothed(table) if name == "batlow" else table) and good
    for name in CATEGORICAL:
        emit_colors(name, OKABE_ITO if name == "okabe-ito" else hex_codes(name.replace("set", "Set")))
    emit_table("Continuous", CONTINUOUS)
    emit_table("Categorical", CATEGORICAL)
    print(FOOTER)
    return 0 if good else 1


HEADER = """\
// SPDX-License-Identifier: Apache-2.0
// Written by tools/color_maps.py. Knots of published colour maps; docs/references.md lists their sources.
//
// batlow: MIT License, Copyright (c) 2021, Fabio Crameri.
// turbo: Apache License 2.0, Copyright 2019 Google LLC. set2: Apache License 2.0, Copyright (c) 2002 Cynthia Brewer, Mark
// Harrower, and The Pennsylvania State University.
// fast: BSD 3-clause License, Copyright (c) Kitware Inc. cividis: BSD 2-clause License with a clause on the name,
// Copyright (c) 2017, Battelle Memorial Institute. tab10: BSD 3-clause License, Copyright (c) University of Washington
// Interactive Data Lab (Vega). viridis, magma, inferno, plasma, coolwarm: CC0. okabe-ito: published for general use.
#include "points/color_map.h"

// clang-format off
namespace orrery::points {
namespace {
"""

FOOTER = """\
}  // namespace

const std::span<const ContinuousTable> kContinuousTables = kContinuous;
const std::span<const CategoricalTable> kCategoricalTables = kCategorical;

}  // namespace orrery::points"""

sys.exit(main())
