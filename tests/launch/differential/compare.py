"""Compares what aionode and ROS 2's launch start for launch files, file by file.

``python compare.py FILE… [name:=value…]`` in an environment with aionode and with ROS 2's `launch`,
`launch_ros`, `launch_xml` and `launch_yaml` (pure Python; from source they need `osrf_pycommon`,
`lark` and `importlib_metadata` beside them, and their grammar below AMENT_PREFIX_PATH). Nothing is
started. Both look packages up below AMENT_PREFIX_PATH alone.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from aionode.launch import Plan

ORACLE = Path(__file__).with_name("oracle.py")

TEMPORARY = re.compile(rf"({re.escape(tempfile.gettempdir())}/\w*?)[a-z0-9_]{{8}}\b")
"""A path created by a launch file with `tempfile`; its suffix differs each time."""


def real(path: str, arguments: list[str]) -> Any:
    """Return what ROS 2's launch would start, or the last line of its error."""
    done = subprocess.run(
        [sys.executable, "-W", "ignore", str(ORACLE), path, *arguments],
        capture_output=True,
        text=True,
        check=False,
    )
    return json.loads(done.stdout.splitlines()[-1]) if done.returncode == 0 else done.stderr[-300:]


def own(path: str, arguments: list[str]) -> Any:
    """Return what aionode would start, or its error."""
    values = {
        name: value for name, _, value in (argument.partition(":=") for argument in arguments)
    }
    with tempfile.TemporaryDirectory() as no_workspace:
        try:
            records = list(Plan(path, values, workspace=no_workspace).records())
        except ValueError as error:
            return str(error)
    kept = [record for record in records if "argv" in record or "container" in record]
    records = json.loads(json.dumps(kept))
    for record in records:
        del record["when"], record["where"]
    return records


def without_random(records: Any) -> Any:
    """Return records without the random ends of temporary paths."""
    return json.loads(TEMPORARY.sub(r"\1", json.dumps(records)))


def main() -> int:
    """Print a line for each file, and return how many differ."""
    words = sys.argv[1:]
    arguments = [word for word in words if ":=" in word]
    differ = 0
    for path in (word for word in words if ":=" not in word):
        expected, records = real(path, arguments), own(path, arguments)
        if isinstance(expected, str) and isinstance(records, str):
            print(f"both refuse  {path}\n    {records}")
        elif without_random(expected) == without_random(records):
            print(f"same {len(records):4}    {path}")
        else:
            differ += 1
            print(f"DIFFERENT    {path}\n    expected {expected}\n    found    {records}")
    return differ


if __name__ == "__main__":
    sys.exit(min(main(), 100))
