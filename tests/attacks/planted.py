"""A process of a fault case with defects that aionode once had: what a fuzzer has to find.

``python -m tests.attacks.planted DEFECT… ROLE``, with ROLE as `tests.faults.process` takes it.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from typing import Any

from aionode import content_filter
from aionode.engine.transport import content_filters
from aionode.engine.transport.reliability import writer_proxy
from aionode.engine.transport.reliability.limits import NEVER
from aionode.engine.wire import _described_type as described_type
from aionode.engine.wire.cdr import _layout as layout
from aionode.message import fields
from tests.faults import process

__all__ = ["DEFECTS"]

MANY = 10**6


def plant_filters() -> None:
    """Let filters of others cost anything, with patterns that are searched naively."""

    def matches(like: Any, text: str) -> bool:
        return like.pattern.fullmatch(text) is not None

    plain_init = content_filter.LikePattern.__init__

    def init(like: Any, pattern: str) -> None:
        plain_init(like, pattern)
        parts = [re.escape(part).replace("_", ".") for part in pattern.split("%")]
        middle = "".join(f"(?:.*?{part})" for part in parts[1:-1] if part)
        like.pattern = re.compile(f"{parts[0]}{middle}.*{parts[-1]}", re.DOTALL)

    planted: Any = content_filter.LikePattern
    planted.__init__, planted.matches = init, matches
    budget: Any = content_filters.Budget
    budget.spend = lambda *_: None
    for limit in ("MAX_FILTERS_PER_READER", "MAX_APPLIED", "MAX_FILTERS"):
        setattr(content_filters, limit, MANY)


def plant_descriptions() -> None:
    """Let descriptions have any size, and walks over types not remember."""

    def holds(cls: Any, containers: tuple[str, ...]) -> bool:
        return any(
            holds(kind.nested, containers)
            if kind.nested is not None
            else kind.container in containers
            for kind in (field.type for field in fields(cls))
        )

    planted: Any = layout
    planted.holds_numbers_in = holds
    for limit in ("MOST_TYPES", "MOST_FIELDS", "DEEPEST", "LARGEST_MESSAGE"):
        setattr(described_type, limit, 2**70)


def plant_submessages() -> None:
    """Let a HEARTBEAT or GAP move a reader as far as it likes, and never back."""
    planted: Any = writer_proxy.WriterProxy
    planted._start_anew = planted._start_at = lambda *_: None
    setattr(writer_proxy, "BELIEVED", NEVER)  # noqa: B010 - a constant


DEFECTS: dict[str, Callable[[], None]] = {
    "filters": plant_filters,
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
