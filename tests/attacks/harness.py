"""Runs attacks during legitimate traffic, in the harness of the fault cases, and judges them.

The attacker is another process of the case. Besides the victims' own reports, their memory is
measured from outside, and their logs are read.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import secrets
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from pathlib import Path

import msgspec
import trustme

from tests.attacks.programs import FORGED
from tests.end_to_end.process import Process
from tests.faults.faults import replace
from tests.faults.harness import ROOT, Case, Child, Outcome, Stage, run_case
from tests.faults.roles import Role, stream_key
from tests.support.peers import free_ports

__all__ = ["GAP_LIMIT_S", "MEMORY_LIMIT", "AccessControl", "Attack", "Found"]

GAP_LIMIT_S = 0.2
"""How long a loop may stand still by itself."""

MEMORY_LIMIT = 1.5
"""How many times as much memory as before a victim may take."""

BEGIN_LIMIT_S = 20.0
"""How long an attacker may take to begin."""

END_LIMIT_S = 30.0
"""How much longer than it is to last an attack may take."""

BARE_LONGER_S = 5.0
"""How much longer than the attack a session without aionode is there, to see its end."""

COMMAND_LIMIT_S = 20.0
"""How long a command may take beside an attack."""

SETTLE_S = 1.0
"""How long an attack has been running before a command starts."""

CONTROLS = re.compile(
    r"[\x00-\x08\x0b\x0c\x0e-\x1a\x1c-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]"
    r"|\x1b(?!\[[0-9;]*m)|\r(?!\n)"
)
"""Characters that aionode never prints: control characters, except for colours, and bidi signs."""

LOG_LINE = re.compile(r"\[(?:WARN|ERROR|FATAL)\].*|.*Traceback.*|.*panicked.*")

CONFIGS = ROOT / "examples" / "security"


class Found(msgspec.Struct):
    """The outcome of one attack.

    Attributes:
        outcome: The reports of the processes.
        tries: The number of attempts.
        memory_before_bytes: The memory, before the attack, of the victim that grew most.
        memory_most_bytes: Its peak since.
        bare: How a session without aionode fared, in words.
        bare_bytes: How much that session grew by the attack; 0 if there is none.
        said: The lines that the victims logged since.
        problems: What else went wrong, such as a forged message that was received.
    """

    outcome: Outcome
    tries: int = 0
    memory_before_bytes: int = 1
    memory_most_bytes: int = 1
    bare: str = ""
    bare_bytes: int = 0
    said: list[str] = []
    problems: list[str] = []

    @property
    def own_growth(self) -> float:
        """The factor by which its memory grew, without Zenoh's own growth."""
        return (self.memory_most_bytes - self.bare_bytes) / self.memory_before_bytes

    def broken(
        self, gap_limit_s: float = GAP_LIMIT_S, memory_limit: float = MEMORY_LIMIT
    ) -> list[str]:
        """Return why the attack succeeded; empty if it was repelled."""
        outcome = self.outcome
        untold = outcome.lost - outcome.told
        grown = self.memory_most_bytes / self.memory_before_bytes
        is_held = self.own_growth <= memory_limit
        told = [
            (untold > 0, f"{untold} of {outcome.sent} true messages lost untold"),
            (outcome.doubled > 0, f"{outcome.doubled} true messages doubled"),
            (
                outcome.own_gap_s > gap_limit_s + outcome.control_own_gap_s,
                f"a loop stood still for {1000 * outcome.own_gap_s:.0f} ms",
            ),
            (not is_held, f"{grown:.1f} times the memory"),
        ]
        hung = [f"never again: {', '.join(outcome.hung)}"] if outcome.hung else []
        found = [*self.problems, *(text for is_so, text in told if is_so), *hung]
        return [*found, self.bare] if found and self.bare else found


class Attack(msgspec.Struct, frozen=True):
    """An attack and its victims.

    Attributes:
        name: What happens, for the table.
        who: Who attacks: ``outsider``, ``other user``, ``client``, ``visitor`` or
            ``member``.
        program: The attacker: a name of `programs.PROGRAMS`.
        roles: The victims, and who talks with them.
        seconds: How long it lasts.
        item: The promise of docs/security.md that it tests.
        commands: Arguments of ``aionode``, run beside it; they end, and print no control character.
        longer_s: How much longer than without the attack they may take.
        replaced: A victim that ends and is replaced meanwhile.
        bare: Whether there is a Zenoh session without aionode for comparison.
        short: Whether it is part of the ordinary tests.
        around: What has to exist before its processes start.
        env: The attacker's environment variables.
        hurt: The victims whose own loops it blocks.
    """

    name: str
    who: str
    program: str
    roles: tuple[Role, ...]
    seconds: float = 4.0
    commands: tuple[tuple[str, ...], ...] = ()
    longer_s: float = 1.5
    replaced: str = ""
    short: bool = False
    bare: bool = False
    around: contextlib.AbstractContextManager[None] = contextlib.nullcontext()
    env: dict[str, str] = {}
    hurt: tuple[str, ...] = ()

    @property
    def lasts_s(self) -> float:
        """About how long it takes."""
        return self.seconds

    async def run(self, busy: asyncio.Semaphore) -> Sequence[tuple[Attack, Found | Exception]]:
        """Run once."""
        strike = Strike(self)
        case = Case(self.name, self.roles, strike, self.hurt, around=self.around)
        try:
            outcome = await run_case(case, busy)
        except Exception as error:  # noqa: BLE001 - it is told
            return [(self, error)]
        strike.found.outcome = outcome
        return [(self, strike.found)]


class Strike:
    """One run of an attack, from the beginning of its process to the end."""

    def __init__(self, attack: Attack) -> None:
        self._attack = attack
        self.found = Found(Outcome())

    async def __call__(self, stage: Stage) -> None:
        """Attack and measure."""
        attack = self._attack
        victims = [child for child in stage.children.values() if not child.role.control]
        before_s = [await self._command(stage, command) for command in attack.commands]
        memory = {child.pid: memory_of(child.pid) for child in victims}
        for pid in memory:
            reset_peak(pid)
        outputs = {child.role.name: len(child.whole_output()) for child in victims}

        if attack.bare:
            words = ("-m", "tests.attacks.bare", str(attack.seconds + BARE_LONGER_S))
            bare = await self._begin(stage, Role("bare", command=words, env=attack.env))
        attacker = await self._begin(stage, self._attacker([str(pid) for pid in memory]))
        await self._run_commands(stage, before_s)
        if attack.replaced:
            await asyncio.sleep(SETTLE_S)
            await replace(attack.replaced, number=signal.SIGTERM)(stage)
        async with asyncio.timeout(attack.seconds + END_LIMIT_S):
            status = await attacker.until_ended()
        tries = re.search(r"^tries (\d+)$", attacker.whole_output(), re.MULTILINE)
        if status or tries is None:
            raise RuntimeError(f"the attacker failed: {attacker.output()}")
        self.found.tries = int(tries[1])
        if attack.bare:
            async with asyncio.timeout(BARE_LONGER_S + END_LIMIT_S):
                await bare.until_ended()
            if told := re.search(r"^bare (\d+) (\d+) (\d+)$", bare.whole_output(), re.MULTILINE):
                gap_ms, before, most = map(int, told.groups())
                self.found.bare_bytes = most - before
                self.found.bare = (
                    f"Zenoh without aionode beside it: {gap_ms} ms, {most / before:.2f} times the "
                    "memory"
                )

        grown = [(memory[pid], peak_of(pid)) for pid in memory if Path(f"/proc/{pid}").exists()]
        both = max(grown, key=lambda each: each[1] / each[0])
        self.found.memory_before_bytes, self.found.memory_most_bytes = both
        for child in victims:
            self._judge(child.role.name, child.whole_output()[outputs[child.role.name] :])
            forged = stream_key("/chatter", FORGED, 0)
            if number := child.last.heard.get(forged):
                self.found.problems.append(
                    f"{child.role.name} heard {count(number)} forged messages"
                )

    async def _run_commands(self, stage: Stage, before_s: Sequence[float]) -> None:
        """Run the commands during the attack; each may take somewhat longer than without it."""
        attack = self._attack
        await asyncio.sleep(SETTLE_S * bool(attack.commands))
        for command, alone_s in zip(attack.commands, before_s, strict=True):
            took_s = await self._command(stage, command)
            if took_s > alone_s + attack.longer_s:
                self.found.problems.append(
                    f"aionode {' '.join(command)}: {took_s:.1f} s, alone {alone_s:.1f} s"
                )

    async def _begin(self, stage: Stage, role: Role) -> Child:
        """Start the attacker, or the session for comparison."""
        await stage.start(role)
        child = stage.children[role.name]
        async with asyncio.timeout(BEGIN_LIMIT_S):
            while "begun" not in child.whole_output() and child.runs:  # noqa: ASYNC110 - a process writes it
                await asyncio.sleep(0.05)
        return child

    def _attacker(self, pids: Sequence[str]) -> Role:
        attack = self._attack
        words = ("-m", "tests.attacks.programs", attack.program, str(attack.seconds), *pids)
        return Role("attacker", command=words, env=attack.env)

    def _judge(self, name: str, output: str) -> None:
        """Record what a process has logged."""
        self.found.said += LOG_LINE.findall(output)
        if found := CONTROLS.search(output):
            self.found.problems.append(f"{name} printed {found[0]!r}")

    async def _command(self, stage: Stage, command: Sequence[str]) -> float:
        """Run a command, and return how long it took."""
        env = {**os.environ, "PYTHONPATH": str(ROOT), **stage.env, **self._attack.roles[0].env}
        began_s = time.monotonic()
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "aionode", *command),
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.STDOUT,
            env=env,
        )
        try:
            async with asyncio.timeout(COMMAND_LIMIT_S):
                output, _ = await process.communicate()
        except TimeoutError:
            process.kill()
            await process.wait()
            self.found.problems.append(f"aionode {' '.join(command)} did not end")
        else:
            self._judge(f"aionode {' '.join(command)}", output.decode(errors="replace"))
        return time.monotonic() - began_s


def count(ranges: Iterable[tuple[int, int]]) -> int:
    """Return how many numbers are in ranges."""
    return sum(last - first + 1 for first, last in ranges)


def status_of(pid: int, name: str) -> int:
    """Return a line of /proc/PID/status in bytes."""
    text = Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    return int(re.findall(rf"^{name}:\s+(\d+) kB", text, re.MULTILINE)[0]) * 1024


def memory_of(pid: int) -> int:
    """Return how much memory a process takes, in bytes."""
    return status_of(pid, "VmRSS")


def peak_of(pid: int) -> int:
    """Return its peak memory since `reset_peak`, in bytes."""
    return status_of(pid, "VmHWM")


def reset_peak(pid: int) -> None:
    """Reset the peak memory of a process."""
    with contextlib.suppress(OSError):  # a container may forbid it; then that is since its start
        Path(f"/proc/{pid}/clear_refs").write_text("5", encoding="ascii")


class AccessControl:
    """A router with the rules of the how-to, and a visitor that may publish /scan.

    Attributes:
        robot: The environment variables of the robot's nodes.
        visitor: Those of a visitor.
    """

    def __init__(self) -> None:
        self._stack = contextlib.ExitStack()
        # Its path is in the environment of the nodes before it is there.
        self._folder = Path(tempfile.gettempdir()) / f"attacks-{secrets.token_hex(8)}"
        (self._port,) = free_ports(1)
        self.robot, self.visitor = map(self._env, ("robot", "visitor"))

    def _env(self, name: str) -> dict[str, str]:
        path = self._folder / f"{name}.json5"
        return {"ZENOH_SESSION_CONFIG_URI": str(path), "AIONODE_LINK": "off"}

    def __enter__(self) -> None:
        self._folder.mkdir(mode=0o700)
        self._stack.callback(shutil.rmtree, self._folder)
        authority = trustme.CA()
        authority.cert_pem.write_to_path(self._folder / "ca.pem")
        session = (CONFIGS / "session.json5").read_text(encoding="utf-8")
        session = session.replace("router.local:7448", f"localhost:{self._port}")
        for name in ("router", "robot", "visitor"):
            made = authority.issue_cert("localhost", common_name=name)
            made.private_key_pem.write_to_path(self._folder / f"{name}-key.pem")
            made.cert_chain_pems[0].write_to_path(self._folder / f"{name}.pem")
            text = session.replace("certs/robot", f"certs/{name}")
            (self._folder / f"{name}.json5").write_text(
                text.replace("certs/", f"{self._folder}/"), encoding="utf-8"
            )
        rules = (CONFIGS / "router.txt").read_text(encoding="utf-8")
        words = ("-m", "aionode", "router", "--listen", f"tls/localhost:{self._port}")
        env = {"ZENOH_CONFIG_OVERRIDE": rules.replace("certs/", f"{self._folder}/")}
        self._stack.enter_context(Process(*words, env=env)).expect("Router is listening")

    def __exit__(self, *_: object) -> None:
        self._stack.close()
