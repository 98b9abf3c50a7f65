"""A few of the cases of motion, and how they are judged.

Each runs as it is, and once for each of its mechanisms with that disabled: a case that does not
break then would show nothing. All run at the same time, since they mostly wait.
"""

from __future__ import annotations

import asyncio
from functools import cache
from typing import Any

import msgspec
import pytest

from tests.faults.harness import run_together
from tests.faults.motion.case import Motion, Place, Stopped, stopped
from tests.faults.motion.cases import motions
from tests.faults.motion.goings import killed
from tests.faults.motion.scene import scenes
from tests.faults.motion.table import motion_page, problems
from tests.faults.motion.words import Handed, Mover, What, Wheel
from tests.faults.roles import Role

WATCH_S = 2.0
"""How long the wheels are watched here."""

SPARE_S = 0.5
"""How much longer a stop may take beside other tests; without its mechanism there is none."""

SHORT = {motion.name: motion for motion in motions() if motion.short}
SWITCHED_OFF = {
    each.name: each for motion in SHORT.values() for each in map(motion.without, motion.switches)
}


@cache
def results() -> dict[int, Stopped | Exception]:
    """Return the outcome of each short case, with and without its mechanisms, by its identity."""
    found: dict[int, Stopped | Exception] = {}

    def take(motion: Motion, result: Stopped | Exception) -> None:
        found[id(motion)] = result

    jobs = [scene for part in (SHORT, SWITCHED_OFF) for scene in scenes(part.values(), WATCH_S)]
    asyncio.run(run_together(jobs, len(jobs), take))
    return found


def outcome_of(motion: Motion) -> Stopped:
    """Return the outcome of a short case."""
    result = results()[id(motion)]
    if isinstance(result, Exception):
        raise result
    return result


@pytest.mark.slow
@pytest.mark.timeout(120)
@pytest.mark.parametrize("motion", SHORT.values(), ids=SHORT)
def test_motion_ends_with_whoever_asked_for_it(motion: Motion) -> None:
    """The wheels stop in time, and nothing moves them until there is a new request."""
    assert motion.broken(outcome_of(motion), SPARE_S) == []


@pytest.mark.slow
@pytest.mark.timeout(120)
@pytest.mark.parametrize("motion", SWITCHED_OFF.values(), ids=SWITCHED_OFF)
def test_a_case_breaks_without_its_mechanism(motion: Motion) -> None:
    """Otherwise something else stopped the wheels, and the case shows nothing."""
    assert problems(motion, outcome_of(motion)) == []


def test_each_case_has_a_mechanism_or_says_that_there_is_none() -> None:
    """The table says "no: its own limit" of those, and they break if something stops the wheels."""
    assert [
        motion.name for motion in motions() if bool(motion.switches) is (motion.limit_s is None)
    ] == []


def test_names_of_cases_are_unique() -> None:
    """The table has one cell for each."""
    names = [motion.name for motion in motions()]

    assert len(set(names)) == len(names)


# What judges


def case(**options: Any) -> Motion:
    """Return a case with the promise to stop within 0.5 s."""
    role = Role("mover", mover=Mover("/wheels"))
    place = Place("link", "On one host", "link")
    wheel = Wheel("/wheels")
    return Motion(place, "a holder", "goes", "a lease", role, wheel, killed, limit_s=0.3, **options)


def handed(*events: tuple[float, What], by: int = 7) -> list[Handed]:
    """Return what wheels were given, a moment after it was sent."""
    return [Handed("/wheels", what, time_s, by, time_s - 0.01) for time_s, what in events]


def judged(motion: Motion, events: list[Handed]) -> tuple[list[str], Stopped]:
    """Return the broken promises, for a fault at 10 s, watched until 20 s."""
    outcome = stopped(motion, events, 7, (9.0, 10.0, 20.0))
    return motion.broken(outcome), outcome


BEFORE: tuple[tuple[float, What], ...] = ((9.5, "move"), (9.9, "move"))


def test_a_stop_in_time_keeps_the_promise() -> None:
    """The time counts from the fault, whatever moved the wheels before."""
    broken, outcome = judged(case(), handed(*BEFORE, (10.1, "move"), (10.4, "stop")))

    assert broken == []
    assert outcome.raw_s == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("events", "text"),
    [
        (handed(*BEFORE, (10.6, "stop")), "stopped after 0.60 s, not 0.5 s"),
        (handed(*BEFORE, (10.1, "move")), "did not stop: 1 commands, the last 0.10 s on"),
        (handed(*BEFORE, (10.2, "stop"), (15.0, "move")), "1 commands after the stop"),
        (handed((9.5, "move"), (9.7, "stop"), (10.2, "stop")), "stopped before the fault"),
        (handed((8.0, "move"), (10.2, "stop")), "did not move before the fault"),
    ],
    ids=["late", "never", "moved again", "before", "still"],
)
def test_what_breaks_the_promise_is_said(events: list[Handed], text: str) -> None:
    """Even for an inconclusive case, whose wheels stood still before the fault."""
    assert text in judged(case(), events)[0]


def test_who_moves_after_the_watch_does_no_harm() -> None:
    """By then the next mover has come."""
    assert judged(case(), handed(*BEFORE, (10.2, "stop"), (20.5, "move")))[0] == []


def test_a_plain_publisher_may_go_on_with_new_commands_alone() -> None:
    """It has no lease that could have ended, but commands from before the stop are late."""
    events = handed(*BEFORE, (10.2, "silence"), (15.0, "move"))
    old = Handed("/wheels", "move", 15.0, 7, 9.9)

    assert judged(case(returns=True), events)[0] == []
    assert judged(case(returns=True), [*events, old])[0] == ["1 commands after the stop"]


def test_beside_another_mover_only_the_own_commands_count() -> None:
    """The wheels never stand still in this case."""
    motion = case(beside=Role("other", mover=Mover("/wheels")))
    other = handed((9.0, "move"), (10.4, "move"), (19.0, "move"), by=8)

    assert judged(motion, [*handed(*BEFORE), *other])[0] == []
    own = handed(*BEFORE, (15.0, "move"))
    assert judged(motion, [*own, *other])[0] == ["1 commands after the stop"]


def test_where_nothing_can_stop_the_wheels_a_stop_is_no_limit() -> None:
    """The table must not deny what works."""
    motion = msgspec.structs.replace(case(), limit_s=None)

    assert judged(motion, handed(*BEFORE, (10.1, "move")))[0] == []
    assert judged(motion, handed(*BEFORE, (10.2, "stop")))[0] != []


def test_the_page_has_a_column_for_each_way_and_the_longest_time() -> None:
    """Each row is one way of going away, whatever the transport."""
    motion = case(switches=("lease",))
    results = [Stopped(0.3, 0.25), Stopped(0.4, 0.31)]
    page = motion_page(
        {motion.name: (motion, results)},
        together=1,
        cores=2,
        system="Linux",
        python="3",
        version="1",
    )

    assert "## On one host" in page
    assert "| a holder | goes | a lease | 0.5 s | 0.31 s | 0.40 s | kept 2 of 2 |" in page
