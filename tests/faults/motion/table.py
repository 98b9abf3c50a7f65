"""The page of motion: who moves wheels, how it goes away, what stops them, and how soon."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from tests.faults.harness import Skipped
from tests.faults.motion.case import ALLOWED_S, Motion, Stopped
from tests.faults.motion.scene import WATCH_S

__all__ = ["line_of", "motion_page", "problems"]

PAGE = Path(__file__).with_name("page.md")

Result = Stopped | Exception


def problems(motion: Motion, result: Result) -> list[str]:
    """Return the promises that one run broke, or that it kept them without a mechanism."""
    if isinstance(result, Skipped):
        return []
    if isinstance(result, Exception):
        return [repr(result)]
    if motion.off is None or result.void:
        return motion.broken(result)
    kept = [] if motion.broken(result) else [f"kept its promise without {motion.off}"]
    return [*result.wrong, *kept]


def line_of(motion: Motion, result: Result) -> str:
    """Return the outcome of one run in one line."""
    verdict = "; ".join(problems(motion, result)) or ("broken" if motion.off else "kept")
    if isinstance(result, Skipped):
        verdict = f"skipped: {result}"
    times = ""
    if isinstance(result, Stopped):
        times = f"stopped after {seconds(result.own_s)} ({seconds(result.raw_s)}), "
    return f"{motion.name}: {times}{verdict}"


def seconds(value_s: float) -> str:
    """Return a time for the table."""
    return f"{value_s:.2f} s" if math.isfinite(value_s) else "never"


def motion_page(found: Mapping[str, tuple[Motion, Sequence[Result]]], **figures: object) -> str:
    """Return the page.

    Args:
        found: The cases by name, with their outcomes.
        figures: Further text for the head of the page.
    """
    tables = []
    columns: dict[str, list[tuple[Motion, Sequence[Result]]]] = {}
    for motion, results in found.values():
        columns.setdefault(motion.place.table, []).append((motion, results))
    for title, cases in columns.items():
        tables.append(f"## {title}\n\n{table(cases)}")
    page = PAGE.read_text(encoding="utf-8")
    return page.format(tables="\n\n".join(tables), allowed=ALLOWED_S, watched=WATCH_S, **figures)


def table(cases: Iterable[tuple[Motion, Sequence[Result]]]) -> str:
    """Return a table with a column for each place."""
    rows: dict[tuple[str, str, str], dict[str, tuple[Motion, Sequence[Result]]]] = {}
    places: list[str] = []
    for motion, results in cases:
        key = (motion.who, motion.goes, motion.stops)
        rows.setdefault(key, {})[motion.place.column] = (motion, results)
        if motion.place.column not in places:
            places.append(motion.place.column)
    head = ["moves the wheels", "goes", "what stops them", "promised", *places, "raw", "promise"]
    align = ["---"] * 3 + ["---:"] * (len(places) + 2) + ["---"]
    lines = [head, align]
    for key, by_place in rows.items():
        lines.append([*key, *cells(by_place, places)])
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def cells(
    by_place: Mapping[str, tuple[Motion, Sequence[Result]]], places: Iterable[str]
) -> Iterable[str]:
    """Yield the cells of a row: what is promised, the longest times, and how often it was kept."""
    all_runs = [(motion, each) for motion, results in by_place.values() for each in results]
    motion = all_runs[0][0]
    yield "-" if motion.limit_s is None else f"{motion.limit_s + motion.allowed_s:.1f} s"
    for place in places:
        runs = [each for each in by_place.get(place, (motion, ()))[1] if isinstance(each, Stopped)]
        never = motion.limit_s is None and runs
        yield "no: its own limit" if never else seconds_of(each.own_s for each in runs)
    stopped = [each for _, each in all_runs if isinstance(each, Stopped)]
    yield "" if motion.limit_s is None else seconds_of(each.raw_s for each in stopped)
    skipped = [each for _, each in all_runs if isinstance(each, Skipped)]
    if skipped:
        yield f"skipped: {skipped[0]}"
        return
    broken = [problems(*each) for each in all_runs]
    kept = f"kept {sum(not each for each in broken)} of {len(broken)}"
    first = next((text for each in broken for text in each), "")
    yield kept + (f": {first}".replace("|", "/").replace("\n", " ") if first else "")


def seconds_of(values_s: Iterable[float]) -> str:
    """Return the longest of some times for the table; empty if there is none."""
    return seconds(max(values, default=0.0)) if (values := list(values_s)) else ""
