"""Imports without the collection of garbage, which finds next to none meanwhile."""

from __future__ import annotations

import gc
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["uncollected"]


@contextmanager
def uncollected() -> Iterator[None]:
    """Pause the automatic collection of garbage, unless the program has switched it off itself.

    Nearly everything that an import creates is kept, but Python looks through it for garbage again
    and again: that is a tenth of the time until a node runs.
    """
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()
