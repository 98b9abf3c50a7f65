"""An undeclared AdvancedSubscriber goes on asking new publishers for their history.

Zenoh:
    A subscriber with a callback is made to live in the background, so that it may be dropped. An
    AdvancedSubscriber then gives away its subscriber to late publishers, which `undeclare` can no
    longer reach. Each one takes some kilobytes for good, and asks every new publisher of its key
    for its history: a process that had created 600 pairs of transient local publishers and
    subscriptions had grown by 150 MB.
Reported:
    No.
Seen in:
    1.10.2
Workaround:
    Its handler is a pair of the callback and of an object that it does not use: Zenoh leaves such a
    subscriber in the foreground, where it ends when it is undeclared.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.engine.transport.zenoh._defects._switch import is_mended

if TYPE_CHECKING:
    from collections.abc import Callable

    import zenoh

__all__ = ["foreground"]


def foreground(callback: Callable[[zenoh.Sample], object]) -> Any:
    """Return the handler of an AdvancedSubscriber that calls `callback`."""
    return (callback, None) if is_mended("undeclared_subscribers") else callback
