"""Read bags with @mcap/core, which shares no code with Python's libraries: make bag-reader.

This needs Node.js, and MCAP_CORE set to a folder with @mcap/core, fzstd and lz4js.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from aionode import bag
from aionode.bag._writer import topic_info
from aionode.bag.files.mcap_writer import LARGE_BYTES
from aionode.interfaces.std_msgs.msg import Int32, String

FOLDER = os.environ.get("MCAP_CORE", "")
SCRIPT = Path(__file__).with_name("mcap_core.mjs")

pytestmark = pytest.mark.skipif(
    not (FOLDER and Path(FOLDER, "node_modules/@mcap/core").is_dir() and shutil.which("node")),
    reason="no node with @mcap/core: make bag-reader",
)


def read(file: Path) -> list[str]:
    """Return what @mcap/core finds in a file, one line per message."""
    done = subprocess.run(
        ["node", str(SCRIPT), FOLDER, str(file)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def line(record: bag.Record) -> str:
    """Return a message as @mcap/core's reader prints it."""
    digest = hashlib.sha256(record.raw).hexdigest()
    times = f"{record.time_ns} {record.publish_time_ns} {record.sequence}"
    return f"{record.topic} {times} {digest}"


def record(path: Path, compression: str) -> None:
    """Write small and large messages of two topics, in several chunks."""
    with bag.BagWriter(path, compression=compression) as out:
        words = out.add_topic(topic_info("/words", String))
        images = out.add_topic(topic_info("/images", Int32))
        for at in range(300):
            out.write(words, 1000 + at, f"{at}".encode() * 9, publish_time_ns=at, sequence=at)
            if at % 50 == 0:
                out.write(images, 1000 + at, os.urandom(LARGE_BYTES + at))
                out.flush()


@pytest.mark.parametrize("compression", ["zstd", "lz4", "none"])
def test_an_independent_reader_gets_every_message(compression: str, tmp_path: Path) -> None:
    """Topics, times, numbers and bytes are as written, and all checksums are right."""
    record(tmp_path / "run", compression)
    with bag.open(tmp_path / "run") as run:
        wanted = [line(each) for each in run.read()]
    assert len(wanted) == 306
    assert sorted(read(tmp_path / "run" / "run_0.mcap")) == sorted(wanted)


def test_an_independent_reader_gets_what_was_repaired(tmp_path: Path) -> None:
    """A file shortened by a power cut is complete again for every reader."""
    record(tmp_path / "run", "zstd")
    file = tmp_path / "run" / "run_0.mcap"
    file.write_bytes(file.read_bytes()[: file.stat().st_size * 2 // 3])
    (found,) = bag.check(tmp_path / "run")
    assert found.repaired
    assert len(read(file)) == found.messages > 0
