"""Runs several cases of motion at once: one process has all wheels, each mover has its own.

Faults do not affect the wheels, so each case runs as it would alone; and such cases spend most of
their time starting processes.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import math
import time
from collections.abc import Iterable, Iterator, Sequence

import msgspec

from tests.faults.faults import wait
from tests.faults.harness import Case, Child, Stage, staged
from tests.faults.motion.case import Motion, Stopped, stopped
from tests.faults.motion.words import Handed
from tests.faults.roles import Role
from tests.support.peers import free_ports

__all__ = ["WATCH_S", "Play", "Scene", "scenes"]

READY_LIMIT_S = 60.0
"""How long everything may take until it moves, on a busy machine, in seconds."""

BEFORE_S = 1.0
"""How long everything moves before the first fault, in seconds."""

APART_S = 0.1
"""Time between the faults of one scene, in seconds."""

WATCH_S = 10.0
"""How long the wheels are watched after a fault, in seconds."""

POLL_S = 0.01
"""Interval at which reports are checked, in seconds."""

STANDS_S = 1.0
"""How long to wait for a stop after its time limit, in seconds."""

LATE_S = 1.0
"""Time between the stop and the start of other wheels, in seconds."""

AGAIN_S = 60.0
"""How long the wheels may take to obey the next mover, including its start, in seconds."""

REPEATS = 2
"""How often an inconclusive run is repeated, as on a machine without a free core."""

TOGETHER = 8
"""Maximum number of cases in one scene."""


class Play:
    """One case while it runs.

    Attributes:
        motion: The case.
        stage: The processes.
        browser: The connection to the web server of the mover, if it has one.
        stood: Set when the wheels stand still, or did not in time.
        never: Why they never moved; empty if they did.
    """

    def __init__(self, motion: Motion, stage: Stage, watch_s: float) -> None:
        self.motion = motion
        self.stage = stage
        self._watch_s = watch_s
        self.browser: asyncio.StreamWriter | None = None
        self.stood = asyncio.Event()
        self.never = ""
        self._told_s = 0.0
        self._struck_s = math.inf
        self._over_s = math.inf
        self._waited_s = 0.0
        self._by = 0

    @property
    def child(self) -> Child:
        """The mover."""
        return self.stage.children[self.motion.mover.name]

    @property
    def wheels(self) -> Child:
        """The wheels."""
        return self.stage.children["wheels"]

    def handed(self, name: str = "wheels") -> list[Handed]:
        """Return what the wheels have received so far."""
        return self.stage.children[name].handed.get(self.motion.wheel.topic, [])

    def moved_by(self, name: str) -> bool:
        """Whether a process has moved the wheels."""
        child = self.stage.children[name]
        by = 0 if child.role.command else child.pid
        return any(each.what == "move" and each.by == by for each in self.handed())

    def stops_since(self, since_s: float) -> int:
        """Return how often the wheels were told to stop since then."""
        newest = itertools.takewhile(lambda each: each.time_s > since_s, reversed(self.handed()))
        return sum(each.what != "move" for each in newest)

    @property
    def movers(self) -> list[Role]:
        """The movers of the wheels."""
        return [role for role in (self.motion.mover, self.motion.beside) if role is not None]

    async def until_moving(self) -> None:
        """Start the wheels, and wait until they move without a stop; record it if they do not.

        While a machine starts many processes, a mover may be silent for too long.
        """
        self.never = "never moved"
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(READY_LIMIT_S):
                await self.browse()
                while self.child.runs and not await self._moves():
                    pass
                self.never = ""
        if self.never or not self.child.runs:
            told = len(self.handed()), self.stops_since(0.0), self.stops_since(self._told_s)
            self.never = (
                "never moved steadily: {} commands and stops, {} stops, {} of them in the last "
                "second: ".format(*told)
                + self.child.output()[-200:]
            )

    async def _moves(self) -> bool:
        """Tell the movers to move; return whether they do so for some time."""
        for role in self.movers:
            if not self.moved_by(role.name) or self.stops_since(self._told_s):
                self.stage.children[role.name].tell("move")
        self._told_s = time.monotonic()
        await asyncio.sleep(BEFORE_S)
        moved = all(self.moved_by(role.name) for role in self.movers)
        lately = any(each.time_s > self._told_s for each in self.handed()[-1:])
        return moved and lately and not self.stops_since(self._told_s)

    async def browse(self) -> None:
        """Request the mover's route from its web server, if it has one."""
        mover = self.motion.mover.mover
        if mover is None or mover.program != "uvicorn":
            return
        while self.browser is None:
            with contextlib.suppress(ConnectionError):
                _, self.browser = await asyncio.open_connection("127.0.0.1", mover.port)
            await asyncio.sleep(0.05)
        self.browser.write(f"GET /{mover.route} HTTP/1.1\r\nHost: robot\r\n\r\n".encode())

    def struck(self) -> None:
        """Record that the fault begins now."""
        self._by = 0 if self.child.role.command else self.child.pid
        self._waits = [(child, child.core_waits()) for child in (self.child, self.wheels)]
        self._struck_s = time.monotonic()

    async def run(self) -> None:
        """Apply the fault, and watch the wheels until some time after it is over."""
        if self.never:
            self.stood.set()
            return
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(self._until_stopped())
            await self.motion.strike(self)
            self._over_s = time.monotonic()
            await asyncio.sleep(self._watch_s)

    async def _until_stopped(self) -> None:
        """Wait until the wheels stand still, and record the time without a core until then."""
        limit_s = (self.motion.limit_s or 0.0) + STANDS_S
        while not self._stands() and time.monotonic() < self._struck_s + limit_s:  # noqa: ASYNC110
            await asyncio.sleep(POLL_S)
        self._waited_s = sum(
            child.core_wait_s(before) for child, before in self._waits if child.runs
        )
        self.stood.set()

    def _stands(self) -> bool:
        return self.stops_since(self._struck_s) > 0

    def judge(self) -> Stopped:
        """Return its outcome."""
        if self.never:
            return Stopped(void=self.never)
        until_s = self._over_s + self._watch_s
        outcome = stopped(
            self.motion, self.handed(), self._by, (self._told_s, self._struck_s, until_s)
        )
        # Up to the time limit it was not a core that was waited for.
        own_s = max(self.motion.limit_s or 0.0, outcome.raw_s - self._waited_s)
        outcome.own_s = min(outcome.raw_s, own_s)
        if self.motion.joins_late:
            outcome.late += sum(each.what == "move" for each in self.handed("late"))
        if self.motion.ends and self.child.runs:
            outcome.wrong.append("its process did not end")
        return outcome


class Scene:
    """Cases that run at the same time and share the process of their wheels.

    Args:
        motions: The cases, all of one place.
        watch_s: How long the wheels are watched after each fault.
    """

    def __init__(self, motions: Sequence[Motion], watch_s: float = WATCH_S) -> None:
        self.motions = motions
        self.lasts_s = watch_s + max(each.lasts_s for each in motions)
        self._watch_s = watch_s
        self._place = motions[0].place

    async def run(self, busy: asyncio.Semaphore) -> Sequence[tuple[Motion, Stopped | Exception]]:
        """Run all of them once.

        Args:
            busy: Held while processes start.
        """
        outcomes = await self.outcomes(busy)
        for _ in range(REPEATS):
            void = [
                number
                for number, each in enumerate(outcomes)
                if isinstance(each, Stopped) and each.void
            ]
            if not void:
                break
            scene = Scene([self.motions[number] for number in void], self._watch_s)
            for number, outcome in zip(void, await scene.outcomes(busy), strict=True):
                outcomes[number] = outcome
        return list(zip(self.motions, outcomes, strict=True))

    async def outcomes(self, busy: asyncio.Semaphore) -> list[Stopped | Exception]:
        """Run the robots once; an error counts for each of them."""
        try:
            return [*await self._run(busy)]
        except Exception as error:  # noqa: BLE001 - it is told
            return [error] * len(self.motions)

    async def _run(self, busy: asyncio.Semaphore) -> Sequence[Stopped]:
        async with contextlib.AsyncExitStack() as stack:
            async with busy:
                stack.enter_context(self._place.around)
                stage = await stack.enter_async_context(staged(Case("motion", (), wait(0.0))))
                plays = [
                    Play(numbered(each, n), stage, self._watch_s)
                    for n, each in enumerate(self.motions)
                ]
                await self._start(stage, plays)
            if self._place.together:
                await asyncio.gather(*(play.until_moving() for play in plays))
            async with asyncio.TaskGroup() as tasks:
                for number, play in enumerate(plays):
                    tasks.create_task(self._run_one(play, number))
                late = [play for play in plays if play.motion.joins_late]
                if late:
                    tasks.create_task(self._join_late(stage, late))
            outcomes = [play.judge() for play in plays]
            async with busy:
                await self._move_again(stage, plays, outcomes)
            return outcomes
        raise AssertionError("not reached")

    async def _run_one(self, play: Play, number: int) -> None:
        """Apply the fault of a case, or the one that all cases share."""
        if not self._place.together:
            await asyncio.sleep(number * APART_S)
            await play.until_moving()
        await play.run()

    async def _start(self, stage: Stage, plays: Iterable[Play]) -> None:
        """Start everything, and wait until it runs; processes that end are noted later."""
        for role in self._place.roles:
            await stage.start(role)
        wheels = tuple(play.motion.wheel for play in plays)
        kind = self._place.wheels
        role = Role("wheels", wheels=wheels, rclpy=kind == "rclpy", ros=kind == "ros")
        await self._add(stage, role)
        late = tuple(play.motion.wheel for play in plays if play.motion.joins_late)
        if late:  # it takes long to start, and has to join while the fault lasts
            await self._add(stage, Role("late", wheels=late, joins=True))
        if any(role.command for play in plays for role in play.movers):
            await self._until_ready(stage)  # a command may ask the wheels for their types at once
        for play in plays:
            for role in play.movers:
                await self._add(stage, role)
        await self._until_ready(stage)

    async def _until_ready(self, stage: Stage) -> None:
        """Wait until the started processes are ready, as far as they report it."""
        ends_s = time.monotonic() + READY_LIMIT_S
        for child in stage.children.values():
            while not child.last.ready and self._may_come(child) and time.monotonic() < ends_s:  # noqa: ASYNC110
                await asyncio.sleep(POLL_S)

    @staticmethod
    def _may_come(child: Child) -> bool:
        return child.runs and not child.role.command

    async def _add(self, stage: Stage, role: Role) -> None:
        await stage.start(self._place.within(role))

    async def _join_late(self, stage: Stage, plays: Iterable[Play]) -> None:
        """Have other wheels join when the present ones stand still."""
        for play in plays:
            await play.stood.wait()
        await asyncio.sleep(LATE_S)
        stage.children["late"].tell("join")

    async def _move_again(
        self, stage: Stage, plays: Sequence[Play], outcomes: Sequence[Stopped]
    ) -> None:
        """Start the next mover, and record whose wheels do not obey it."""
        wheels = tuple(play.motion.wheel for play in plays)
        await self._add(stage, Role("next", moves=wheels))
        ends_s = time.monotonic() + AGAIN_S
        for play, outcome in zip(plays, outcomes, strict=True):
            while not (obeyed := play.moved_by("next")) and time.monotonic() < ends_s:  # noqa: ASYNC110
                await asyncio.sleep(POLL_S)
            if not obeyed:
                outcome.wrong.append("the next mover was not obeyed")


def numbered(motion: Motion, number: int) -> Motion:
    """Return a case with names, topic and port of its own."""
    topic = f"/motion{number}"
    replace = msgspec.structs.replace

    def named(role: Role, name: str) -> Role:
        mover = role.mover
        if mover is not None:
            port = free_ports(1)[0] if mover.program == "uvicorn" else 0
            mover = replace(mover, topic=topic, port=port)
        command = tuple(word.replace("TOPIC", topic) for word in role.command)
        return replace(role, name=name, mover=mover, command=command)

    return replace(
        motion,
        mover=named(motion.mover, f"mover{number}"),
        beside=motion.beside and named(motion.beside, f"beside{number}"),
        wheel=replace(motion.wheel, topic=topic),
    )


def scenes(motions: Iterable[Motion], watch_s: float = WATCH_S) -> Iterator[Scene]:
    """Yield the scenes of cases: those of one place that take about as long."""
    places: dict[str, list[Motion]] = {}
    for motion in motions:
        places.setdefault(motion.place.name, []).append(motion)
    for found in places.values():
        found.sort(key=lambda motion: motion.lasts_s)
        for first in range(0, len(found), TOGETHER):
            yield Scene(found[first : first + TOGETHER], watch_s)
