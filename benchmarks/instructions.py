"""How many instructions and cache lines one message takes, independent of other load.

Times differ from hour to hour; these counts hardly differ from run to run, so a change that makes
messages more expensive shows. Each case runs under valgrind's simulated processor, once with 64 and
once with 128 messages: the difference is the cost of 64 messages. Before each message all caches
are emptied, as they are at 100 Hz, where fetching memory takes most of a message's time; the number
of 64-byte lines of code and data that a message touches is then counted. The cost of a bare event
loop for the same iterations is subtracted.

Everything runs in one process, on asyncio's event loop, so that sending and receiving can be
distinguished. Zenoh's rows are aionode's Python code up to Zenoh's `put`, and from the queue that
Zenoh's threads fill.

Run it with ``make profile``, or ``python benchmarks/instructions.py``; it takes a minute or two
and needs valgrind (``apt install valgrind``). It prints a table, writes ``instructions.json`` to
``benchmarks/results/``, and with ``--write docs/performance.md`` brings the table there up to date.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Final

sys.path.insert(0, str(Path(__file__).parents[1]))  # run as a program, it finds its own parts

RESULTS: Final = Path(__file__).parent / "results"
TRIES: Final = 4
MESSAGES: Final = 64  # as many as are recorded, and confirmed, at once
BEGIN: Final = "<!-- instructions: made by benchmarks/instructions.py -->\n"
END: Final = "<!-- end of instructions -->\n"

# The first level is almost empty, so that the last level sees each line that is touched, and keeps
# it until all caches are emptied.
CACHES: Final = ("--I1=128,1,64", "--D1=128,1,64", "--LL=1048576,16,64")


def play(folder: str, only: str) -> None:
    """Run each case in its own forked process: the counts begin where this one's are."""
    from benchmarks.instruction_parts.cases import CASES

    for number, name in enumerate(CASES):
        for times in (1, 2) if not number or only in name else ():
            # On a very busy machine a timer may be so late that it skips a tick.
            if not any(is_complete(folder, number, times) for _ in range(TRIES)):
                raise SystemExit(f"{name}: not every message has arrived once")


def is_complete(folder: str, number: int, times: int) -> bool:
    """Run a case in its own process; return whether each message arrived once."""
    from benchmarks.instruction_parts.cases import CASES, calibrate

    child = os.fork()
    if child == 0:
        os.environ["XDG_RUNTIME_DIR"] = folder
        arrived = asyncio.run(calibrate(list(CASES)[number], times * MESSAGES))
        complete = arrived == times * MESSAGES
        if complete:
            (Path(folder) / f"{os.getpid()}.case").write_text(f"{number} {times}")
        os._exit(not complete)
    return os.waitpid(child, 0)[1] == 0


def counts(folder: Path) -> dict[tuple[int, int], dict[str, int]]:
    """Return valgrind's counts, by case and run."""
    found = {}
    for case in folder.glob("*.case"):
        number, times = map(int, case.read_text().split())
        lines = (folder / f"{case.stem}.out").read_text().splitlines()
        events = next(line for line in lines if line.startswith("events:")).split()[1:]
        totals = next(line for line in lines if line.startswith("summary:")).split()[1:]
        found[number, times] = dict(zip(events, map(int, totals), strict=True))
    return found


def measure(only: str) -> list[dict[str, Any]]:
    """Run this program under valgrind, and return its rows."""
    from benchmarks.instruction_parts.cases import CASES

    with tempfile.TemporaryDirectory(prefix="aio") as folder:
        command = [
            "valgrind", "--tool=cachegrind", "--cache-sim=yes", *CACHES, "--quiet",
            f"--cachegrind-out-file={folder}/%p.out",
            sys.executable, __file__, "--play", folder, "--only", only,
        ]  # fmt: skip
        # The same addresses, and the same order in sets, in each run.
        if shutil.which("setarch"):
            command[:0] = ["setarch", "-R"]
        environment = {**os.environ, "PYTHONHASHSEED": "0"}
        subprocess.run(command, check=True, env=environment)  # noqa: S603  # of this file
        found = counts(Path(folder))

    def of_one(number: int) -> dict[str, float]:
        one, two = found[number, 1], found[number, 2]
        each = {event: (two[event] - one[event]) / MESSAGES for event in one}
        return {
            "instructions": each["Ir"],
            "code_lines": each["ILmr"],
            "data_lines": each["DLmr"] + each["DLmw"],
        }

    floor = of_one(0)
    return [
        {"what": name, **{key: round(value - floor[key]) for key, value in of_one(number).items()}}
        for number, name in enumerate(CASES)
        if number and only in name
    ]


def table(rows: list[dict[str, Any]]) -> str:
    """Return the rows as a table of Markdown."""
    lines = [
        "| one message | instructions | lines of code | lines of data | lines |",
        "| --- | ---: | ---: | ---: | ---: |",
    ]
    for row in rows:
        together = row["code_lines"] + row["data_lines"]
        what = f"*{row['what']}*" if row["what"].startswith("bare") else row["what"]
        lines.append(
            f"| {what} | {row['instructions']:,} | {row['code_lines']:,} | "
            f"{row['data_lines']:,} | {together:,} |"
        )
    return "\n".join(lines) + "\n"


def write(page: Path, text: str) -> None:
    """Write the table into the page, between its two markers."""
    before, rest = page.read_text().split(BEGIN)
    after = rest.split(END)[1]
    page.write_text(f"{before}{BEGIN}\n{text}\n{END}{after}")


def main() -> None:
    """Measure, print the table and write the files."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--write", type=Path, metavar="PAGE", help="bring a page up to date")
    parser.add_argument("--only", default="", help="only rows whose name contains this")
    parser.add_argument("--play", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.play:
        play(args.play, args.only)
        return
    if shutil.which("valgrind") is None:
        print("skipped: valgrind is not installed (apt install valgrind)")
        return
    rows = measure(args.only)
    text = table(rows)
    print(text, end="")
    versions = f"CPython {platform.python_version()}, {platform.machine()}"
    RESULTS.mkdir(exist_ok=True)
    result = {"python": versions, "messages": MESSAGES, "rows": rows}
    (RESULTS / "instructions.json").write_text(json.dumps(result, indent=1) + "\n")
    if args.write:
        write(args.write, f"{versions}:\n\n{text}")


if __name__ == "__main__":
    main()
