"""The gateway under load: ``python -m tests.gateway``, or ``make gateway-load``.

It prints a table, and ends with status 1 if a row was not held. ``--write PAGE`` puts the table
into a page; ``--only REGEX`` runs some of the rows.
"""

from __future__ import annotations

import argparse
import asyncio
import logging
import os
import re
import signal
import sys
import traceback
from collections.abc import Awaitable, Callable
from pathlib import Path

from tests.bytecode import share_bytecode
from tests.gateway.load.cases import Row, crowd, garbage, images
from tests.gateway.load.garbage import KINDS
from tests.gateway.load.vanishing import client_vanishes, gateway_vanishes
from tests.support.peers import isolated_environment

BEGIN = "<!-- gateway under load: written by `make gateway-load` -->"
END = "<!-- end of gateway under load -->"

Case = Callable[[], Awaitable[Row]]


def cases(seconds: float, times: int) -> dict[str, Case]:
    """Return all cases, by their names."""
    found: dict[str, Case] = {
        "crowd": lambda: crowd(seconds),
        "images cbor-raw": lambda: images(seconds, "cbor-raw", 5, 10.0),
        "images JSON": lambda: images(seconds, "none", 2, 5.0),
    }
    for kind in KINDS:
        found[f"garbage {kind}"] = lambda kind=kind: garbage(seconds / 2, kind)  # type: ignore[misc]
    for how in (signal.SIGKILL, signal.SIGSTOP):
        found[f"client {how.name}"] = lambda how=how: client_vanishes(how, times)  # type: ignore[misc]
        found[f"gateway {how.name}"] = lambda how=how: gateway_vanishes(how, max(times // 5, 1))  # type: ignore[misc]
    return found


def line_of(row: Row) -> str:
    """Format a row as a line of the table."""
    held = f"no: {'; '.join(row.problems)}" if row.problems else "yes"
    return f"| {row.what} | {held} | {row.figures} |"


def run(name: str, case: Case) -> Row:
    """Return the outcome of a case; a failing case does not stop the others."""
    try:
        return asyncio.run(case())  # type: ignore[arg-type]  # a coroutine
    except Exception as error:  # noqa: BLE001  # it is told
        traceback.print_exc()
        return Row(name, [f"failed: {error!r}"], "")


def main() -> int:
    """Run the cases, and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=30.0, help="how long the load lasts")
    parser.add_argument("--times", type=int, default=50, help="how often a client vanishes")
    parser.add_argument("--only", default="", help="a regular expression for names of cases")
    parser.add_argument("--write", type=Path, help="the page that has the table")
    options = parser.parse_args()
    share_bytecode()
    logging.disable(logging.WARNING)  # this machine may be busy
    os.environ.update(isolated_environment())
    rows: list[Row] = []
    for name, case in cases(options.seconds, options.times).items():
        if re.search(options.only, name):
            rows.append(run(name, case))
            print(line_of(rows[-1]), flush=True)  # noqa: T201  # a program prints
    if options.write is not None:
        page = options.write.read_text(encoding="utf-8")
        head = ["| what | held | figures |", "| --- | --- | --- |"]
        table = "\n".join([BEGIN, *head, *map(line_of, rows), END])
        before, _, rest = page.partition(BEGIN)
        options.write.write_text(before + table + rest.partition(END)[2], encoding="utf-8")
    return 1 if any(row.problems for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
