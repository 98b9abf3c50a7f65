"""Runs the fault cases: ``python -m tests.faults --times 3 --write docs/reliability.md``.

Prints and writes the tables, and exits with status 1 if a promise was broken.
``--only '^motion' --times 20 --write-motion docs/motion.md`` runs the cases of moving robots.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import platform
import re
import signal
import sys
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any, TypeVar

from tests.bytecode import share_bytecode
from tests.faults.cases import all_cases
from tests.faults.harness import (
    END_S,
    GAP_LIMIT_S,
    RECOVERY_LIMIT_S,
    Case,
    Job,
    Outcome,
    Skipped,
    run_together,
)
from tests.faults.motion.case import Motion
from tests.faults.motion.cases import motions
from tests.faults.motion.scene import scenes
from tests.faults.motion.table import line_of, motion_page, problems

JOBS = 12
"""How many cases run at once: they mostly wait."""

PAGE = Path(__file__).with_name("page.md")

Result = Outcome | BaseException
CaseT = TypeVar("CaseT", Case, Motion)


def row(case: Case, results: list[Result]) -> tuple[str, bool]:
    """Return the line of a case, and whether its promise was broken."""
    skipped = [result for result in results if isinstance(result, Skipped)]
    if skipped:
        return f"| {case.name} | 0 |{'  |' * 10} skipped: {skipped[0]} |", False
    done = [result for result in results if isinstance(result, Outcome)]
    broken = [case.broken(result) for result in done]
    broken += [[repr(result)] for result in results if not isinstance(result, Outcome)]
    problems = [text for texts in broken for text in texts]
    kept = f"{sum(not texts for texts in broken)} of {len(results)}"
    cells = (
        case.name,
        len(results),
        sum(each.sent for each in done),
        sum(each.lost for each in done),
        sum(each.told for each in done),
        sum(each.doubled for each in done),
        sum(bool(each.hung) for each in done),
        f"{max((each.recovery_s for each in done), default=0):.1f} s",
        *(
            f"{max((getattr(each, gap) for each in done), default=0) * 1000:.0f} ms"
            for gap in ("own_gap_s", "gap_s", "control_gap_s")
        ),
        f"{max((each.end_s for each in done), default=0):.1f} s",
        f"kept {kept}" + (f": {problems[0]}" if problems else ""),
    )
    line = " | ".join(str(cell).replace("\n", " ").replace("|", "/") for cell in cells)
    return f"| {line} |", bool(problems)


def main() -> None:
    """Run the cases, and print the results."""
    parser = argparse.ArgumentParser(description="Faults over real processes.")
    parser.add_argument("--times", type=int, default=1, help="how often each case runs (1)")
    parser.add_argument("--only", default="", help="a regular expression for names of cases")
    parser.add_argument("--write", type=Path, help="the page to write")
    parser.add_argument(
        "--switched-off",
        action="store_true",
        help="run each case of motion without each of its mechanisms, and expect it to break",
    )
    parser.add_argument("--write-motion", type=Path, help="the page of motion to write")
    parser.add_argument(
        "--jobs", type=int, default=JOBS, help=f"how many run at once, of any round ({JOBS})"
    )
    options = parser.parse_args()
    share_bytecode()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # cleans up
    # Programs in the background of a shell may ignore both, and all processes of a case inherit it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGQUIT, signal.SIG_DFL)

    def chosen(found: list[CaseT]) -> list[CaseT]:
        return [each for each in found if re.search(options.only, each.name)]

    def chosen_cases() -> tuple[list[Case], list[Motion]]:
        moving = chosen(motions())
        if options.switched_off:
            return [], [each.without(switch) for each in moving for switch in each.switches]
        return chosen(all_cases()), moving

    # Each run has cases of its own, and so network namespaces of its own.
    rounds = [chosen_cases() for _ in range(options.times)]
    cases, moving = rounds[0]
    names = [*(each.name for each in cases), *(each.name for each in moving)]
    results: dict[str, list[Any]] = {name: [] for name in names}

    def take(case: Case | Motion, result: Any) -> None:
        results[case.name].append(result)
        line = line_of(case, result) if isinstance(case, Motion) else row(case, [result])[0]
        print(line, flush=True)  # noqa: T201 - a program

    jobs: list[Job] = []
    for one, two in rounds:  # one after the other, so that an interrupted run has all cases
        jobs += sorted([*one, *scenes(two)], key=lambda job: -job.lasts_s)
    try:
        asyncio.run(run_together(jobs, options.jobs, take))
    finally:  # report the cases that have run, even if interrupted
        broken = tell([each for each in cases if results[each.name]], results, options)
        broken += tell_motion([each for each in moving if results[each.name]], results, options)
    sys.exit(f"{broken} of {len(results)} cases broke a promise" if broken else 0)


def tell(
    cases: Sequence[Case], results: Mapping[str, list[Result]], options: argparse.Namespace
) -> int:
    """Print the page, write it if requested, and return how many promises are broken."""
    rows = [row(case, results[case.name]) for case in cases]
    page = PAGE.read_text(encoding="utf-8").format(
        **circumstances(options.jobs),
        limit=RECOVERY_LIMIT_S,
        gap=1000 * GAP_LIMIT_S,
        end=END_S,
        rows="\n".join(line for line, _ in rows),
    )
    if rows:
        publish(page, options.write)
    return sum(is_broken for _, is_broken in rows)


def tell_motion(
    cases: Sequence[Motion], results: Mapping[str, list[Any]], options: argparse.Namespace
) -> int:
    """Do the same for the cases of moving robots."""
    if cases:
        found = {each.name: (each, results[each.name]) for each in cases}
        publish(motion_page(found, **circumstances(options.jobs)), options.write_motion)
    return sum(any(problems(each, result) for result in results[each.name]) for each in cases)


def circumstances(jobs: int) -> dict[str, object]:
    """Return the description of this run for both pages."""
    return {
        "together": jobs,
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        "version": version("aionode"),
    }


def publish(page: str, path: Path | None) -> None:
    """Print a page, and write it if requested."""
    print(page)  # noqa: T201 - a program
    if path is not None:
        path.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
