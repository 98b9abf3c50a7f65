"""Counts which launch files of a folder evaluate: ``make launch-files FOLDER=…``.

Each folder in that folder is a workspace, such as a clone of a public repository. Nothing of it is
started: ``aionode launch --print`` evaluates each file with the defaults of its arguments. A file
that does not evaluate has to say why in one line; anything else makes the exit status 1.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

LIMIT_SEC = 60.0
ENDINGS = (".launch.py", "_launch.py", ".launch.xml", ".launch.yaml", ".launch.yml")
EVALUATES, ONE_LINE = "evaluates", "one line"


def files_in(workspace: Path) -> Iterator[Path]:
    """Yield the launch files of a workspace."""
    for file in sorted(workspace.rglob("*")):
        if file.name.endswith(ENDINGS) and file.is_file():
            yield file


def outcome_of(file: Path, workspace: Path, options: list[str]) -> tuple[str, str]:
    """Return what becomes of a launch file, and the last line that says why."""
    command = [sys.executable, "-m", "aionode", "launch", "--print", *options]
    try:
        done = subprocess.run(
            [*command, "--workspace", str(workspace), str(file)],
            capture_output=True,
            check=False,
            text=True,
            errors="replace",
            timeout=LIMIT_SEC,
        )
    except subprocess.TimeoutExpired:
        return "takes too long", f"more than {LIMIT_SEC:g} s"
    lines = done.stderr.strip().splitlines()
    if done.returncode == 0:
        return EVALUATES, ""
    if "Traceback (most recent call last)" in done.stderr and done.stderr.startswith("Traceback"):
        return "traceback", lines[-1]
    return (ONE_LINE if len(lines) == 1 else "several lines"), lines[-1] if lines else ""


def main() -> int:
    """Print what becomes of each file, and how many there are of each outcome."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--skip-missing", action="store_true", help="as that of aionode launch")
    total: Counter[str] = Counter()
    arguments = parser.parse_args()
    options = ["--skip-missing"] if arguments.skip_missing else []
    for workspace in sorted(arguments.folder.resolve().iterdir()):
        files = list(files_in(workspace)) if workspace.is_dir() else []
        outcome_in = partial(outcome_of, workspace=workspace, options=options)
        with ThreadPoolExecutor(2) as threads:
            outcomes = list(threads.map(outcome_in, files))
        for file, (outcome, reason) in zip(files, outcomes, strict=True):
            print(f"{file.relative_to(workspace.parent)}: {outcome}{reason and ': '}{reason}")  # noqa: T201  # a program prints
        counts = Counter(outcome for outcome, _ in outcomes)
        print(f"{workspace.name}: {dict(counts)}")  # noqa: T201  # a program prints
        total += counts
    print(f"all: {dict(total)}")  # noqa: T201  # a program prints
    return 0 if set(total) <= {EVALUATES, ONE_LINE} else 1


if __name__ == "__main__":
    sys.exit(main())
