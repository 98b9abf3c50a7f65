"""Counts tests that fail, and pass when they are run again: ``tests/flaky.csv`` has them.

`.ci/run` calls ``python -m tests.flaky FIRST`` after a second run of what has failed. FIRST is the
file in which pytest kept the failures of the first run; those of the second are in its cache.
Without FIRST, the table is printed.
"""

from __future__ import annotations

import csv
import json
import os
import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

__all__ = ["Flaky", "counted", "read", "write"]

TABLE: Final = Path(__file__).with_name("flaky.csv")
LAST_FAILED: Final = Path(__file__).parents[1] / ".pytest_cache/v/cache/lastfailed"

Flaky = dict[str, tuple[int, str]]
"""How often each test has failed in one run and passed in the next, and on which day last."""


def counted(table: Flaky, passed: set[str], day: str) -> Flaky:
    """Return the table with one failure more of each test; the most frequent come first."""
    new = table | {test: (table.get(test, (0, ""))[0] + 1, day) for test in passed}
    return dict(sorted(new.items(), key=lambda row: (-row[1][0], row[0])))


def read(path: Path) -> Flaky:
    """Return the table in a file; an empty one if there is none."""
    if not path.exists():
        return {}
    with path.open(encoding="utf-8", newline="") as file:
        return {row["test"]: (int(row["times"]), row["last"]) for row in csv.DictReader(file)}


def write(path: Path, table: Flaky) -> None:
    """Write the table."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["times", "last", "test"])
        writer.writerows([times, last, test] for test, (times, last) in table.items())


def failures(path: Path) -> set[str]:
    """Return the tests in a file in which pytest keeps its failures."""
    return set(json.loads(path.read_text(encoding="utf-8"))) if path.exists() else set()


def day_of(path: Path) -> str:
    """Return the day on which a file was written."""
    return datetime.fromtimestamp(path.stat().st_mtime, UTC).date().isoformat()


def main(arguments: list[str]) -> None:
    """Count what passed in the second run, and print it; without arguments, print the table."""
    table = read(TABLE)
    shown = table
    if arguments:
        passed = failures(Path(arguments[0])) - failures(LAST_FAILED)
        table = counted(table, passed, day_of(Path(arguments[0])))
        shown = {test: row for test, row in table.items() if test in passed}
        write(TABLE, table)
        if shown:
            where = "add to" if os.environ.get("CI") else "written to"
            sys.stdout.write(f"failed, and passed when run again ({where} tests/flaky.csv):\n")
    for test, (times, last) in shown.items():
        sys.stdout.write(f"{times},{last},{test}\n")


if __name__ == "__main__":
    main(sys.argv[1:])
