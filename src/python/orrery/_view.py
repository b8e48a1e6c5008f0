# SPDX-License-Identifier: Apache-2.0
"""The interactive view of a scene."""

from __future__ import annotations

import html
import tomllib
import weakref
from typing import Any


class View:
    """A page in a browser that shows a scene; a notebook shows it in place.

    The page is served by this process, on 127.0.0.1, until close() or the end of the process. It shows the scene as it
    was when the view was made; arrays are not copied.
    """

    def __init__(self, page: Any, owner: Any, height: int) -> None:
        self._page = page
        self._owner = owner  # of the arrays
        self._height = height
        self._finalizer = weakref.finalize(self, page.close)  # also at the end of the process

    @property
    def address(self) -> str:
        """Address of the page, with a secret without which nothing is served; empty once the view is closed."""
        return self._page.address()

    def settings(self) -> dict[str, Any]:
        """The keys that were set in the page, and the camera if it was moved, for scene.set()."""
        return {key: _value(text) for key, text in (setting.split("=", 1) for setting in self._page.settings())}

    def close(self) -> None:
        """Ends the page."""
        self._finalizer()

    def __enter__(self) -> View:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self):
        return f"View({self.address!r})" if self.address else "View(closed)"

    def _repr_html_(self):
        if not self.address:
            return "<p>The view is closed.</p>"
        return f'<iframe src="{html.escape(self.address)}" width="100%" height="{self._height}" style="border:0"></iframe>'


def _value(text):
    """A value of a scene file; words need no quotes in the page."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text
