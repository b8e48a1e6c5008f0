# SPDX-License-Identifier: Apache-2.0
"""Uses the installed Python package: an image and a data file need the modules of the program. Prints where it is."""

import os
import sys

import orrery

folder = sys.argv[1]
orrery.Scene().render(4, 4, samples=1).write(os.path.join(folder, "python.exr"))
table = os.path.join(folder, "python.csv")
with open(table, "w", encoding="utf-8") as file:
    file.write("x,y,z\n1,2,3\n")
print(*orrery.read_points(table), orrery.__file__)
