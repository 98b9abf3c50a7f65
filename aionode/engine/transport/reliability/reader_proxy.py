"""One reader, as its writer sees it; the word is that of RTPS."""

from __future__ import annotations

from aionode.engine.transport.reliability.limits import QUIET_NS

__all__ = ["ReaderProxy"]


class ReaderProxy:
    """A reader, as its writer sees it.

    Attributes:
        gid: Its id.
        participant: Its context.
        acked: It has acknowledged everything up to this sequence number.
        end: The `Entry.end` of the last acknowledged message.
        answered: Whether it has ever sent an ACKNACK.
        heard_ns: When it last sent an ACKNACK.
        asked_ticks: At how many ticks it lacked messages before it sent its first ACKNACK.
        heartbeat_ns: When the last heartbeat was sent to it.
        interval_ns: The time from one heartbeat to the next while it does not answer.
        away_until_ns: Until when its return is waited for; 0 while it is present.
        returned_ns: When it came back after it had vanished; 0 if it never vanished.
        is_cut_off: Whether it vanished while it answered: either its connection was lost, and it
            is expected to return at once, or it has ended. `StatefulWriter.tick` tells them apart.
        resent: When each missing message was sent again.
    """

    __slots__ = (
        "acked",
        "answered",
        "asked_ticks",
        "away_until_ns",
        "end",
        "gid",
        "heard_ns",
        "heartbeat_ns",
        "interval_ns",
        "is_cut_off",
        "participant",
        "resent",
        "returned_ns",
    )

    def __init__(self, gid: bytes, participant: str, acked: int, end: int, now_ns: int) -> None:
        self.gid = gid
        self.participant = participant
        self.acked = acked
        self.end = end
        self.heard_ns = now_ns
        self.heartbeat_ns = now_ns
        self.interval_ns = QUIET_NS
        self.answered = False
        self.asked_ticks = 0
        self.away_until_ns = 0
        self.returned_ns = 0
        self.is_cut_off = False
        self.resent: dict[int, int] = {}
