"""Compares aionode's transforms with tf2's own core, compiled from its sources, on random trees.

``make tf-differential TF2=<a copy of github.com/ros2/geometry2>``: the library is compiled with
small stand-ins for the headers that it includes from elsewhere. Quaternions that are far from
length 1 are left out: aionode refuses them, as tf2 says, but tf2 divides them by their length
before it looks. Sources from before pull request 896 name another edge in some errors of
extrapolation. Each case is a random tree with a random history, and random questions about it, some
of them wrong.
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from math import isclose, sqrt
from pathlib import Path
from typing import Any

from aionode.clock import Duration, Time
from aionode.errors import TransformException
from aionode.tf import BufferCore
from tests.support.transforms import parts, transform

HERE = Path(__file__).parent
SOURCES = ("buffer_core.cpp", "cache.cpp", "static_cache.cpp", "time.cpp")
TOLERANCE = 1e-9
KINDS = [
    *["lookup"] * 3, "full", "can", "velocity", "latest", "chain", "yaml", "string", "dot",
]  # fmt: skip
QUESTIONS = 12
"""How many questions are asked about each tree."""


def compiled(source: Path, folder: Path) -> Path:
    """Compile the oracle; return the program."""
    program = folder / "oracle"
    include = [f"-I{HERE / 'stubs'}", f"-I{source / 'tf2' / 'include'}"]
    files = [str(source / "tf2" / "src" / name) for name in SOURCES]
    command = ["g++", "-std=c++17", "-O1", "-w", *include, str(HERE / "oracle.cpp"), *files]
    subprocess.run([*command, "-o", str(program)], check=True)
    return program


class Case:
    """One random tree: what the oracle is told, and what is done here."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)  # noqa: S311  # no secret
        self.core = BufferCore()
        self.logged: list[str] = []
        self.core._BufferCore__report = self._note  # type: ignore[method-assign]
        self.frames = [f"f{number}" for number in range(self.chance.randint(2, 9))]
        self.commands = ["new"]
        self.answers: list[Callable[[], str]] = [lambda: "new"]

    def _note(self, kind: str, about: str, text: str, *, is_error: bool = False) -> None:
        self.logged.append(f"{text}\n")

    def ask(self, command: str, answer: Callable[[], str]) -> None:
        """Add a command for the oracle, and what answers it here."""
        self.commands.append(command)
        self.answers.append(answer)

    def build(self) -> None:
        """Insert a history, mostly of a tree, and ask about it."""
        chance = self.chance
        parents = {f: chance.choice(self.frames[:n]) for n, f in enumerate(self.frames) if n}
        static = {frame for frame in parents if chance.random() < 0.2}
        for _ in range(chance.randint(1, 40)):
            child = chance.choice(self.frames)
            parent = parents.get(child, child)
            if chance.random() < 0.03:
                child, parent = (
                    chance.choice(self.frames),
                    chance.choice([*self.frames, "/f0", "-"]),
                )
            if child != parent or chance.random() < 0.05:
                self.insert(parent, child, child in static)
        for _ in range(QUESTIONS):
            self.question()

    def insert(self, parent: str, child: str, is_static: bool) -> None:
        """Insert one transform."""
        chance = self.chance
        stamp_ns = chance.choice([chance.randint(0, 10**10), chance.randint(1, 15) * 10**9])
        place = [chance.uniform(-10, 10) for _ in range(3)]
        turn = [chance.gauss(0, 1) for _ in range(4)]
        length = sqrt(sum(part * part for part in turn))
        off = chance.choice([1.0, 1.0, 1.0, 1.004, 0.996])
        rotation = [part / length * off for part in turn]
        sec, nanosec = divmod(stamp_ns, 10**9)
        numbers = " ".join(repr(number) for number in (*place, *rotation))
        msg = transform(parent.replace("-", ""), child.replace("-", ""))
        moved, turned = msg.transform.translation, msg.transform.rotation
        moved.x, moved.y, moved.z = place
        turned.x, turned.y, turned.z, turned.w = rotation
        msg.header.stamp.sec, msg.header.stamp.nanosec = sec, nanosec

        def answer() -> str:
            self.logged.clear()
            taken = self.core._BufferCore__set(msg, "me", is_static=is_static)
            return f"set {int(taken)} {quoted(''.join(self.logged))}"

        self.ask(f"set {int(is_static)} {parent} {child} {sec} {nanosec} {numbers} me", answer)

    def question(self) -> None:
        """Ask one question."""
        chance, core = self.chance, self.core
        names = [*self.frames, *self.frames, "x", "/f1", "-"]
        a, b, c, d = (
            chance.choice(names if chance.random() < 0.2 else self.frames) for _ in "abcd"
        )
        s, t = self.time(), self.time()
        one, other, third, fourth = (name.replace("-", "") for name in (a, b, c, d))
        at_s, at_t = Time(nanoseconds=s), Time(nanoseconds=t)
        interval = chance.choice([10**8, 10**9, 3 * 10**9])
        if chance.random() < 0.02:
            self.ask("clear", self.clear)
        kind = chance.choice(KINDS)
        questions: dict[str, tuple[str, Callable[[], str]]] = {
            "lookup": (
                f"{a} {b} {t}",
                lambda: stamped(core.lookup_transform_core(one, other, at_t)),
            ),
            "full": (
                f"{a} {t} {b} {s} {c}",
                lambda: stamped(core.lookup_transform_full_core(one, at_t, other, at_s, third)),
            ),
            "can": (f"{a} {b} {t}", lambda: can(core.can_transform_core(one, other, at_t))),
            "velocity": (
                f"{a} {b} {c} 0.5 -1 2 {d} {t} {interval}",
                lambda: numbers_of(
                    core.lookupVelocityFullCore(
                        one, other, third, (0.5, -1.0, 2.0), fourth, at_t,
                        Duration(nanoseconds=interval),
                    )
                ),
            ),
            "latest": (
                f"{a} {b}",
                lambda: f"latest {core.get_latest_common_time(one, other).nanoseconds}",
            ),
            "chain": (
                f"{a} {t} {b} {s} {c}",
                lambda: " ".join(["chain", *core._chain(one, at_t, other, at_s, third)]),
            ),
            "yaml": ("", lambda: f"text {quoted(core.all_frames_as_yaml())}"),
            "string": ("", lambda: f"text {quoted(core.all_frames_as_string())}"),
            "dot": (f"{t}", lambda: f"text {quoted(core._allFramesAsDot(at_t))}"),
        }  # fmt: skip
        if kind == "chain" and not {one, other, third} <= set(
            core._BufferCore__frames.names or [one]
        ):
            return  # tf2 does not check these names
        arguments, answer = questions[kind]
        self.ask(f"{kind} {arguments}", answer)

    def clear(self) -> str:
        """Forget all history."""
        self.core.clear()
        return "cleared"

    def time(self) -> int:
        """Return a time to ask for, in nanoseconds."""
        chance = self.chance
        return chance.choice([0, chance.randint(1, 11 * 10**9), chance.randint(1, 15) * 10**9])


def quoted(text: str) -> str:
    """Return a text in one line."""
    return text.replace("\\", "\\\\").replace("\n", "\\n")


def stamped(found: Any) -> str:
    """Return a transform as the oracle prints it."""
    stamp = found.header.stamp
    numbers = " ".join(repr(part) for part in parts(found))
    return f"ok {numbers} {stamp.sec * 10**9 + stamp.nanosec}"


def can(found: tuple[bool, str]) -> str:
    """Return whether there is a transform as the oracle prints it."""
    return f"can {int(found[0])} {quoted(found[1])}"


def numbers_of(found: Any) -> str:
    """Return a velocity as the oracle prints it."""
    return " ".join(["velocity", *(repr(part) for vector in found for part in vector)])


def result(answer: Callable[[], str]) -> str:
    """Return an answer, or the error."""
    try:
        return answer()
    except TransformException as error:
        return f"error {type(error).__name__} {quoted(str(error))}"


def agree(mine: str, theirs: str) -> bool:
    """Return whether two answers are equal, numbers within the tolerance.

    The sign of a quaternion may differ where tf2's rule for it depends on the last digit.
    """
    if mine.rstrip() == theirs.rstrip():
        return True
    ours, others = mine.split(), theirs.split()
    kind = ours[0]
    if kind == "velocity" and not any(float(part) for part in ours[1:]):
        return all(abs(float(part)) < 0.1 for part in others[1:])  # tf2's rounding over 10 us
    if kind != others[0] or kind not in {"ok", "velocity"} or len(ours) != len(others):
        return False
    pairs = [(float(a), float(b)) for a, b in zip(ours[1:], others[1:], strict=True)]
    scale = max(1.0, *(abs(b) for _, b in pairs[:7]))
    close = [isclose(a, b, abs_tol=TOLERANCE * scale) for a, b in pairs]
    turned = [isclose(-a, b, abs_tol=TOLERANCE) for a, b in pairs[3:7]]
    return all(close) or (kind == "ok" and all(close[:3]) and all(turned) and close[7])


def cases(count: int, first: int = 0) -> Iterator[Case]:
    """Yield random cases."""
    for seed in range(first, first + count):
        case = Case(seed)
        case.build()
        yield case


def main(source: str, count: str = "10000") -> int:
    """Compare; print the differences and a summary."""
    with tempfile.TemporaryDirectory() as folder:
        program = compiled(Path(source), Path(folder))
        made = list(cases(int(count)))
        told = "\n".join(command for case in made for command in case.commands) + "\n"
        run = subprocess.run([program], input=told, capture_output=True, text=True, check=True)
    theirs = iter(run.stdout.splitlines())
    asked = different = 0
    kinds: dict[str, int] = {}
    for number, case in enumerate(made):
        for command, answer in zip(case.commands, case.answers, strict=True):
            mine, other = result(answer), next(theirs)
            asked += 1
            kinds[other.split()[0]] = kinds.get(other.split()[0], 0) + 1
            if not agree(mine, other):
                different += 1
                if different <= 20:
                    print(f"case {number}: {command}\n  aionode {mine}\n  tf2     {other}")
    print(f"{len(made)} cases, {asked} commands, {different} different answers; {kinds}")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
