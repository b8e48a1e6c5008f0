# SPDX-License-Identifier: Apache-2.0
"""Arrays as the extension module accepts them. Arrays of float64 and float32 are never copied."""

import numpy as np

from orrery import _arguments

_KEPT = {np.dtype(t) for t in ("float64", "float32", "int64", "int32", "uint16", "uint8")}
_STRINGS = "UTO"  # kinds of arrays of str; those of bytes are decoded


class Strings:
    """A column of strings: the distinct ones, and for each row the index of its string."""

    def __init__(self, array, name):
        places = {}
        try:
            self.index = np.array([places.setdefault(word, len(places)) for word in array.tolist()], dtype=np.int32)
        except TypeError:  # not hashable
            places = {None: 0}
        for word in places:
            if not isinstance(word, str):
                raise TypeError(f"{name} must be an array of numbers or of str, but has {word!r}")
            _arguments.text(name, word)
        self.words = list(places)

    def __len__(self):
        return len(self.index)


def _unmasked(values, name):
    if np.ma.is_masked(values):
        raise ValueError(f"{name} has masked elements; leave them out, or replace them, e.g. by .filled(np.nan)")
    is_list_of_str = isinstance(values, (list, tuple)) and len(values) > 0 and isinstance(values[0], str)
    return np.asarray(values, dtype=object if is_list_of_str else None)  # an array of str is as wide as the longest


def numbers(values, name):
    """Returns an array of one of the kept types; others are converted, integers to int64 if they fit."""
    array = _unmasked(values, name)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name} must be an array of numbers, not of {array.dtype}")
    native = array.dtype.newbyteorder("=")
    if native not in _KEPT:
        is_integer = array.dtype.kind in "ib" or (array.dtype.kind == "u" and array.dtype.itemsize < 8)
        native = np.dtype("int64" if is_integer else "float64")
    return array.astype(native, copy=False)


def numbers_or_strings(values, name):
    """Returns an array as numbers() does, or an array of str."""
    array = _unmasked(values, name)
    if array.dtype.kind == "S":
        array = np.char.decode(array, "utf-8", "replace")
    return array if array.dtype.kind in _STRINGS else numbers(array, name)


def positions(values):
    """Returns an array of shape (n, 3)."""
    array = numbers(values, "positions")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"positions must have the shape (n, 3), not {array.shape}")
    return array


def column(values, name, rows):
    """Returns an array of one number per position, or Strings."""
    array = numbers_or_strings(values, name)
    if array.shape != (rows,):
        raise ValueError(f"{name} must have the shape ({rows},), one value per position, not {array.shape}")
    return Strings(array, name) if array.dtype.kind in _STRINGS else array


def add_column(table, name, values):
    """Adds a column to a table that has none of this name."""
    if name in table:
        raise ValueError(f"there is a column {name!r} already")
    table[name] = values


def native(table, rows=None):
    """Returns the columns of a table, or the first rows of them, for the extension module."""
    parts = [(name, *((c.index, c.words) if isinstance(c, Strings) else (c, None))) for name, c in table.items()]
    return [(name, array[:rows], words) for name, array, words in parts]
