# SPDX-License-Identifier: Apache-2.0
"""Exceptions. The extension module raises them with the text that the program prints."""


class Error(Exception):
    """Base class of all errors of orrery."""

    exit_status = 70  # of the program, for the same error

    def __str__(self):  # OSError shows errno and filename, which the text contains
        return str(self.args[0]) if self.args else ""


class UsageError(Error, ValueError):
    """The request is invalid."""

    exit_status = 2


class SceneError(Error, ValueError):
    """A scene or data file is invalid. The text lists all errors with their locations."""

    exit_status = 65


class MissingInputError(Error, FileNotFoundError):
    """An input cannot be opened."""

    exit_status = 66


class OutputError(Error, OSError):
    """An output cannot be created (exit_status 73), or reading or writing failed (74)."""

    exit_status = 74


class OutOfMemoryError(Error, MemoryError):
    """The scene does not fit into memory."""

    exit_status = 71


class SceneWarning(UserWarning):
    """A warning about a scene, or a target noise that was not reached."""
