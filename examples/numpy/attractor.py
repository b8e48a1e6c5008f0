#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Aizawa's attractor: integrates its equation with NumPy and renders the orbit by speed.

    ./attractor.py [WIDTH]      writes attractor.png; default: 960 pixels wide
"""

import sys

import numpy as np
import orrery

width = int(sys.argv[1]) if len(sys.argv) > 1 else 960
a, b, c, d, e, f = 0.95, 0.7, 0.6, 3.5, 0.25, 0.1


def velocity(p):
    x, y, z = p.T
    return np.stack(
        [(z - b) * x - d * y, d * x + (z - b) * y, c + a * z - z**3 / 3 - (x * x + y * y) * (1 + e * z) + f * z * x**3], 1
    )


# Many particles from one neighbourhood spread over the attractor: arrays instead of a long loop.
random = np.random.default_rng(1)
points = np.array([0.1, 0, 0]) + random.normal(scale=0.02, size=(60, 3))
orbit = []
step = 0.01
for index in range(2600):
    k1 = velocity(points)
    k2 = velocity(points + step / 2 * k1)
    k3 = velocity(points + step / 2 * k2)
    k4 = velocity(points + step * k3)
    points = points + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    if index >= 600:
        orbit.append(points)
positions = np.concatenate(orbit)
speed = np.linalg.norm(velocity(positions), axis=1)

picture = orrery.plot(
    positions, radius=0.012, color_by=speed, map="plasma", range="1%:99%", material="plastic", look_from=(35, 18),
    width=width, height=width * 9 // 16,
)  # fmt: skip
print(*picture.notes, sep="\n")
picture.write("attractor.png")
