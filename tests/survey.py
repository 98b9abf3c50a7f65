"""Counts how much of public repositories runs: ``make survey REPOSITORIES=… FOLDER=…``.

A list names the repositories and their commits, as ``owner/name@commit``, one a line; what is not
in the folder as ``owner+name`` is cloned from GitHub. Each clone is a workspace. ``aionode run
--check`` says what the programs that import rclpy import, and ``aionode launch --print`` evaluates
the launch files, as they are and with ``--skip-missing``; nothing is started. Tests of packages are
left out, since they need the tools of a whole ROS 2.

It has to run where aionode is installed with all its extras, of which ``desktop`` counts most: what
they bring is there only if it is installed. Any other module that is not there counts as one of
PyPI if `tests/survey_modules.txt` has its name. With ``--python``, the aionode of another Python is
asked, such as an older one. The exit status is 1 if a launch file ends in a traceback, or never.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Final, NamedTuple

LIMIT_SEC: Final = 120.0
ENDINGS: Final = (".launch.py", "_launch.py", ".launch.xml", ".launch.yaml", ".launch.yml")
IMPORTS_RCLPY: Final = re.compile(rb"^\s*(?:import|from)\s+rclpy\b", re.MULTILINE)
TESTS: Final = {"test", "tests"}
MISSING: Final = re.compile(r"  (\S+) +missing: .*")
UNREADABLE: Final = "  cannot be read:"
EVALUATES, REFUSED, TRACEBACK, TOO_LONG = "evaluates", "refused", "traceback", "takes too long"


class Aionode(NamedTuple):
    """The aionode that is asked."""

    python: str

    def __call__(self, clone: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run its command line in a clone, so that no other workspace is around it."""
        return subprocess.run(
            [self.python, "-P", "-m", "aionode", *arguments],
            cwd=clone,
            env={"USER": "robot"} | os.environ,  # containers have no USER, and every session has
            stdin=subprocess.DEVNULL,
            capture_output=True,
            check=False,
            text=True,
            errors="replace",
            timeout=LIMIT_SEC,
        )


def clone_of(line: str, folder: Path) -> Path:
    """Return the clone of a repository, which is made if it is not there."""
    repository, _, commit = line.partition("@")
    clone = folder / repository.replace("/", "+")
    if not clone.is_dir():
        url = f"https://github.com/{repository}"
        subprocess.run(["git", "clone", "--quiet", "--no-checkout", url, clone], check=True)
        subprocess.run(["git", "-C", clone, "checkout", "--quiet", commit], check=True)
    return clone


def is_test(file: Path) -> bool:
    """Return whether a file is part of the tests of a package, which a robot does not run."""
    return not TESTS.isdisjoint(file.parts) or file.name.startswith(("test_", "conftest."))


def missing_in(clone: Path, aionode: Aionode) -> Iterator[tuple[Path, frozenset[str]]]:
    """Yield the programs of rclpy in a clone, and the modules that each does not find."""
    programs = {
        file
        for file in clone.rglob("*.py")
        if file.is_file()
        and not is_test(file.relative_to(clone))
        and IMPORTS_RCLPY.search(file.read_bytes())
    }
    if not programs:
        return
    shown: dict[Path, set[str]] = {}
    file = clone
    try:
        checked = aionode(clone, "run", "--check", str(clone)).stdout
    except subprocess.TimeoutExpired:
        say(f"{clone}: {TOO_LONG}, so none of its {len(programs)} programs is counted")
        return
    for line in checked.splitlines():
        if not line.startswith("  "):
            file = Path(line)
            shown[file] = set()
        elif found := MISSING.fullmatch(line):
            shown[file].add(found[1])
        elif line.startswith(UNREADABLE):
            shown[file].add("(cannot be read)")
    yield from ((file, frozenset(shown[file])) for file in sorted(programs & set(shown)))


def launch_files_in(clone: Path, at_most: int | None) -> list[Path]:
    """Return the launch files of a clone, or some of them, evenly over the list."""
    files = sorted(
        file
        for file in clone.rglob("*")
        if file.name.endswith(ENDINGS) and file.is_file() and not is_test(file.relative_to(clone))
    )
    if at_most is None or len(files) <= at_most:
        return files
    return [files[index * len(files) // at_most] for index in range(at_most)]


def outcome_of(file: Path, clone: Path, aionode: Aionode, *options: str) -> tuple[str, str]:
    """Return what becomes of a launch file, and the last line that says why."""
    try:
        done = aionode(clone, "launch", "--print", *options, "--workspace", str(clone), str(file))
    except subprocess.TimeoutExpired:
        return TOO_LONG, f"more than {LIMIT_SEC:g} s"
    last = "".join(done.stderr.strip().splitlines()[-1:])
    if re.search(r"^Traceback \(most recent", done.stderr, re.MULTILINE):
        return TRACEBACK, last
    return (EVALUATES, "") if done.returncode == 0 else (REFUSED, last)


def say(line: str) -> None:
    """Print a line."""
    print(line, flush=True)  # noqa: T201  # a program prints


def percent(part: int, whole: int) -> str:
    """Return how much a part is of the whole."""
    return f"{part} of {whole} ({100 * part / max(whole, 1):.1f} %)"


def count_imports(clones: list[Path], aionode: Aionode) -> None:
    """Print how many programs find what they import, and what stops the others."""
    known = (Path(__file__).parent / "survey_modules.txt").read_text(encoding="utf-8")
    of_pypi = {line.strip() for line in known.splitlines() if not line.startswith("#")}
    files = whole = with_pypi = 0
    stopping: Counter[str] = Counter()
    with ThreadPoolExecutor(2) as threads:
        for found in threads.map(lambda clone: list(missing_in(clone, aionode)), clones):
            for file, missing in found:
                left = {name for name in missing if name.partition(".")[0] not in of_pypi}
                files += 1
                whole += not missing
                with_pypi += not left
                stopping.update(f"{name}{' (PyPI)' * (name not in left)}" for name in missing)
                if missing:
                    say(f"{file}: {', '.join(sorted(missing))}")
    for name, count in stopping.most_common():
        say(f"{count:4} files lack {name}")
    say(f"programs that find all imports: {percent(whole, files)}")
    say(f"… and with modules of PyPI: {percent(with_pypi, files)}")


def count_launch_files(
    clones: list[Path], aionode: Aionode, at_most: int | None, *options: str
) -> bool:
    """Print what becomes of launch files; the result is whether none ended in a traceback."""
    files = [(file, clone) for clone in clones for file in launch_files_in(clone, at_most)]
    total: Counter[str] = Counter()
    with ThreadPoolExecutor(2) as threads:
        outcomes = threads.map(lambda pair: outcome_of(pair[0], pair[1], aionode, *options), files)
        for (file, _), (outcome, reason) in zip(files, outcomes, strict=True):
            total[outcome] += 1
            say(f"{file}: {outcome}{reason and ': '}{reason}")
    how = " ".join(options) or "as they are"
    say(f"launch files that evaluate, {how}: {percent(total[EVALUATES], len(files))}; {total}")
    return set(total) <= {EVALUATES, REFUSED}


def main() -> int:
    """Count what the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("repositories", type=Path, help="a list of owner/name@commit")
    parser.add_argument("folder", type=Path, help="where their clones are, or shall be")
    parser.add_argument("--python", default=sys.executable, help="the Python of another aionode")
    parser.add_argument("--launch-files", type=int, help="maximum of each repository")
    parser.add_argument("--only", choices=("imports", "launch", "skip-missing"))
    arguments = parser.parse_args()
    aionode = Aionode(arguments.python)
    lines = arguments.repositories.read_text(encoding="utf-8").split()
    clones = [clone_of(line, arguments.folder.resolve()) for line in lines]
    fine = True
    if arguments.only in {None, "imports"}:
        count_imports(clones, aionode)
    for name, options in {"launch": (), "skip-missing": ("--skip-missing",)}.items():
        if arguments.only in {None, name}:
            fine &= count_launch_files(clones, aionode, arguments.launch_files, *options)
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
