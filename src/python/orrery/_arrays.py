# SPDX-License-Identifier: Apache-2.0
"""Arrays as the extension module accepts them. Arrays of float64 and float32 are never copied."""

import numpy as np

_KEPT = {np.dtype(t) for t in ("float64", "float32", "int64", "int32", "uint16", "uint8")}


def numbers(values, name):
    """Returns an array of one of the kept types; others are converted, integers to int64 if they fit."""
    if np.ma.is_masked(values):
        raise ValueError(f"{name} has masked elements; leave them out, or replace them, e.g. by .filled(np.nan)")
    array = np.asarray(values)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name} must be an array of numbers, not of {array.dtype}")
    native = array.dtype.newbyteorder("=")
    if native not in _KEPT:
        is_integer = array.dtype.kind in "ib" or (array.dtype.kind == "u" and array.dtype.itemsize < 8)
        native = np.dtype("int64" if is_integer else "float64")
    return array.astype(native, copy=False)


def positions(values):
    """Returns an array of shape (n, 3)."""
    array = numbers(values, "positions")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"positions must have the shape (n, 3), not {array.shape}")
    return array


def column(values, name, rows):
    """Returns an array of one number per position."""
    array = numbers(values, name)
    if array.shape != (rows,):
        raise ValueError(f"{name} must have the shape ({rows},), one number per position, not {array.shape}")
    return array
