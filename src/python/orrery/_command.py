# SPDX-License-Identifier: Apache-2.0
"""The command `orrery` of a wheel, which has the program inside the package (tools/wheel.sh)."""

import os
import pathlib
import sys


def run():
    os.execv(pathlib.Path(__file__).with_name("bin") / "orrery", sys.argv)
