"""Runs the commands of docs/howto/turtlebot3.md: ``make turtlebot3``.

They are run by one shell, in a folder of their own and in a domain of their own, until one of them
fails. ``FOLDER=CLONE`` names a clone of TurtleBot3's repository, for a machine that cannot reach
GitHub. aionode is installed from this checkout.
"""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).parents[1]
PAGE: Final = ROOT / "docs" / "howto" / "turtlebot3.md"
LIMIT_SEC: Final = 900
PLACES: Final = re.compile(r"^x: (\S+)$", re.MULTILINE)
PAGE_ANSWERS: Final = (
    "python -c \"import urllib.request as u; assert b'<html' in "
    "u.build_opener(u.ProxyHandler({})).open('http://127.0.0.1:8090').read()\""
)


def commands() -> list[str]:
    """Return the commands of the page, in order."""
    text = PAGE.read_text(encoding="utf-8")
    blocks = re.findall(r"```console\n(.*?)```", text, re.DOTALL)
    return [line.removeprefix("$ ") for block in blocks for line in block.splitlines()]


def script(clone: str | None) -> str:
    """Return the script that runs them."""
    lines = ["set -eu"]
    for command in commands():
        if clone is not None and command.startswith("git clone"):
            command = f"cp -r {shlex.quote(clone)} turtlebot3"  # noqa: PLW2901  # the same
        lines += [
            f"echo {shlex.quote(f'$ {command}')}",
            command.replace("'aionode[", f"'{ROOT}["),
            *(["sleep 5"] if command.endswith("&") else []),  # as long as a reader takes
        ]
    return "\n".join([*lines, PAGE_ANSWERS, 'echo "all of them ran"'])


def main(clone: str | None) -> int:
    """Run the page; the result is the exit status."""
    with tempfile.TemporaryDirectory() as folder:
        env = {**os.environ, "ROS_DOMAIN_ID": "93"}
        process = subprocess.Popen(
            ["bash", "-c", script(clone)],
            cwd=folder,
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        try:
            output = followed(process)
        finally:
            os.killpg(process.pid, signal.SIGKILL)
    places = [float(place) for place in PLACES.findall(output)]
    has_moved = bool(places) and max(places) - places[0] > 0.5
    sys.stdout.write(f"{len(places)} places, from {places[:1]} to {places[-1:]}\n")
    return 0 if "all of them ran" in output and has_moved else 1


def followed(process: subprocess.Popen[str]) -> str:
    """Return what the script prints until it ends; what it has started may run on."""
    assert process.stdout is not None
    signal.alarm(LIMIT_SEC)
    lines = []
    for line in process.stdout:
        lines.append(line)
        sys.stdout.write(line)
        if line == "all of them ran\n":
            break
    return "".join(lines)


if __name__ == "__main__":
    sys.exit(main(next(iter(sys.argv[1:]), None)))
