# SPDX-License-Identifier: Apache-2.0
"""Types and checks of arguments. The extension module is called only with what it can convert."""

import operator
import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Path = str | os.PathLike[str]
Vector = Sequence[float] | NDArray[np.floating[Any]]
Color = float | Vector
Texture = Mapping[str, Any]


def is_number(value):
    return isinstance(value, (int, float, np.number)) and not isinstance(value, bool)


def number(name, value, low, high):
    """Returns a number in [low, high]."""
    if not is_number(value) or not low <= value <= high:
        raise ValueError(f"{name} is {value!r}; must be in [{low:g}, {high:g}]")
    return float(value)


def whole(name, value, low=-(2**31), high=2**31 - 1):
    """Returns an integer in [low, high]."""
    try:
        out = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}; must be an integer") from None
    if not low <= out <= high:
        raise ValueError(f"{name} is {out}; must be in [{low}, {high}]")
    return out


def text(name, value):
    """Returns a str that can be encoded."""
    if not isinstance(value, str):
        raise TypeError(f"{name} is {value!r}; must be a str")
    value.encode()
    return value


def path(name, value):
    """Returns the name of a file as str."""
    out = os.fsdecode(value)
    if "\0" in out:
        raise ValueError(f"{name} is {out!r}; a file name has no NUL characters")
    os.fsencode(out)
    return out
