#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plots rays per second over the number of spheres from a bench_accel result, as SVG on standard output.

    plot.py bench/results/MACHINE/accel.json > docs/closest-hit-throughput.svg

One panel each for camera rays and secondary rays, with logarithmic axes; values are medians. A ring marks the crossover
where Embree becomes faster than the naive list, interpolated between the two neighbouring sizes.
"""

import math
import re
import statistics
import sys

from compare import BadInput, read_rates

PANELS = {"camera": "camera rays", "bounced": "secondary rays"}
CASE = re.compile(r"^accel/trace/cloud/(camera|bounced)/(.+)/(\d+)$")
# In the order of the legend. The colours are distinguishable to colour-blind readers, on white and on black.
WAYS = {
    "embree/fast": ("orrery on Embree, fast", "#009e73"),
    "embree/exact": ("orrery on Embree, exact", "#0072b2"),
    "native_points": ("scalar loop on Embree's sphere points", "#cc79a7"),
    "baseline": ("the book's naive list", "#d55e00"),
}
WIDTH, HEIGHT = 360, 300  # plot area of a panel, px
LEFT, TOP, GAP, BOTTOM = 64, 92, 40, 48


def curves(rates):
    """{rays: {way: [(spheres, median rate)]}}, sorted by number of spheres."""
    out = {"camera": {}, "bounced": {}}
    for case, values in rates.items():
        match = CASE.match(case)
        if match and match[2] in WAYS:
            out[match[1]].setdefault(match[2], []).append((int(match[3]), statistics.median(values)))
    for panel in out.values():
        for points in panel.values():
            points.sort()
    if not all(out.values()):
        raise BadInput("contains no cases accel/trace/cloud/camera/... or accel/trace/cloud/bounced/...")
    return out


def crossover(slow, fast):
    """(spheres, rate) of the last crossover where `fast` overtakes `slow`; None if the curves do not cross."""
    both = [(n, math.log(a), math.log(dict(fast)[n])) for n, a in slow if n in dict(fast)]
    for (n0, a0, b0), (n1, a1, b1) in reversed(list(zip(both, both[1:]))):
        if b0 < a0 and b1 >= a1:
            at = (a0 - b0) / ((a0 - b0) + (b1 - a1))
            return math.exp(math.log(n0) + at * math.log(n1 / n0)), math.exp(a0 + at * (a1 - a0))
    return None


def power_text(exponent):
    return f'10<tspan dy="-4" font-size="8">{exponent}</tspan>'


class Panel:
    def __init__(self, left, decades_x, decades_y):
        self.left, self.decades_x, self.decades_y = left, decades_x, decades_y

    def x(self, spheres):
        low, high = self.decades_x
        return self.left + WIDTH * (math.log10(spheres) - low) / (high - low)

    def y(self, rate):
        low, high = self.decades_y
        return TOP + HEIGHT * (high - math.log10(rate)) / (high - low)

    def frame(self, title):
        yield f'<text x="{self.left}" y="{TOP - 10}" font-weight="bold">{title}</text>'
        for k in range(self.decades_x[0], self.decades_x[1] + 1):
            x = self.x(10.0**k)
            yield f'<path class="grid" d="M{x:.1f} {TOP}v{HEIGHT}"/>'
            yield f'<text x="{x:.1f}" y="{TOP + HEIGHT + 18}" text-anchor="middle">{power_text(k)}</text>'
        for k in range(self.decades_y[0], self.decades_y[1] + 1):
            y = self.y(10.0**k)
            yield f'<path class="grid" d="M{self.left} {y:.1f}h{WIDTH}"/>'
            yield f'<text x="{self.left - 8}" y="{y + 4:.1f}" text-anchor="end">{power_text(k)}</text>'
        middle = self.left + WIDTH / 2
        yield f'<text x="{middle}" y="{TOP + HEIGHT + 38}" text-anchor="middle">spheres</text>'

    def curve(self, points, color):
        path = "L".join(f"{self.x(n):.1f} {self.y(rate):.1f}" for n, rate in points)
        yield f'<path class="curve" stroke="{color}" d="M{path}"/>'
        for n, rate in points:
            yield f'<circle cx="{self.x(n):.1f}" cy="{self.y(rate):.1f}" r="2.5" fill="{color}"/>'


def svg(panels):
    numbers = [n for panel in panels.values() for points in panel.values() for n, _ in points]
    rates = [rate for panel in panels.values() for points in panel.values() for _, rate in points]
    decades_x = math.floor(math.log10(min(numbers))), math.ceil(math.log10(max(numbers)))
    decades_y = math.floor(math.log10(min(rates))), math.ceil(math.log10(max(rates)))
    width, height = LEFT + 2 * WIDTH + GAP + 24, TOP + HEIGHT + BOTTOM
    yield (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
        'font-family="sans-serif" font-size="12" fill="#222">'
    )
    yield "<style>.grid{stroke:#ccc;fill:none}.curve{fill:none;stroke-width:2}</style>"
    yield f'<rect width="{width}" height="{height}" fill="#fff"/>'
    yield f'<text x="{LEFT}" y="20" font-size="14">Closest-hit queries, rays per second on one thread</text>'
    for i, (label, color) in enumerate(WAYS.values()):
        x, y = LEFT + (i % 2) * 260, 40 + (i // 2) * 18
        yield f'<path class="curve" stroke="{color}" d="M{x} {y - 4}h20"/><text x="{x + 26}" y="{y}">{label}</text>'
    for i, (name, panel) in enumerate(panels.items()):
        place = Panel(LEFT + i * (WIDTH + GAP), decades_x, decades_y)
        yield from place.frame(PANELS[name])
        for way, (_, color) in WAYS.items():
            if way in panel:
                yield from place.curve(panel[way], color)
        crossing = crossover(panel.get("baseline", []), panel.get("embree/exact", []))
        if crossing:
            x, y = place.x(crossing[0]), place.y(crossing[1])
            yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="7" fill="none" stroke="#222"/>'
            yield f'<text x="{x + 10:.1f}" y="{y - 32:.1f}">{crossing[0]:.1f} spheres</text>'
    yield "</svg>"


def main(arguments):
    if len(arguments) != 1:
        print("usage: plot.py RESULT.json > PLOT.svg", file=sys.stderr)
        return 2
    print("\n".join(svg(curves(read_rates(arguments[0])))))
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except BadInput as bad_input:
        print(f"plot.py: error: {bad_input}", file=sys.stderr)
        sys.exit(2)
