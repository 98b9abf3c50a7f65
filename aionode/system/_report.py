"""The final report of a system in which something failed."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.system._status import MemberEnd

__all__ = ["exit_report"]


def exit_report(ends: Sequence[MemberEnd], first: MemberEnd) -> str:
    """Describe which member failed first, how, and its last lines; then the other failures.

    Args:
        ends: All unrequested ends, in order.
        first: The end of the first member that failed for good.
    """
    lines = [f"the first to fail was {first.name}: it {first.text} after {first.ran_sec:.1f} s"]
    if first.last_lines:
        lines.append(f"its last {len(first.last_lines)} lines:")
        lines += [f"  {line}" for line in first.last_lines]
    others: dict[str, int] = {}
    for end in ends:
        if end.failed and end.name != first.name:
            others[end.name] = others.get(end.name, 0) + 1
    for name, count in others.items():
        times = "once" if count == 1 else f"{count} times"
        lines.append(f"{name} failed {times}")
    return "\n".join(lines)
