"""A case of motion: who moves the wheels, how that process goes away, and the promise."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Awaitable, Callable, Sequence
from typing import TYPE_CHECKING, Literal

import msgspec

from tests.faults.motion.words import Handed, Mover, Wheel
from tests.faults.roles import Role

if TYPE_CHECKING:
    from tests.faults.motion.scene import Play

__all__ = ["ALLOWED_S", "Motion", "Place", "Stopped", "Switch", "stopped"]

ALLOWED_S = 0.2
"""How much longer than promised a stop may take, for messages, callbacks and threads, in seconds.
"""

Strike = Callable[["Play"], Awaitable[None]]

Switch = Literal["lease", "silence", "lost", "end", "signals", "gateway", "defaults"]
"""A mechanism that stops the wheels: the lease of the mover, ``on_silence`` of the wheels,
``on_client_lost`` of the server, the shutdown of a node, aionode's handling of signals, the rules
of a gateway for commands, or the defaults in the definition of a type."""


class Stopped(msgspec.Struct):
    """The outcome of one run of a case.

    Attributes:
        raw_s: Time from the fault until the wheels were told to stop; infinite if they never were.
        own_s: The same, without the time for which the mover or the wheels waited for a core.
        late: How many commands moved them after they had stopped, while they were watched.
        moved: How many commands moved them after the fault, while they were watched.
        moved_s: Time from the fault until the last of these.
        wrong: What else went wrong.
        void: Why the run is inconclusive, such as wheels that stood still before the fault; empty
            if it is not.
    """

    raw_s: float = math.inf
    own_s: float = math.inf
    late: int = 0
    moved: int = 0
    moved_s: float = 0.0
    wrong: list[str] = []
    void: str = ""


class Place(msgspec.Struct, frozen=True):
    """Where the cases of a scene take place.

    Attributes:
        name: The name of the place, which is unique.
        table: The title of the table for its cases.
        column: The title of its column in the table.
        within: Returns a role placed there.
        roles: Further processes there.
        around: What has to exist before its processes start, such as two hosts.
        together: Whether a fault strikes all movers of the place at once.
        wheels: What the wheels run: aionode, plain rclpy, or the stand-in for a ROS 2 node.
    """

    name: str
    table: str
    column: str
    within: Callable[[Role], Role] = lambda role: role
    roles: tuple[Role, ...] = ()
    around: contextlib.AbstractContextManager[None] = contextlib.nullcontext()
    together: bool = False
    wheels: Literal["aionode", "rclpy", "ros"] = "aionode"


class Motion(msgspec.Struct, frozen=True):
    """A mover that goes away, and its wheels.

    Attributes:
        place: Where the processes are; cases of one place share the process of the wheels.
        who: Who moves the wheels, for the table.
        goes: How the mover goes away, for the table.
        stops: What stops the wheels, for the table.
        mover: The process that moves them.
        wheel: The wheels.
        strike: What happens to the mover.
        switches: The mechanisms; without any one of them the promise is broken.
        limit_s: Promised time until the wheels stop; None if nothing in aionode can stop them.
        allowed_s: How much longer that may take.
        returns: Whether the mover may move them again after the fault, with new commands, and
            another one may take over.
        beside: Another mover of the same wheels, which continues.
        joins_late: Whether other wheels join after the stop, which have to stand still too.
        ends: Whether the fault ends the process of the mover.
        lasts_s: About how long the fault takes.
        short: Whether it is part of the ordinary tests.
        off: The mechanism that is disabled, if any.
    """

    place: Place
    who: str
    goes: str
    stops: str
    mover: Role
    wheel: Wheel
    strike: Strike
    switches: tuple[Switch, ...] = ()
    limit_s: float | None = None
    allowed_s: float = ALLOWED_S
    returns: bool = False
    beside: Role | None = None
    joins_late: bool = False
    ends: bool = False
    lasts_s: float = 0.0
    short: bool = False
    off: Switch | None = None

    @property
    def name(self) -> str:
        """The case in one line."""
        off = f", without {self.off}" if self.off else ""
        return f"motion, {self.place.name}: {self.who} {self.goes}, {self.stops}{off}"

    def broken(self, outcome: Stopped, spare_s: float = 0.0) -> list[str]:
        """Return which promises an outcome breaks.

        Args:
            outcome: The outcome.
            spare_s: How much longer a stop may take beside other tests.
        """
        if outcome.void:
            return [outcome.void]
        found = list(outcome.wrong)
        if self.limit_s is None:
            # One that is back may have lost its connections meanwhile, and count as gone then.
            was_back = 0 < self.lasts_s <= outcome.raw_s
            if math.isfinite(outcome.raw_s) and not was_back:
                found.append(f"stopped after {outcome.raw_s:.2f} s, though nothing can stop it")
            return found
        limit_s = self.limit_s + self.allowed_s + spare_s
        if math.isinf(outcome.own_s):
            found.append(
                f"did not stop: {outcome.moved} commands, the last {outcome.moved_s:.2f} s on"
            )
        elif outcome.own_s > limit_s:
            found.append(f"stopped after {outcome.own_s:.2f} s, not {limit_s:.1f} s")
        if outcome.late:
            found.append(f"{outcome.late} commands after the stop")
        return found

    def without(self, switch: Switch) -> Motion:
        """Return the same case with one of its mechanisms disabled."""
        mover, wheel = self.mover.mover, self.wheel
        if mover is None and switch == "defaults":
            zero = "{tolerance: 0.0}" if wheel.action else "{for_sec: 0.0}"
            command = tuple(zero if word == "{}" else word for word in self.mover.command)
            role = msgspec.structs.replace(self.mover, command=command)
            return msgspec.structs.replace(self, mover=role, off=switch)
        if mover is None:  # a command, which only its wheels can stop
            assert switch == "silence"
            return msgspec.structs.replace(
                self, wheel=msgspec.structs.replace(wheel, silence_sec=0.0), off=switch
            )
        match switch:
            case "lease":
                mover = without_lease(mover)
            case "silence":
                wheel = msgspec.structs.replace(wheel, silence_sec=0.0)
            case "lost":
                accepts = wheel.accepts and not mover.way.startswith("mcp")
                wheel = msgspec.structs.replace(
                    wheel, lost_sec=0.0, continues=True, accepts=accepts
                )
            case "end":
                mover = msgspec.structs.replace(
                    mover, asks="goal left" if wheel.action else "publisher"
                )
            case "defaults":
                mover = msgspec.structs.replace(mover, sends_zeros=True)
            case "gateway":
                # Without a lease, an assistant has no `move`.
                way = "rosbridge" if mover.way.startswith("mcp") else mover.way
                mover = msgspec.structs.replace(mover, client="lax", way=way)
            case "signals":
                mover = msgspec.structs.replace(mover, old_signals=True)
        role = msgspec.structs.replace(self.mover, mover=mover)
        return msgspec.structs.replace(self, mover=role, wheel=wheel, off=switch)


def without_lease(mover: Mover) -> Mover:
    """Return a mover that no lease stops."""
    if mover.asks in {"policy", "policy apart"}:  # an actor always has one
        return msgspec.structs.replace(mover, ttl_sec=60.0)
    return msgspec.structs.replace(mover, asks="publisher")


def stopped(
    motion: Motion, handed: Sequence[Handed], by: int, times_s: tuple[float, float, float]
) -> Stopped:
    """Return how soon wheels stopped after a fault, and what moved them later.

    Args:
        motion: The case.
        handed: What the wheels have received.
        by: The process that moved them.
        times_s: When they started to move steadily, when the fault struck, and when watching ended.
    """
    since_s, struck_s, until_s = times_s
    moves = [each for each in handed if each.what == "move" and each.by == by]
    stops = [each.time_s for each in handed if each.what != "move"]
    if not any(since_s < each.time_s < struck_s for each in moves):
        return Stopped(void="did not move before the fault")
    if any(since_s < each < struck_s for each in stops):
        return Stopped(void="stopped before the fault")
    stop_s = min((each for each in stops if each > struck_s), default=math.inf)
    if motion.beside is None:
        moves = [each for each in handed if each.what == "move"]
    elif not motion.beside.command:  # the wheels go on: no command of this mover may come
        limit_s = struck_s + (motion.limit_s or 0.0) + motion.allowed_s
        stop_s = max(struck_s, *(each.time_s for each in moves if each.time_s < limit_s))
    late = [
        each
        for each in moves
        if stop_s < each.time_s < until_s
        and not (motion.returns and (each.by != by or each.sent_s > stop_s))
    ]
    after_s = [each.time_s - struck_s for each in moves if struck_s < each.time_s < until_s]
    return Stopped(
        raw_s=stop_s - struck_s,
        own_s=stop_s - struck_s,
        late=len(late),
        moved=len(after_s),
        moved_s=max(after_s, default=0.0),
    )
