"""A short part of the fault suite; `make faults` has all of it, and takes longer.

All cases run side by side, once, since they mostly wait; each is then a test of its own.
"""

from __future__ import annotations

import asyncio
from functools import cache

import pytest

from tests.faults.cases import all_cases
from tests.faults.harness import Case, Outcome, Skipped, run_together
from tests.faults.roles import missing, note

STANDS_S = 2.0
"""The longest stall of a loop on a busy machine, in seconds; the defects took several."""

ENDS_S = 20.0
"""How long a process may take to end there; one that hangs never does."""

SHORT = {case.name: case for case in all_cases() if case.short}


@cache
def results() -> dict[str, Outcome | BaseException]:
    """Return the outcome of each short case."""
    found: dict[str, Outcome | BaseException] = {}

    def take(case: Case, outcome: Outcome | BaseException) -> None:
        found[case.name] = outcome

    asyncio.run(run_together(list(SHORT.values()), len(SHORT), take))
    return found


@pytest.mark.slow
@pytest.mark.timeout(120)
@pytest.mark.parametrize("case", SHORT.values(), ids=SHORT)
def test_a_fault_breaks_no_promise(case: Case) -> None:
    """Nothing is lost that must not be, doubled or hung, and everything works again in time."""
    outcome = results()[case.name]
    if isinstance(outcome, Skipped):
        pytest.skip(str(outcome))
    if isinstance(outcome, BaseException):
        raise outcome

    assert case.broken(outcome, STANDS_S, ENDS_S) == []


def test_names_of_cases_are_unique() -> None:
    """The table has one line for each."""
    names = [case.name for case in all_cases()]

    assert len(set(names)) == len(names)


def test_what_is_missing_is_counted() -> None:
    """The order does not matter, and a number that comes twice is detected."""
    ranges: list[tuple[int, int]] = []
    new = [note(ranges, number) for number in (3, 4, 7, 5, 4, 9)]

    assert new == [True, True, True, True, False, True]
    assert missing(ranges, 10) == 3  # 6, 8 and 10; 1 and 2 were before it listened
