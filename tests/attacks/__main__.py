"""Runs the attacks: ``python -m tests.attacks --write docs/security.md``.

Prints the table, writes it into the page, and exits with status 1 if an attack succeeded.
``--only REGEX`` runs some of them.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import platform
import re
import signal
import sys
from pathlib import Path

from tests.attacks.cases import all_attacks
from tests.attacks.harness import MEMORY_LIMIT, Attack, Found
from tests.bytecode import share_bytecode
from tests.faults.harness import Skipped, run_together

JOBS = 2
"""How many attacks run at once: they take the processor from each other."""

BEGIN = "<!-- attacks: written by `make attacks` -->"
END = "<!-- end of attacks -->"

SAID = 120
"""How many characters of a log line the table shows."""

Result = Found | BaseException


def line_of(attack: Attack, result: Result) -> str:
    """Return the table's line of an attack."""
    cells: tuple[object, ...]
    if isinstance(result, Found):
        before, most = result.memory_before_bytes, result.memory_most_bytes
        problems = result.broken()
        cells = (
            result.tries,
            f"no: {'; '.join(problems)}" if problems else "yes",
            f"{1000 * result.outcome.own_gap_s:.0f} ms",
            f"{most / 2**20:.0f} MiB, {most / before:.2f} times{without_zenoh(result)}",
            said(result.said),
        )
    else:
        why = f"skipped: {result}" if isinstance(result, Skipped) else f"failed: {result!r}"
        cells = ("", why, "", "", "")
    texts = [attack.who, attack.name, *map(str, cells)]
    return f"| {' | '.join(text.replace('|', '/') for text in texts)} |".replace("\n", " ")


def without_zenoh(found: Found) -> str:
    """Return the figure compared with the memory limit, if it is kept only without Zenoh's part."""
    if found.memory_most_bytes <= MEMORY_LIMIT * found.memory_before_bytes or not found.bare_bytes:
        return ""
    return (
        f"; {found.own_growth:.2f} times without the {found.bare_bytes / 2**20:.0f} MiB that Zenoh "
        "itself keeps, measured beside it"
    )


def said(lines: list[str]) -> str:
    """Return the first of some log lines, and the number of further ones."""
    if not lines:
        return ""
    text = re.sub(r"^\[\w+\] (\[[^]]*\]:? )*", "", lines[0]).replace("`", "'")
    text = re.sub(r"(RIHS01_)?\b[0-9a-f]{16,}\b", "…", text)
    text = text if len(text) <= SAID else f"{text[:SAID]} …"
    return f"`{text}`" + (f" (and {len(lines) - 1} more lines)" if len(lines) > 1 else "")


def table(lines: list[str]) -> str:
    """Return the table for the page."""
    return "\n".join(
        (
            BEGIN,
            f"On {os.cpu_count()} cores of {platform.system()}, {JOBS} attacks at once.",
            "",
            "| who | attack | tries | held | longest gap | most memory | first log line |",
            "| --- | --- | ---: | --- | ---: | ---: | --- |",
            *lines,
            END,
        )
    )


def main() -> None:
    """Run the attacks, and print the results."""
    parser = argparse.ArgumentParser(description="Attacks beside true traffic.")
    parser.add_argument("--only", default="", help="a regular expression for names of attacks")
    parser.add_argument("--write", type=Path, help="the page that has the table")
    parser.add_argument("--jobs", type=int, default=JOBS, help=f"how many run at once ({JOBS})")
    options = parser.parse_args()
    share_bytecode()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))  # cleans up
    attacks = [each for each in all_attacks() if re.search(options.only, each.name)]
    results: dict[str, Result] = {}

    def take(attack: Attack, result: Result) -> None:
        results[attack.name] = result
        print(line_of(attack, result), flush=True)  # noqa: T201 - a program
        if isinstance(result, BaseException) and not isinstance(result, Skipped):
            print("\n".join(getattr(result, "__notes__", ())), flush=True)  # noqa: T201 - a program

    asyncio.run(run_together(attacks, options.jobs, take))
    text = table([line_of(each, results[each.name]) for each in attacks])
    if options.write is not None:
        page = options.write.read_text(encoding="utf-8")
        before, _, rest = page.partition(BEGIN)
        after = rest.partition(END)[2]
        options.write.write_text(f"{before}{text}{after}", encoding="utf-8")
    lost = [each.name for each in attacks if is_broken(results[each.name])]
    print(f"{len(lost)} of {len(attacks)} not held", flush=True)  # noqa: T201 - a program
    sys.exit(f"not held: {'; '.join(lost)}" if lost else 0)


def is_broken(result: Result) -> bool:
    """Return whether an attack succeeded."""
    return bool(result.broken()) if isinstance(result, Found) else not isinstance(result, Skipped)


if __name__ == "__main__":
    main()
