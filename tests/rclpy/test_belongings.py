"""A library is a guest: everything else in an rclpy program is as before, however it ends.

`belongings.py` has the ends and faults. Between looks at a record lock, a transaction of sqlite,
pipes, a terminal, sockets, children, handlers of signals, the settings of the garbage collector and
the policy for event loops, and at all descriptors, each of them happens once.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.peers import isolated_environment

ROOT = Path(__file__).parents[2]
PROGRAM = Path(__file__).parent / "belongings.py"
PATIENCE_S = 80.0
ENDS = re.findall(r"^@end\ndef (\w+)", PROGRAM.read_text(encoding="utf-8"), re.MULTILINE)

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(100),
    pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux has /proc"),
]


@pytest.fixture(scope="module")
def found() -> dict[str, str]:
    """Return what was found after each end."""
    process = subprocess.run(
        [sys.executable, "-m", "aionode.rclpy", str(PROGRAM)],
        stdout=subprocess.PIPE,
        text=True,
        timeout=PATIENCE_S,
        env={**os.environ, **isolated_environment(), "PYTHONPATH": str(ROOT)},
        check=False,
    )
    ends: dict[str, str] = json.loads(process.stdout)
    return ends


@pytest.mark.processes
@pytest.mark.parametrize("end", ENDS)
def test_whatever_the_program_has_is_as_before(end: str, found: dict[str, str]) -> None:
    """The library closes, resets and replaces nothing that is not its own."""
    assert found[end] == "as before"
