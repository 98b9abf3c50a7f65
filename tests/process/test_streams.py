"""Standard streams that nobody reads, and invalid descriptors."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = """
import os, sys
{close}
read, write = os.pipe()
assert {wanted} in (read, write), (read, write)
from aionode._process.streams import discard_lost, standard
os.close(read if write == {wanted} else write)  # nobody can read it any more
discard_lost()
sys.stderr.write(os.readlink("/proc/self/fd/{wanted}") + " " + repr(sorted(standard())))
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_a_pipe_of_the_program_in_the_place_of_standard_output_is_left_alone() -> None:
    """A daemon is started without one, and its first files and sockets get the number.

    At its end, a pipe whose reader had gone became the null device.
    """
    done = subprocess.run(  # noqa: S602  # the shell closes a descriptor
        f"'{sys.executable}' -c '{PROGRAM.format(close='', wanted=1)}' <&- >&-",
        shell=True,
        check=True,
        stderr=subprocess.PIPE,
        text=True,
    )

    assert done.stderr.startswith("pipe:")
    assert done.stderr.endswith("[2]")
