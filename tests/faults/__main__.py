"""Runs the fault cases: ``python -m tests.faults --times 3 --write docs/reliability.md``.

It prints the table, writes it, and ends with status 1 if a promise was broken.
"""

from __future__ import annotations

import argparse
import asyncio
import itertools
import os
import platform
import re
import signal
import sys
from importlib.metadata import version
from pathlib import Path

from tests.faults.cases import all_cases
from tests.faults.harness import (
    END_S,
    GAP_LIMIT_S,
    RECOVERY_LIMIT_S,
    Case,
    Outcome,
    Skipped,
    run_together,
)

JOBS = 12
"""How many cases run at once: they mostly wait."""

PAGE = Path(__file__).with_name("page.md")

Result = Outcome | BaseException


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
        "--jobs", type=int, default=JOBS, help=f"how many run at once, of any round ({JOBS})"
    )
    options = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # cleans up
    # Each run has cases of its own, and so network namespaces of its own.
    rounds = [
        [case for case in all_cases() if re.search(options.only, case.name)]
        for _ in range(options.times)
    ]
    cases = rounds[0]
    results: dict[str, list[Result]] = {case.name: [] for case in cases}

    def take(case: Case, result: Result) -> None:
        results[case.name].append(result)
        print(row(case, [result])[0], flush=True)  # noqa: T201 - a program

    longest_first = sorted(itertools.chain(*rounds), key=lambda case: -case.lasts_s)
    try:
        asyncio.run(run_together(longest_first, options.jobs, take))
    finally:  # report the cases that have run, even if interrupted
        rows = [row(case, results[case.name]) for case in cases if results[case.name]]
        tell(rows, options.jobs, options.write)
    broken = sum(is_broken for _, is_broken in rows)
    sys.exit(f"{broken} of {len(rows)} cases broke a promise" if broken else 0)


def tell(rows: list[tuple[str, bool]], jobs: int, path: Path | None) -> None:
    """Print the page, and write it where it is wanted."""
    page = PAGE.read_text(encoding="utf-8").format(
        together=jobs,
        cores=os.cpu_count(),
        system=platform.system(),
        python=platform.python_version(),
        version=version("aionode"),
        limit=RECOVERY_LIMIT_S,
        gap=1000 * GAP_LIMIT_S,
        end=END_S,
        rows="\n".join(line for line, _ in rows),
    )
    print(page)  # noqa: T201 - a program
    if path is not None:
        path.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
