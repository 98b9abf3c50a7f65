"""A writer that notes each message of a publisher."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.engine.transport.base import Writer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

__all__ = ["NotingWriter"]


class NotingWriter(Writer):
    """A writer after a publisher's other writers, which notes each message they have accepted.

    That way publishers whose messages are not noted do no extra work per message.

    Args:
        writers: The other writers.
        check: Checks a message that none of them uses; raises what `publish` raises.
        notes: Called with the sequence number of each message.
    """

    active = True

    def __init__(
        self,
        writers: Sequence[Writer],
        check: Callable[[Any], None],
        notes: Sequence[Callable[[int], None]],
    ) -> None:
        self._writers = writers
        self._check = check
        self._notes = notes

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:  # noqa: ARG002  # as every writer
        """Record a message."""
        if not any(writer.active for writer in self._writers):
            self._check(msg)
        for note in self._notes:
            note(sequence)

    def close(self) -> None:
        """Do nothing: there is nothing to withdraw."""
