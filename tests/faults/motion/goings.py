"""The ways in which a mover goes away. Each function returns when its fault is over."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Awaitable, Callable

import psutil

from tests.faults.faults import Fault
from tests.faults.harness import Stage
from tests.faults.motion.scene import Play

__all__ = [
    "Strike",
    "at_once",
    "browser_leaves",
    "drives_into_standstill",
    "frozen",
    "guardian_killed",
    "hung_up",
    "interrupted_twice",
    "killed",
    "killed_beside_another",
    "leaves",
    "run_into",
    "signalled",
]

AGAIN_AFTER_S = 1.2
"""After this time, a second Ctrl-C is a person's request to end at once, and not a repetition."""

Strike = Callable[[Play], Awaitable[None]]


async def killed(play: Play) -> None:
    """Kill it."""
    play.struck()
    play.child.send(signal.SIGKILL)


async def guardian_killed(play: Play) -> None:
    """Kill the guardian of its system, which would stop its processes if the supervisor died."""
    children = psutil.Process(play.child.pid).children()
    (guardian,) = (each for each in children if "_guardian.py" in " ".join(each.cmdline()))
    play.struck()
    guardian.kill()


def frozen(seconds: float, number: int = signal.SIGSTOP) -> Strike:
    """Suspend it for some time, like a debugger, or like Ctrl-Z with SIGTSTP."""

    async def strike(play: Play) -> None:
        play.struck()
        play.child.send(number)
        await asyncio.sleep(seconds)
        play.child.send(signal.SIGCONT)

    return strike


def signalled(*numbers: int, apart_s: float = 0.0) -> Strike:
    """Send it signals, some time apart."""

    async def strike(play: Play) -> None:
        play.struck()
        for each, number in enumerate(numbers):
            if each:
                await asyncio.sleep(apart_s)
            play.child.send(number)

    return strike


def interrupted_twice(trouble: str = "", *, judged: int = 1) -> Strike:
    """Press Ctrl-C, and again when it does not end.

    Args:
        trouble: The trouble that it has run into before.
        judged: Which of the two is the fault: 0 or 1.
    """

    async def strike(play: Play) -> None:
        if trouble:
            play.child.tell(trouble)
            await asyncio.sleep(0.2)
        for each in range(2):
            if each == judged:
                play.struck()
            play.child.send(signal.SIGINT)
            await asyncio.sleep((1 - each) * AGAIN_AFTER_S)

    return strike


def run_into(trouble: str, seconds: float = 0.0) -> Strike:
    """Cause trouble for it; see `tests.faults.motion.mover`."""

    async def strike(play: Play) -> None:
        play.struck()
        play.child.tell(f"{trouble} {seconds:g}")
        await asyncio.sleep(seconds)

    return strike


async def hung_up(play: Play) -> None:
    """Close its terminal."""
    play.struck()
    play.child.hang_up()


def at_once(fault: Fault) -> Strike:
    """Apply a fault, such as one of the cable, to all movers of a place at once."""
    ends: dict[Stage, asyncio.Event] = {}  # on another stage, what shows nothing begins anew

    async def strike(play: Play) -> None:
        play.struck()
        over = ends.get(play.stage)
        if over is not None:
            await over.wait()
            return
        over = ends[play.stage] = asyncio.Event()
        await fault(play.stage)
        over.set()

    return strike


async def browser_leaves(play: Play) -> None:
    """Disconnect its browser without a message."""
    assert play.browser is not None
    play.struck()
    play.browser.transport.abort()


async def drives_into_standstill(play: Play) -> None:
    """Make it let go, and drive again for 2 s while its gateway is frozen for 3 s."""
    gateway = play.stage.children["gateway"]
    play.struck()
    play.child.tell("quiet")
    await asyncio.sleep(1.0)
    gateway.send(signal.SIGSTOP)
    play.child.tell("move")
    await asyncio.sleep(2.0)
    play.child.tell("quiet")
    await asyncio.sleep(1.0)
    gateway.send(signal.SIGCONT)


async def killed_beside_another(play: Play) -> None:
    """Let another program of the same identity try to drive as well, and then kill it."""
    play.stage.children["rival"].tell("move")
    await asyncio.sleep(1.0)
    play.struck()
    play.child.send(signal.SIGKILL)


async def leaves(play: Play) -> None:
    """Make it close its connection as at its end."""
    play.struck()
    play.child.tell("leave")


async def comes_near(play: Play) -> None:
    """Move the target of the wheels close to them."""
    play.struck()
    play.wheels.tell("near")
