"""Imports without garbage collection, which would find next to nothing."""

from __future__ import annotations

import gc
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["program_has_frozen", "uncollected"]

FROZEN_BY_PYTHON = 1000
"""Python 3.12 itself freezes 375 objects at the start; a program freezes thousands."""


def program_has_frozen() -> bool:
    """Return whether the program itself has called ``gc.freeze``."""
    return gc.get_freeze_count() >= FROZEN_BY_PYTHON


class Seen:
    """What imports have seen once, and do not look for again."""

    frozen: ClassVar[bool] = False
    """Whether the program has frozen objects; Python counts them one by one, 5 ms in a node."""


@contextmanager
def uncollected() -> Iterator[None]:
    """Pause automatic garbage collection, unless the program has switched it off itself.

    Nearly everything that an import creates is kept, but Python searches it for garbage repeatedly,
    which takes a tenth of the time until a node runs. So every object that exists at the end is
    moved to the oldest generation, as if collections had found it alive, unless the program has
    frozen objects; what it imports after that stays young.
    """
    collects = gc.isenabled()
    gc.disable()
    imported = len(sys.modules)
    try:
        yield
    finally:
        if collects:
            if len(sys.modules) > imported and not Seen.frozen:
                Seen.frozen = program_has_frozen()
                if not Seen.frozen:
                    gc.freeze()
                    gc.unfreeze()  # to the oldest generation
            gc.enable()
