"""Runs what is not part of the tests: experiments that take long, or need more than Python.

``python -m tests.lab`` lists them, which needs nothing but Python, and ``python -m tests.lab NAME``
runs one, as ``make NAME`` does. Their commands are in `tests/lab.toml`.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Final, NamedTuple

__all__ = ["Experiment", "experiments"]

ROOT: Final = Path(__file__).parents[1]


class Experiment(NamedTuple):
    """What one name runs, and how long that takes."""

    what: str
    takes: str
    run: str


def experiments() -> dict[str, Experiment]:
    """Return all experiments by name, in the order of the file."""
    tables = tomllib.loads((ROOT / "tests/lab.toml").read_text(encoding="utf-8"))
    return {name: Experiment(**table) for name, table in tables.items()}


def main(names: list[str]) -> int:
    """Run the experiments that are named, or list all; the result is the exit status."""
    known = experiments()
    if unknown := [name for name in names if name not in known]:
        sys.stderr.write(f"no experiment is called {unknown[0]!r}; known: {', '.join(known)}\n")
        return 2
    if not names:
        width = max(map(len, known))
        for name, experiment in known.items():
            sys.stdout.write(f"make {name:{width}}  {experiment.what} ({experiment.takes})\n")
    here = str(Path(sys.executable).parent)  # `python` is the one that runs this
    env = os.environ | {"PATH": os.pathsep.join([here, os.environ.get("PATH", os.defpath)])}
    for name in names:
        status = subprocess.run(["sh", "-exc", known[name].run], cwd=ROOT, env=env, check=False)
        if status.returncode:
            return status.returncode
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
