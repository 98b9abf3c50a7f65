"""What a program has that is not the library's, and whether all of it is as before."""

from __future__ import annotations

import fcntl
import sqlite3
import subprocess
import sys
from contextlib import closing, contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

BREAKER = """
import fcntl, sqlite3, sys
with open(sys.argv[1], "rb+") as file:
    try:
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        pass
    else:
        print("the record lock")
try:
    sqlite3.connect(sys.argv[2], timeout=0).execute("INSERT INTO log VALUES (2)")
except sqlite3.OperationalError as error:
    assert "locked" in str(error), error
else:
    print("the transaction")
"""
"""A process that tries to break the locks of another, and prints those that it could."""


@contextmanager
def locks(folder: Path) -> Iterator[None]:
    """Hold an exclusive record lock and an exclusive transaction; at the end, both have to hold."""
    record, database = folder / "record", folder / "log.sqlite"
    record.write_bytes(b"mine")
    with (
        record.open("rb+") as file,
        closing(sqlite3.connect(database, isolation_level=None)) as connection,
    ):
        connection.execute("CREATE TABLE log (line INTEGER)")
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        connection.execute("BEGIN EXCLUSIVE")
        connection.execute("INSERT INTO log VALUES (1)")

        yield

        if lost := broken(record, database):
            raise AssertionError(f"another process took {lost}")
        connection.execute("COMMIT")


def broken(record: Path, database: Path) -> str:
    """Return which of the locks another process can take."""
    command = [sys.executable, "-I", "-S", "-c", BREAKER, str(record), str(database)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    return str(done.stdout)
