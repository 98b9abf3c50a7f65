"""aionode and its peers in one table: the other ways to pass messages between Python programs.

Each peer has two processes, and all peers take turns in each column, so that other load affects
them alike. The table shows the median of the rounds, and the picture its ratio to aionode's link. A
peer whose modules are not installed is skipped with its reason, as are features that a peer does
not have, such as service calls.

- Round trip: 23 characters to the other process and back, as fast as it goes ("tight"), and with
  10 ms of rest before each ("100 Hz"). In process: one hop there and one back.
- Burst: 10 000 messages sent in one go, into one callback; messages a second from the first that
  arrives to the last.
- Calls: service calls a second, one after the other.
- 1 MB and 4 MB: a block of so many bytes there, and a small message back, in ms.
- 100 Hz: processor time of all threads in percent of one core, of a process with a timer that
  sends 100 messages a second, and of the one that receives them.
- First message: from the exec of a process to the first message of one that is sending already.
- Import: from the exec of Python to its end with the modules that a program imports, less an empty
  program.

rclpy is imported by this Python, or by the one that AIONODE_BENCH_RCLPY names.

Run it with ``python benchmarks/peers.py``; it takes about five minutes, ``--quick`` two. It prints
the table, writes ``peers.json`` and ``peers.png`` to ``benchmarks/results/``, and with
``--write docs/performance.md`` brings the page, and the picture beside it, up to date.
"""

from __future__ import annotations

import argparse
import datetime as dt
import json
import os
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

sys.path.insert(0, str(Path(__file__).parents[1]))  # run as a program, it finds its own parts

from benchmarks.peer_parts.peers import MODULES, PEERS
from benchmarks.peer_parts.stations import BURST, station

RESULTS: Final = Path(__file__).parent / "results"
BEGIN: Final = "<!-- peers: made by benchmarks/peers.py -->\n"
END: Final = "<!-- end of peers -->\n"
OURS: Final = "aionode, link"
LIMIT_S: Final = 30.0
DUTY_S: Final = 1.5
BLOCKS: Final = 5  # round trips of blocks in a round
COLUMNS: Final = {
    "tight": "tight, µs",
    "paced": "100 Hz, µs",
    "burst": "burst, 1/s",
    "calls": "calls, 1/s",
    "mb1": "1 MB, ms",
    "mb4": "4 MB, ms",
    "sender": "sends, %",
    "receiver": "receives, %",
    "first": "first, ms",
    "import": "import, ms",
}
DIGITS: Final = {"burst": 0, "calls": 0, "tight": 0, "paced": 0, "first": 0, "import": 0}
MORE_IS_BETTER: Final = ("burst", "calls")


def python_of(name: str) -> str:
    """Return the interpreter for a peer."""
    return (
        os.environ.get("AIONODE_BENCH_RCLPY", sys.executable) if "rclpy" in name else sys.executable
    )


class SilentError(Exception):
    """A process has not answered, or has ended."""


class Process:
    """One end of a peer."""

    def __init__(self, name: str, side: str, place: tuple[str, int], loop: str) -> None:
        self._process = subprocess.Popen(  # noqa: S603  # of this file
            [
                python_of(name), __file__, "--station", name, "--side", side,
                "--folder", place[0], "--port", str(place[1]), "--loop", loop,
            ],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        assert self._process.stdout is not None  # noqa: S101  # a pipe
        self._fd = self._process.stdout.fileno()
        os.set_blocking(self._fd, False)
        self._text = b""

    def answer(self, limit_s: float = LIMIT_S) -> Any:
        """Return the next line of JSON, ignoring other lines that a library prints."""
        ends = time.monotonic() + limit_s
        while time.monotonic() < ends:
            line, found, rest = self._text.partition(b"\n")
            if found:
                self._text = rest
                try:
                    return json.loads(line)
                except ValueError:
                    continue
            try:
                data = os.read(self._fd, 1 << 16)
            except BlockingIOError:
                time.sleep(0.0005)
                continue
            if not data:
                raise SilentError("a process ended too early")
            self._text += data
        raise SilentError(f"no answer within {limit_s:g} s")

    def ask(self, line: str) -> Any:
        """Return the answer to one question."""
        self.send(line)
        return self.answer()

    def send(self, line: str) -> None:
        """Send a question without waiting."""
        assert self._process.stdin is not None  # noqa: S101  # a pipe
        self._process.stdin.write(line.encode() + b"\n")
        self._process.stdin.flush()

    def used_s(self) -> float:
        """Return the processor time of all its threads, to the nanosecond."""
        tasks = Path(f"/proc/{self._process.pid}/task")
        return sum(int((one / "schedstat").read_text().split()[0]) for one in tasks.iterdir()) / 1e9

    def end(self) -> None:
        """End it."""
        self._process.kill()
        self._process.wait()


class Pair:
    """Both ends of a peer.

    Raises:
        SilentError: one of them cannot begin.
    """

    def __init__(self, name: str, place: tuple[str, int], loop: str) -> None:
        self.name = name
        self.place = place
        self.loop = loop
        self.processes: list[Process] = []
        self.alone = PEERS[name].alone
        try:
            if not self.alone:
                self._add("echo")
            self._add("both" if self.alone else "ping")
        except SilentError:
            self.end()
            raise
        self.ping = self.processes[-1]

    def _add(self, side: str) -> None:
        process = Process(self.name, side, self.place, self.loop)
        self.processes.append(process)
        ready = process.answer(20)
        if ready != "ready":
            raise SilentError(ready.removeprefix("skipped: "))

    def end(self) -> None:
        """End both."""
        for process in self.processes:
            process.end()

    def trips(self, count: int, pause_s: float, size: int = 0) -> float | None:
        """Return the median of round trips, in us, or in ms for blocks."""
        if size and self.alone:
            return None
        found: float | None = self.ping.ask(f"trips {count} {pause_s} {size}")
        return found if found is None or not size else found / 1e3

    def calls(self, count: int) -> float | None:
        """Return how many service calls per second are answered."""
        found: float | None = None if self.alone else self.ping.ask(f"calls {count}")
        return found

    def duty(self, seconds: float) -> tuple[float, float] | None:
        """Return the processor time of sender and receiver, in percent of a core."""
        if self.alone:
            return None
        before, began = [one.used_s() for one in self.processes], time.perf_counter()
        self.ping.ask(f"duty {seconds}")
        took = time.perf_counter() - began
        receiver, sender = (
            100 * (one.used_s() - was) / took
            for one, was in zip(self.processes, before, strict=True)
        )
        return sender, receiver

    def first_ms(self) -> float | None:
        """Return how long a new process takes to receive its first message."""
        if self.alone or self.name in (
            "bare Unix socket",
            "zenoh-python",
            "asyncio-for-robotics",
            "pyzmq",
        ):
            return None  # the other end has an address that it cannot have too
        self.ping.send("duty 5")
        began = time.perf_counter()
        hearer = Process(self.name, "hear", self.place, self.loop)
        try:
            hearer.answer(5)
            return (time.perf_counter() - began) * 1e3
        except SilentError:
            return None
        finally:
            hearer.end()
            self.ping.answer()


def import_ms(name: str) -> float:
    """Return how long the modules of a peer take to import."""

    def run_ms(program: str) -> float:
        began = time.perf_counter()
        command = [python_of(name), "-c", program]
        subprocess.run(command, check=True, capture_output=True)  # noqa: S603  # of this file
        return (time.perf_counter() - began) * 1e3

    runs = [(run_ms(f"import {MODULES[name]}"), run_ms("")) for _ in range(2)]
    return max(min(full for full, _ in runs) - min(empty for _, empty in runs), 0.0)


class Comparison:
    """All peers on one event loop, in turns.

    Attributes:
        found: The figures, by peer and column, one for each round.
        skipped: Why a peer, or a column of it, has none.
    """

    def __init__(self, loop: str, folder: str) -> None:
        self.found: dict[str, dict[str, list[float]]] = {}
        self.skipped: dict[str, str] = {}
        self._pairs: list[Pair] = []
        first_port = 19_000 + os.getpid() % 90 * 100
        for number, name in enumerate(PEERS):
            own = Path(folder) / str(number)
            own.mkdir()
            try:
                self._pairs.append(Pair(name, (str(own), first_port + number * 8), loop))
            except SilentError as reason:
                self.skipped[name] = str(reason)
            else:
                self.found[name] = {}

    def each(self, columns: str, measured: Callable[[Pair], Any]) -> None:
        """Measure one figure of each peer, or several, named in `columns`; None for nothing."""
        for pair in list(self._pairs):
            try:
                values = measured(pair)
            except subprocess.CalledProcessError as reason:
                self.skipped[f"{pair.name}: {columns}"] = str(reason)
                continue
            except (SilentError, OSError) as reason:  # it cannot continue
                self.skipped[f"{pair.name}: from {columns} on"] = str(reason)
                pair.end()
                self._pairs.remove(pair)
                continue
            if values is not None:
                values = values if isinstance(values, tuple) else (values,)
                for column, value in zip(columns.split(), values, strict=True):
                    self.found[pair.name].setdefault(column, []).append(value)

    def measure(self, rounds: int, count: int) -> None:
        """Measure everything."""
        self.each("warm", lambda pair: pair.trips(count, 0))
        for _ in range(rounds):
            self.each("tight", lambda pair: pair.trips(count, 0))
            self.each("paced", lambda pair: pair.trips(max(count // 10, 8), 0.01))
            self.each("calls", lambda pair: pair.calls(count))
            for column, size in (("mb1", 1_000_000), ("mb4", 4_000_000)):
                self.each(column, lambda pair, size=size: pair.trips(BLOCKS, 0, size))  # type: ignore[misc]  # size is bound now
            self.each("burst", lambda pair: pair.ping.ask("burst"))
            self.each("sender receiver", lambda pair: pair.duty(DUTY_S))
        self.each("first", Pair.first_ms)
        self.each("import", lambda pair: import_ms(pair.name))

    def medians(self) -> dict[str, dict[str, float]]:
        """Return the median of the rounds."""
        return {
            name: {column: statistics.median(values) for column, values in columns.items()}
            for name, columns in self.found.items()
        }

    def end(self) -> None:
        """End all processes."""
        for pair in self._pairs:
            pair.end()


def table(rows: dict[str, dict[str, float]]) -> str:
    """Return the figures of one loop as a table of Markdown."""

    def cell(row: dict[str, float], column: str) -> str:
        value = row.get(column)
        if value is None:
            return ""
        lost = " (some lost)" if value < 0 else ""
        return f"{abs(value):,.{DIGITS.get(column, 1)}f}{lost}"

    lines = [
        "| peer | " + " | ".join(COLUMNS.values()) + " |",
        "| --- |" + " ---: |" * len(COLUMNS),
    ]
    for name, row in rows.items():
        shown = f"**{name}**" if name == OURS else f"*{name}*" if "bare" in name else name
        lines.append(f"| {shown} | " + " | ".join(cell(row, column) for column in COLUMNS) + " |")
    return "\n".join(lines) + "\n"


def picture(tables: dict[str, dict[str, dict[str, float]]], path: Path) -> None:
    """Plot how much longer each peer takes than aionode's link, for round trips."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(1, len(tables), figsize=(6 * len(tables), 4.2), squeeze=False)
    for axis, (loop, rows) in zip(axes[0], tables.items(), strict=True):
        shown = [name for name, row in rows.items() if {"tight", "paced"} <= row.keys()][::-1]
        for shift, column, label in ((0.2, "tight", "tight"), (-0.2, "paced", "100 Hz")):
            ours = rows.get(OURS, {}).get(column, 1.0)
            values = [rows[name][column] / ours for name in shown]
            places = [number + shift for number in range(len(shown))]
            axis.barh(places, values, height=0.38, label=label)
        axis.axvline(1, color="black", linewidth=0.8)
        axis.set_yticks(range(len(shown)), shown)
        axis.set_xlabel("round trip, times that of aionode's link")
        axis.set_title(loop)
        axis.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def write(page: Path, text: str) -> None:
    """Write the tables into the page, between its two markers, and the picture beside it."""
    before, rest = page.read_text().split(BEGIN)
    page.write_text(f"{before}{BEGIN}\n{text}\n{END}{rest.split(END)[1]}")
    shutil.copy(RESULTS / "peers.png", page.parent / "peers.png")


def text_of(
    tables: dict[str, dict[str, dict[str, float]]], skipped: dict[str, str], how: str
) -> str:
    """Return the text for the page."""
    parts = [f"{how}\n", "![Round trips of each peer, times that of aionode's link](peers.png)\n"]
    for loop, rows in tables.items():
        parts += [f"On {loop}:\n", table(rows)]
    if skipped:
        parts.append("Not measured:\n")
        parts.append("\n".join(f"- {name}: {reason}" for name, reason in skipped.items()) + "\n")
    return "\n".join(parts)


def main() -> None:
    """Measure on both loops, print the tables and write the files."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    parser.add_argument("--loop", choices=["asyncio", "uvloop"], help="only this event loop")
    parser.add_argument("--write", type=Path, metavar="PAGE", help="bring a page up to date")
    for hidden in ("--station", "--side", "--folder"):
        parser.add_argument(hidden, default="", help=argparse.SUPPRESS)
    parser.add_argument("--port", type=int, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.station:
        station(args.station, args.side, (args.folder, args.port), args.loop)
        return
    rounds, count = (2, 100) if args.quick else (5, 400)
    tables, skipped = {}, {}
    for loop in [args.loop] if args.loop else ["asyncio", "uvloop"]:
        with tempfile.TemporaryDirectory(prefix="aio") as folder:
            comparison = Comparison(loop, folder)
            try:
                comparison.measure(rounds, count)
            except KeyboardInterrupt:  # results measured by then are shown
                comparison.skipped["the rest"] = "interrupted"
            finally:
                comparison.end()
        tables[loop] = comparison.medians()
        skipped.update({f"{name} ({loop})": why for name, why in comparison.skipped.items()})
        print(f"{loop}:\n{table(tables[loop])}")
    for name, reason in skipped.items():
        print(f"skipped: {name}: {reason}")
    how = (
        f"Measured on {dt.datetime.now(tz=dt.UTC):%d %B %Y} with "
        f"`benchmarks/peers.py{' --quick' if args.quick else ''}`: medians of {rounds} rounds, "
        f"Python {platform.python_version()}, {os.cpu_count()} cores, bursts of {BURST:,}, "
        f"load average {os.getloadavg()[0]:.1f} at the end."
    )
    RESULTS.mkdir(exist_ok=True)
    result = {"how": how, "tables": tables, "skipped": skipped}
    (RESULTS / "peers.json").write_text(json.dumps(result, indent=1) + "\n")
    try:
        picture(tables, RESULTS / "peers.png")
    except ImportError as error:
        print(f"no picture: {error}")
    if args.write:
        write(args.write, text_of(tables, skipped, how))


if __name__ == "__main__":
    main()
