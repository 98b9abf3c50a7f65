"""One log of all members of a system: on a stream, and in a file for each member on request."""

from __future__ import annotations

import io
import os
import stat
import sys
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final, TextIO, TypeAlias

import msgspec

from aionode._process.streams import accepts, is_lost
from aionode.clock import MachineTime
from aionode.errors import escaped
from aionode.system._control_codes import has_codes, without_codes

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

__all__ = ["SystemLog"]

LAST_LINES: Final = 20
"""Number of a member's lines shown when it has failed."""

KEPT_BYTES: Final = 16_384
"""Bytes kept of a member's last lines."""

MAX_LINE: Final = 65_536
"""Maximum bytes of an unfinished line that the log holds back."""

PIECE: Final = 4096
"""Bytes that a pipe accepts atomically: PIPE_BUF."""

MAX_PIECES: Final = 1024
"""Maximum pieces written at once: IOV_MAX."""

Buffer: TypeAlias = bytes | memoryview

COLORS: Final = (36, 33, 32, 35, 34, 96, 93, 92, 95, 94)


class SystemLog:
    """The merged output of a system: each line with its time and the name of its member.

    Nothing is dropped while the system runs: when the stream accepts no more, the members' output
    waits in their pipes. Output that nobody can read any more is dropped. Of terminal codes only
    colours pass, and a carriage return starts a new line.

    Args:
        stream: Where the lines are written; the current ``sys.stdout`` by default.
        json: Whether each line is a record with ``time``, ``name`` and ``text``.
        color: Whether names are coloured; by default on a terminal, unless ``NO_COLOR`` is set.
        folder: A folder for files, ``NAME.log`` for each member and ``system.log``; none by
            default. It is created if missing.
        max_bytes: The size at which a file is renamed to ``NAME.log.1``, in bytes.
        backups: How many renamed files are kept of each.

    Raises:
        OSError: the folder cannot be created.
    """

    def __init__(
        self,
        stream: TextIO | None = None,
        *,
        json: bool = False,
        color: bool | None = None,
        folder: str | os.PathLike[str] | None = None,
        max_bytes: int = 10_000_000,
        backups: int = 5,
    ) -> None:
        self._stream = sys.stdout if stream is None else stream
        self._descriptor = descriptor_of(self._stream)
        self._never_blocks = self._descriptor is not None and never_blocks(self._descriptor)
        self._json = json
        is_terminal = self._descriptor is not None and os.isatty(self._descriptor)
        self._color = (
            is_terminal and "NO_COLOR" not in os.environ and not json if color is None else color
        )
        self._files: dict[str, RotatingFile] = {}
        self._folder = None if folder is None else Path(folder)
        if self._folder is not None:
            self._folder.mkdir(parents=True, exist_ok=True)
        self._max_bytes, self._backups = max_bytes, backups
        self._clock = MachineTime()
        self._moment = ""  # time of the lines since the last flush, as in records
        self._date_and_time = self._time_only = b""  # the same as in files and on the stream
        self._lost_file = False
        self._width = len("system")
        self._colors: dict[str, int] = {}
        self._labels: dict[str, bytes] = {}
        self._unfinished: dict[tuple[str, int], bytes] = {}
        self._last: dict[str, bytearray] = {}
        self._new: list[Buffer] = []  # since the last flush
        self._unwritten = bytearray()  # what the stream has not accepted yet
        self.listeners: list[Callable[[Sequence[Buffer]], object]] = []

    def add_member(self, name: str) -> None:
        """Reserve a colour and width for a name, before its first line."""
        self._colors.setdefault(name, COLORS[len(self._colors) % len(COLORS)])
        self._width = max(self._width, len(name))
        self._labels.clear()

    def note(self, text: str) -> None:
        """Write one of the system's own lines."""
        self.write("system", f"{text}\n".encode())
        self.flush()

    def write(self, name: str, output: bytes, stream: int = 1) -> None:
        """Add a member's output; an unfinished line waits for its end.

        It goes to the log's stream at the next `flush`.

        Args:
            name: The member.
            output: Its output.
            stream: 2 for standard error, if known; a line belongs to one stream.
        """
        key = name, stream
        before = self._unfinished.pop(key, b"")
        end = output.rfind(b"\n") + 1
        if len(output) - end + (0 if end else len(before)) > MAX_LINE:
            output += b"\n"
            end = len(output)
        if not end:
            before += output
        elif end < len(output):
            self._unfinished[key] = output[end:]
        if end:
            self._write_lines(name, before, output, end)
        elif before:
            self._unfinished[key] = before

    def end_line(self, name: str, stream: int = 1) -> None:
        """Write an unfinished line whose end will not come."""
        if rest := self._unfinished.pop((name, stream), b""):
            self._write_lines(name, rest, b"\n", 1)

    def last_lines(self, name: str) -> list[str]:
        """Return the last lines of a member, at most 20."""
        begun = [self._unfinished.get((name, stream), b"") for stream in (1, 2)]
        text = self._last.get(name, b"") + b"\n".join(filter(None, begun))
        return text.decode(errors="replace").splitlines()[-LAST_LINES:]

    def _write_lines(self, name: str, before: bytes, output: bytes, end: int) -> None:
        """Write the lines of `before` and of `output` up to `end`, the end of a line."""
        if has_codes(before) or has_codes(output):
            output = without_codes(before + output[:end])
            before, end = b"", len(output)
        last = self._last.setdefault(name, bytearray())
        last += before
        last += output[max(0, end - KEPT_BYTES) : end]
        if len(last) > 2 * KEPT_BYTES:
            del last[:-KEPT_BYTES]
        if not self._moment:
            self._look_at_the_clock()
        # The file first, so that its text is freed before that for the stream is created, and
        # malloc does not return memory to the system after each piece of a large output.
        if self._folder is not None:
            self._write_file(name, prefixed(self._date_and_time, before, output, end))
        if self._json:
            self._new.append(records(self._moment, name, before + output[:end]))
        else:
            label = self._labels.get(name) or self._label(name)
            self._new += prefixed(self._time_only + label, before, output, end)

    def _look_at_the_clock(self) -> None:
        """Update the time of all lines until the next flush."""
        moment = datetime.fromtimestamp(self._clock.system_ns() / 1e9)  # noqa: DTZ006  # of here
        self._moment = moment.astimezone().isoformat(timespec="milliseconds")
        self._date_and_time = f"{moment.isoformat(' ', 'milliseconds')} ".encode()
        self._time_only = self._date_and_time[len("2026-11-23 ") :]

    def _label(self, name: str) -> bytes:
        shown = escaped(name).replace(
            "\n", "\\n"
        )  # the name may come from someone else's launch file
        label = f"{shown:>{self._width}} |"
        if self._color:
            label = f"\x1b[{self._colors.get(name, 1)}m{label}\x1b[0m"
        self._labels[name] = encoded = f"{label} ".encode()
        return encoded

    def _write_file(self, name: str, lines: Sequence[Buffer]) -> None:
        try:
            file = self._files.get(name) or self._open_file(name)
            file.write(lines)
        except OSError as error:  # such as a full disk; the system and its log go on
            if not self._lost_file:
                self._lost_file = True
                self.note(f"files of the log are incomplete from here on: {error}")

    def flush(self) -> bool:
        """Write what the stream accepts without blocking; return whether that was everything."""
        new, self._new, self._moment = self._new, [], ""
        for listener in self.listeners if new else ():
            listener(new)
        descriptor = self._descriptor
        if descriptor is None:
            self._stream.write(b"".join(new).decode(errors="replace"))
            return True
        if self._never_blocks and not self._unwritten:
            new = unwritten(descriptor, new)
        for lines in new:
            self._unwritten += lines
        while self._unwritten:
            if not self._never_blocks and not accepts(descriptor):
                return False
            piece = self._unwritten if self._never_blocks else self._unwritten[:PIECE]
            try:
                written = os.write(descriptor, piece)
            except BlockingIOError:
                return False
            except OSError:
                if not is_lost(descriptor) and not self._never_blocks:
                    raise
                written = len(self._unwritten)  # nobody can read it any more, or the disk is full
            del self._unwritten[:written]
        return True

    def _open_file(self, name: str) -> RotatingFile:
        assert self._folder is not None  # noqa: S101  # checked by the caller
        path = self._folder / f"{name.strip('/').replace('/', '.')}.log"
        self._files[name] = file = RotatingFile(path, self._max_bytes, self._backups)
        return file

    def close(self) -> None:
        """Write the rest, as far as the stream accepts it, and close the files."""
        for name, stream in list(self._unfinished):
            self.end_line(name, stream)
        self.flush()
        for file in self._files.values():
            file.close()
        self._files.clear()


def descriptor_of(stream: TextIO) -> int | None:
    """Return the descriptor of a stream; None if it has none, such as io.StringIO."""
    try:
        stream.flush()
        return stream.fileno()
    except (io.UnsupportedOperation, AttributeError, ValueError):
        return None


def never_blocks(descriptor: int) -> bool:
    """Return whether writes never wait for a reader, as for a file or the null device."""
    mode = os.fstat(descriptor).st_mode
    return stat.S_ISREG(mode) or (stat.S_ISCHR(mode) and not os.isatty(descriptor))


def prefixed(prefix: bytes, before: bytes, output: bytes, end: int) -> tuple[Buffer, Buffer]:
    """Return the lines of `before` and of `output` up to `end`, each with a prefix.

    A single C call without further copies, as programs may log a lot.
    """
    text = output.replace(b"\n", b"\n" + prefix)
    return prefix + before, memoryview(text)[: len(text) - len(prefix) - (len(output) - end)]


def unwritten(descriptor: int, lines: list[Buffer]) -> list[Buffer]:
    """Write to a descriptor that never blocks; return what was not accepted."""
    while lines:
        some = lines[:MAX_PIECES]
        try:
            written = os.writev(descriptor, some)
        except OSError:
            return lines
        if written < sum(map(len, some)):
            return [memoryview(b"".join(lines))[written:]]
        lines = lines[MAX_PIECES:]
    return lines


def records(time: str, name: str, lines: bytes) -> bytes:
    """Format lines as JSON records."""
    encode = msgspec.json.encode
    return b"".join(
        encode({"time": time, "name": name, "text": line.decode(errors="replace")}) + b"\n"
        for line in lines.removesuffix(b"\n").split(b"\n")
    )


class RotatingFile:
    """A file that is renamed to ``.1`` when full, with ``.1`` renamed to ``.2`` and so on.

    Args:
        path: The file; existing content is kept.
        max_bytes: The size at which it is full.
        backups: How many renamed files are kept.
    """

    def __init__(self, path: Path, max_bytes: int, backups: int) -> None:
        self._path, self._max_bytes, self._backups = path, max_bytes, backups
        self._file = path.open("ab", buffering=0)
        self._size = self._file.tell()

    def write(self, lines: Sequence[Buffer]) -> None:
        """Append whole lines.

        Raises:
            OSError: it cannot be written.
        """
        if self._size and self._size + sum(map(len, lines)) > self._max_bytes:
            self._rotate()
        self._size += os.writev(self._file.fileno(), lines)

    def _rotate(self) -> None:
        self._file.close()
        for number in range(self._backups, 0, -1):
            older = self._path.with_name(f"{self._path.name}.{number}")
            newer = self._path.with_name(f"{self._path.name}.{number - 1}") if number > 1 else None
            source = self._path if newer is None else newer
            if source.exists():
                source.replace(older)
        if not self._backups:
            self._path.unlink()
        self._file = self._path.open("ab", buffering=0)
        self._size = 0

    def close(self) -> None:
        """Close the file."""
        self._file.close()
