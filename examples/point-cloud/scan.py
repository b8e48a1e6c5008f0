#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes scan.ply: points as an airborne laser scanner records them, on a valley with a river and a wood.

    ./scan.py [COUNT]      COUNT: number of points on the ground; default: 150000
"""

import sys

import numpy as np

count = int(sys.argv[1]) if len(sys.argv) > 1 else 150_000
width, depth = 320.0, 180.0  # metres
random = np.random.default_rng(12)


def noise(seed, exponent):
    """A smooth random surface on a grid of 512 x 512, from -1 to 1: the smaller a wave, the lower it is."""
    waves = np.fft.fftfreq(512)
    length = np.hypot(waves[:, None], waves[None, :])
    length[0, 0] = 1
    spectrum = np.fft.fft2(np.random.default_rng(seed).normal(size=(512, 512))) / length**exponent
    spectrum[0, 0] = 0
    field = np.fft.ifft2(spectrum).real
    return field / np.abs(field).max()


def at(field, x, y):
    """The value of a grid at positions in metres, bilinear."""
    u, v = x / width * 510, y / width * 510
    i, j = u.astype(int), v.astype(int)
    u, v = u - i, v - j
    return (field[j, i] * (1 - u) + field[j, i + 1] * u) * (1 - v) + (field[j + 1, i] * (1 - u) + field[j + 1, i + 1] * u) * v


hills, detail, woods = noise(3, 2.1), noise(4, 1.3), noise(5, 1.6)


def river(x):
    """Where the river is: y at x."""
    return depth / 2 + 24 * np.sin(x / 52) + 9 * np.sin(x / 19 + 1)


def ground(x, y):
    """Height of the ground: hills with a valley cut into them."""
    across = np.abs(y - river(x))
    valley = 1 - np.exp(-((across / 42) ** 2))
    return 2 + 34 * valley * (0.55 + at(hills, x, y)) + 1.5 * at(detail, x, y) - 6 * np.exp(-((across / 9) ** 4))


def mixed(a, b, t):
    return np.asarray(a) + (np.asarray(b) - a) * np.clip(t, 0, 1)[:, None]


# The ground: sand at the river, meadow, rock where it is steep, and the surface of the water at height 0.
side = np.sqrt(width * depth / count)
x, y = (grid.ravel() for grid in np.meshgrid(np.arange(0, width - side, side), np.arange(0, depth - side, side)))
x, y = x + random.uniform(0, side, x.size), y + random.uniform(0, side, y.size)
z = ground(x, y)
slope = np.hypot(ground(x + 0.5, y) - z, ground(x, y + 0.5) - z) * 2
color = mixed([196, 178, 132], [122, 148, 74], (z - 1.2) / 2.5)
color = mixed(color, [158, 150, 82], (z - 16) / 14)
color = mixed(color, [132, 122, 112], (slope - 0.75) * 3)
color += random.normal(scale=7, size=(x.size, 1))
color[z < 0] = mixed([88, 140, 168], [40, 92, 128], -z[z < 0] / 4)
parts = [(np.stack([x, y, np.maximum(z, 0)], 1), color)]

# Trees: crowns of points, denser at the top, where the laser comes from.
trees = count // 60
tx, ty = random.uniform(3, width - 3, trees), random.uniform(3, depth - 3, trees)
tz = ground(tx, ty)
keep = (at(woods, tx, ty) > 0) & (tz > 4) & (tz < 30)
tx, ty, tz = tx[keep], ty[keep], tz[keep]
returns = 70
height = random.uniform(7, 15, tx.size)[:, None]
level = 1 - random.uniform(0, 1, (tx.size, returns)) ** 1.6 * 0.75
angle = random.uniform(0, 2 * np.pi, level.shape)
radius = height * 0.24 * np.sqrt(np.maximum(1 - level, 0) * 1.3 + 0.02) * random.uniform(0.75, 1, level.shape)
crowns = np.stack([tx[:, None] + radius * np.cos(angle), ty[:, None] + radius * np.sin(angle), tz[:, None] + height * level], 2)
shade = random.uniform(0, 1, tx.size)
tint = mixed([38, 84, 48], [92, 124, 52], shade)[:, None, :] * (0.6 + 0.5 * level)[:, :, None]
parts.append((crowns.reshape(-1, 3), tint.reshape(-1, 3)))

points, colors = (np.concatenate(arrays) for arrays in zip(*parts))
table = np.empty(len(points), dtype=[("xyz", "<f4", 3), ("rgb", "u1", 3)])
table["xyz"], table["rgb"] = points, np.clip(colors, 0, 255)
with open("scan.ply", "wb") as file:
    file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(table)}\n".encode())
    file.write(b"".join(b"property float %c\n" % axis for axis in b"xyz"))
    file.write(b"property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n")
    table.tofile(file)
