"""A writer's view of one reader; the term is RTPS's."""

from __future__ import annotations

from aionode.engine.transport.reliability.limits import QUIET_NS

__all__ = ["ReaderProxy"]


class ReaderProxy:
    """A writer's view of one reader.

    Attributes:
        gid: Its id.
        participant: Its context.
        acked: The sequence number up to which it has acknowledged everything.
        end: The `Entry.end` of the last acknowledged message.
        answered: Whether it has ever sent an ACKNACK.
        heard_ns: When it last sent an ACKNACK.
        asked_ticks: Number of ticks at which it lacked messages before its first ACKNACK.
        heartbeat_ns: When the last heartbeat was sent to it.
        interval_ns: The interval between heartbeats while it does not answer.
        away_until_ns: The time until which to wait for its return; 0 while it is present.
        returned_ns: When it came back after vanishing; 0 if it never vanished.
        is_cut_off: Whether it vanished while it was answering: either its connection was lost, and
            it should return immediately, or it has ended. `StatefulWriter.tick` distinguishes them.
        resent: When each missing message was resent.
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
