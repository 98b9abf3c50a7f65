"""A few of the attacks; `make attacks` runs all of them.

They run once, at the same time, like the short fault cases; each is then a test of its own.
"""

from __future__ import annotations

import asyncio
from functools import cache

import msgspec
import pytest

from tests.attacks.__main__ import BEGIN, END, line_of, table
from tests.attacks.cases import all_attacks, pair
from tests.attacks.harness import Attack, Found
from tests.faults.harness import Outcome, run_together

STANDS_S = 0.5
"""The longest stall of a loop beside other tests, in seconds."""

SHORT_S = 1.0
"""How long each attack lasts here."""

SHORT = {
    attack.name: msgspec.structs.replace(attack, seconds=SHORT_S)
    for attack in all_attacks()
    if attack.short
}


@cache
def results() -> dict[str, Found | BaseException]:
    """Return the outcome of each short attack."""
    found: dict[str, Found | BaseException] = {}

    def take(attack: Attack, result: Found | BaseException) -> None:
        found[attack.name] = result

    asyncio.run(run_together(list(SHORT.values()), len(SHORT), take))
    return found


@pytest.mark.slow
@pytest.mark.timeout(120)
@pytest.mark.parametrize("name", SHORT)
def test_an_attack_is_held(name: str) -> None:
    """Each legitimate message is received or counted, and loop and memory stay as they were."""
    found = results()[name]
    if isinstance(found, BaseException):
        raise found

    assert found.broken(STANDS_S) == []


def test_the_table_says_why_an_attack_was_not_held() -> None:
    """It also has the first line of the log, and the number of further ones."""
    attack = Attack("shouts | loudly", "member", "wait", pair())
    outcome = Outcome(sent=10, lost=3, told=1, own_gap_s=0.3)
    found = Found(
        outcome, 7, 2**20, 2**21, said=["[WARN] [1.2] [node]: too loud", "x"], problems=["heard it"]
    )

    line = line_of(attack, found)

    assert "heard it; 2 of 10 true messages lost untold; a loop stood still for 300 ms" in line
    assert "2.0 times the memory" in line
    assert "`too loud` (and 1 more lines)" in line
    assert line.count("|") == 8
    assert table([line]).startswith(BEGIN)
    assert table([line]).endswith(END)


@pytest.mark.parametrize(("zenoh_bytes", "is_held"), [(60, True), (20, False)])
def test_memory_that_zenoh_takes_by_itself_is_told_and_not_counted(
    zenoh_bytes: int, is_held: bool
) -> None:
    """No program with a session can prevent it; only a node's other memory counts."""
    attack = Attack("announces", "member", "wait", pair())
    found = Found(Outcome(), memory_before_bytes=100, memory_most_bytes=180, bare_bytes=zenoh_bytes)

    assert (not found.broken()) is is_held
    assert f"1.80 times; {1.8 - zenoh_bytes / 100:.2f} times without the" in line_of(attack, found)


def test_names_of_attacks_are_unique() -> None:
    """The table has one line for each."""
    names = [attack.name for attack in all_attacks()]

    assert len(set(names)) == len(names)


@pytest.mark.stress
@pytest.mark.timeout(300)
@pytest.mark.parametrize("kind", ["descriptions", "submessages"])
def test_the_fuzzer_finds_a_planted_defect(kind: str) -> None:
    """It finds it within a minute of such lies, and finds nothing without the defect."""
    from tests.attacks.fuzz import fuzz

    assert fuzz(60.0, [kind], (kind,))
    assert not fuzz(10.0, [kind])
