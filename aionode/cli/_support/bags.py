"""Opening a bag for a command that is not one of ``aionode bag``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.errors import CommandError

if TYPE_CHECKING:
    from aionode.bag import Bag

__all__ = ["open_bag"]


def open_bag(path: str) -> Bag:
    """Open a bag for reading.

    Raises:
        CommandError: there is none, or its files cannot be read.
        BagError: it is not a bag, or is damaged.
    """
    from aionode import bag

    try:
        return bag.open(path)
    except OSError as error:
        raise CommandError(str(error)) from error
