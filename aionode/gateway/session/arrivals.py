"""The arrival times of a client's frames, and whether they may date from before a silence."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Final, Protocol

from aionode.clock import S_TO_NS
from aionode.errors import RefusedError

if TYPE_CHECKING:
    from aionode.gateway.policy.policy import Verb
    from aionode.gateway.session.rights import Rights
    from aionode.gateway.session.robot import Robot

__all__ = ["Arrivals", "Connection"]

HAS_WAITED: Final = "it may have waited while the gateway was stalled; send it again"


class Connection(Protocol):
    """The connection of a client, as its session uses it."""

    def silent_sec(self) -> float:
        """Return for how long nothing has arrived, in seconds."""

    def has_unread(self) -> bool:
        """Return whether received data of the client waits to be read."""

    def ping(self, answered: Callable[[], None] | None = None) -> None:
        """Ping the client, and call `answered` with the pong."""

    def abort(self) -> None:
        """Close the connection at once."""


class Arrivals:
    """Tracks when frames of a client arrived, and doubts those that may have waited before.

    A doubt begins with a ping to the client, and ends with its pong: anything received later was
    sent after the ping.

    Args:
        robot: The robot, whose clock is used, and which notices standstills of the gateway.
        rights: Records what is refused.

    Attributes:
        connection: The connection of the client; None for a program, or a single request.
    """

    def __init__(self, robot: Robot, rights: Rights) -> None:
        self.connection: Connection | None = None
        self._rights = rights
        self._standstills = robot.standstills
        self._now_ns = robot.time_base.steady_ns
        self._frame_ns: int | None = None  # when the frame in progress arrived
        self._doubts = self._trusted = 0  # number of doubts, and of those that are over
        self._doubted_ns = -1
        self._stood_still = 0  # the doubt caused by the gateway's last standstill
        self._stood_still_ns = -1

    @property
    def is_doubtful(self) -> bool:
        """Whether commands may date from before a silence, because a ping is not answered yet."""
        return self._trusted < self._doubts

    def doubt(self, *, stood_still: bool = False) -> None:
        """Refuse commands until the client has answered a ping, which is sent now.

        The client was silent for too long, or the gateway did not read its data in time. Anything
        in transit meanwhile was sent before the pong.

        Args:
            stood_still: Whether the gateway was stalled for long. Then calls, goals and parameters
                are refused as well: nobody expects them any more.
        """
        if self.connection is not None:
            self._doubts += 1
            self._doubted_ns = self._now_ns() - 1
            if stood_still:
                self._stood_still, self._stood_still_ns = self._doubts, self._doubted_ns
            self.ask_for_sign()

    def ask_for_sign(self) -> None:
        """Send a ping; if the session is doubtful, its pong ends the doubt."""
        if self.connection is not None:
            answered = partial(self._trust, self._doubts) if self.is_doubtful else None
            self.connection.ping(answered)

    def note_frame(self) -> None:
        """Begin to handle a frame that arrived with the client's latest bytes."""
        if self.connection is not None:
            self._standstills.look()
            self.note_arrival(self.connection.silent_sec())
            # Work waiting in a lane may be handled only after the doubt is over.
            if self.is_doubtful:
                self._doubted_ns = max(self._doubted_ns, self.arrival_ns())
            if self._trusted < self._stood_still:
                self._stood_still_ns = max(self._stood_still_ns, self.arrival_ns())

    def note_arrival(self, age_sec: float) -> None:
        """Begin to handle something that arrived some seconds ago."""
        self._frame_ns = self._now_ns() - round(age_sec * S_TO_NS)

    def arrival_ns(self) -> int:
        """Return when the current frame arrived, in nanoseconds of the steady clock."""
        return self._now_ns() if self._frame_ns is None else self._frame_ns

    def fresh_ns(self) -> int:
        """Return the arrival time for something that the gateway makes now: it has not waited."""
        return max(self._now_ns(), self._standstills.until_ns + 1)

    def _trust(self, doubt: int) -> None:
        """End a doubt and those before it; the ping of a later one is not answered yet."""
        self._trusted = max(self._trusted, doubt)

    def check_waited(self, verb: Verb, name: str, arrived_ns: int) -> None:
        """Refuse a call, a goal or a parameter that may have waited while the gateway was stalled.

        Args:
            verb: What the client does.
            name: The name that it uses.
            arrived_ns: When its frame or request arrived, in nanoseconds of the steady clock.

        Raises:
            RefusedError: it may have waited; the code is ``too_old``.
        """
        standstills = self._standstills
        standstills.look()  # this may be the first thing to run after a standstill
        if self.connection is None:
            has_waited = arrived_ns <= standstills.long_until_ns
        else:
            has_waited = self._trusted < self._stood_still or arrived_ns <= self._stood_still_ns
        if has_waited:
            raise self._rights.refusal(verb, name, HAS_WAITED, "too_old")

    def check_command(self, what: str, arrived_ns: int) -> None:
        """Refuse a command that may date from before a silence of the client.

        Args:
            what: The subject of the refusal.
            arrived_ns: When it arrived, in nanoseconds of the steady clock.

        Raises:
            RefusedError: it may; the code is ``too_old``.
        """
        if self.connection is None and arrived_ns <= self._standstills.until_ns:
            raise RefusedError(what, HAS_WAITED, "too_old")
        if self.is_doubtful or arrived_ns <= self._doubted_ns:
            reason = "it may date from before a silence of the client, which has to answer a ping"
            raise RefusedError(what, reason, "too_old")
