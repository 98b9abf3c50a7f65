"""Runs programs of rclpy on ROS 2 and on aionode, one beside the other, and says what differs.

::

    python tests/live/programs/compare.py --ros kilted/bin/python programs.json [NAME…]

``programs.json`` has a list of objects: ``name``; ``run``, a file or ``package.module:function``;
``path``, folders for PYTHONPATH, and ``ros_path``, more of them on ROS 2; and where it is needed
``args``, ``interfaces``, ``terminal``, a text that is typed into a terminal of its own, ``values``
for `observer.py`, ``beside``, other programs of that form that are started before it,
``environment``, and ``ros``, false where ROS 2 cannot run it. Paths are relative to that file.
"""

from __future__ import annotations

import argparse
import json
import os
import pty
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
ENDS_SEC = 15.0
TYPED_SEC = 4.0
CALLING = "import sys; sys.argv = sys.argv[1:]; from {0} import {1}; sys.exit({1}())"
VARIES = {"heard", "log"}
"""Differences that are allowed between runs; they are shown, but do not count."""


class Side:
    """One of the two implementations."""

    def __init__(self, name: str, command: list[str], domain: int) -> None:
        self.name = name
        self.command = command
        self.domain = domain

    def environment(self, folders: list[str]) -> dict[str, str]:
        """Return the environment of a program."""
        return {
            **os.environ,
            "ROS_DOMAIN_ID": str(self.domain),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp",
            "PYTHONUNBUFFERED": "1",
            "PYTHONPATH": os.pathsep.join(folders),
        }

    def start(
        self, program: dict[str, Any], root: Path, output: Any, stdin: int = subprocess.DEVNULL
    ) -> subprocess.Popen[bytes]:
        """Start a program; a function is called by a line of Python on ROS 2."""
        command = list(self.command)
        if self.name == "aionode":
            for folder in program.get("interfaces", ()):
                command += ["--interfaces", str(root / folder)]
        module, colon, function = program["run"].partition(":")
        if not colon:
            target = [str(root / module)]
            if self.name == "aionode":
                target.insert(0, "--rclpy")
        elif self.name == "aionode":
            target = ["-m", program["run"]]
        else:
            target = ["-c", CALLING.format(module, function), program["name"]]
        folders = list(program.get("path", ()))
        if self.name == "ROS":
            folders += program.get("ros_path", ())
        return subprocess.Popen(
            [*command, *target, *(each.format(root=root) for each in program.get("args", ()))],
            env={
                **self.environment([str(root / each) for each in folders]),
                **program.get("environment", {}),
            },
            cwd=tempfile.mkdtemp(),
            stdin=stdin,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    def observe(self, program: dict[str, Any], root: Path) -> dict[str, Any]:
        """Return what an observer sees of a program, and how the program ends."""
        with ExitStack() as stack:
            for other in program.get("beside", ()):
                stack.callback(end, self.start(other, root, subprocess.DEVNULL))
            output = stack.enter_context(tempfile.TemporaryFile())
            typed = program.get("terminal")
            ours, theirs = pty.openpty() if typed is not None else (-1, subprocess.DEVNULL)
            process = self.start(program, root, output, theirs)
            stack.callback(end, process)
            timer = threading.Timer(TYPED_SEC, os.write, (ours, (typed or "").encode()))
            if typed:
                timer.start()
            seen = self.look(program, root)
            seen["ended by itself"] = process.poll()
            seen["exit status"] = end(process)
            output.seek(0)
            seen["output"] = output.read().decode(errors="replace")
            seen["last line"] = last_line(seen["output"])
            return seen

    def look(self, program: dict[str, Any], root: Path) -> dict[str, Any]:
        """Return what the observer prints."""
        values = json.dumps(program.get("values", {}))
        command = list(self.command)
        if self.name == "aionode":
            for folder in program.get("interfaces", ()):
                command += ["--interfaces", str(root / folder)]
        process = subprocess.run(
            [*command, str(HERE / "observer.py"), values],
            env=self.environment([]),
            cwd=tempfile.gettempdir(),
            capture_output=True,
            text=True,
            timeout=180,
            check=False,
        )
        if process.returncode:
            return {"observer": process.stderr[-2000:]}
        return dict(json.loads(process.stdout))


def end(process: subprocess.Popen[bytes]) -> int | str:
    """Press Ctrl-C, and return the exit status."""
    until = time.monotonic() + ENDS_SEC
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
    while process.poll() is None and time.monotonic() < until:
        time.sleep(0.05)
    if process.poll() is not None:
        return int(process.returncode)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    return "killed"


def last_line(output: str) -> str:
    """Return the exception that a program ended with, if there is one."""
    found = re.findall(r"^(?:[\w.]+(?:Error|Exception|Interrupt|Exit)\b.*)$", output, re.MULTILINE)
    return re.sub(r"^aionode\.[\w.]*\.", "", found[-1]) if found else ""


def differences(one: Any, other: Any, path: str = "") -> list[str]:
    """Return where two values differ."""
    if isinstance(one, dict) and isinstance(other, dict):
        return [
            line
            for key in sorted({*one, *other})
            for line in differences(one.get(key), other.get(key), f"{path} / {key}")
        ]
    return [] if one == other else [f"{path[3:]}: {one!r}, {other!r}"]


def compare(program: dict[str, Any], sides: list[Side], root: Path) -> None:
    """Run a program on each side, say what differs, and write all that was seen."""
    seen = {side.name: side.observe(program, root) for side in sides}
    first = seen["aionode"]
    lines = [f"== {program['name']}", f"  ends with {first['exit status']!r} {first['last line']}"]
    if "observer" in first:
        lines.append(f"  the observer fails: {first['observer']}")
    for part in sorted({*first, *seen.get("ROS", ())} - {"output"}):
        if "ROS" in seen:
            lines += (
                f"  {'perhaps ' if part in VARIES else ''}differs: {line[:600]}"
                for line in differences(seen["ROS"].get(part), first.get(part), f" / {part}")
            )
    print("\n".join(lines), flush=True)
    name = program["name"].replace("/", "+")
    results = root / "results"
    results.mkdir(exist_ok=True)
    (results / f"{name}.json").write_text(json.dumps(seen, indent=1), encoding="utf-8")


def main() -> None:
    """Run all programs, or those named, and write what was seen beside the list."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--ros", help="a Python that has ROS 2's rclpy")
    parser.add_argument("--jobs", type=int, default=2, help="how many programs run at a time")
    parser.add_argument("list", type=Path, help="a JSON file of programs")
    parser.add_argument("names", nargs="*", help="programs to run, by the beginning of their name")
    options = parser.parse_args()
    programs = [
        program
        for program in json.loads(options.list.read_text(encoding="utf-8"))
        if not options.names or program["name"].startswith(tuple(options.names))
    ]

    def run(number: int, program: dict[str, Any]) -> None:
        domain = 20 + number % 80  # programs that run at the same time do not meet
        sides = [Side("aionode", [sys.executable, "-m", "aionode", "run"], domain)]
        if options.ros and program.get("ros", True):
            sides.append(Side("ROS", [options.ros], domain + 80))
        compare(program, sides, options.list.parent.resolve())

    with ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(run, range(len(programs)), programs))


if __name__ == "__main__":
    main()
