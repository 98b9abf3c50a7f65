"""A process of a fault case with former defects of aionode, which a fuzzer has to find.

``python -m tests.attacks.planted DEFECT… ROLE``, with ROLE as for `tests.faults.process`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from aionode.engine.transport.reliability import writer_proxy
from aionode.engine.transport.reliability.limits import NEVER
from aionode.engine.wire import described_type
from aionode.engine.wire.cdr import _layout as layout
from aionode.message import fields
from tests.faults import process

__all__ = ["DEFECTS"]


def plant_descriptions() -> None:
    """Remove the size limit of descriptions, and the memory of visited types."""

    def holds(cls: Any, containers: tuple[str, ...]) -> bool:
        return any(
            holds(kind.nested, containers)
            if kind.nested is not None
            else kind.container in containers
            for kind in (field.type for field in fields(cls))
        )

    planted: Any = layout
    planted.holds_numbers_in = holds
    for limit in ("MAX_TYPES", "MAX_FIELDS", "MAX_DEPTH", "MAX_MESSAGE"):
        setattr(described_type, limit, 2**70)


def plant_submessages() -> None:
    """Let a HEARTBEAT or GAP move a reader forward by any distance."""
    planted: Any = writer_proxy.WriterProxy
    planted._start_anew = planted._start_at = lambda *_: None
    setattr(writer_proxy, "BELIEVED", NEVER)  # noqa: B010 - a constant


DEFECTS: dict[str, Callable[[], None]] = {
    "descriptions": plant_descriptions,
    "submessages": plant_submessages,
}


def main() -> None:
    """Run as a program."""
    *defects, role = sys.argv[1:]
    for each in defects:
        DEFECTS[each]()
    sys.argv[1:] = [role]
    process.main()


if __name__ == "__main__":
    main()
