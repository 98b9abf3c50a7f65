"""The faults that strike the processes of a case; each returns when the fault is over."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Awaitable, Callable, Iterable

from tests.faults.harness import Stage
from tests.faults.roles import Role

__all__ = [
    "Fault",
    "all_of",
    "arrive",
    "end_and_replace",
    "end_beside_frozen",
    "freeze",
    "freeze_idle",
    "replace",
    "wait",
]

Fault = Callable[[Stage], Awaitable[None]]


def wait(seconds: float) -> Fault:
    """Wait: the fault is part of a role."""

    async def strike(stage: Stage) -> None:
        await asyncio.sleep(seconds)

    return strike


def freeze(names: Iterable[str], seconds: float) -> Fault:
    """Suspend some processes for some time, like a debugger or a closed laptop."""

    async def strike(stage: Stage) -> None:
        for name in names:
            stage.children[name].send(signal.SIGSTOP)
        await asyncio.sleep(seconds)
        for name in names:
            stage.children[name].send(signal.SIGCONT)

    return strike


def end_beside_frozen(name: str, frozen: Iterable[str], seconds: float) -> Fault:
    """End a process with SIGTERM after others have been frozen for some time."""

    async def strike(stage: Stage) -> None:
        for each in frozen:
            stage.children[each].send(signal.SIGSTOP)
        await asyncio.sleep(seconds)
        await stage.children[name].end()
        for each in frozen:
            stage.children[each].send(signal.SIGCONT)

    return strike


def freeze_idle(name: str, talker: str, seconds: float, *, idle_s: float) -> Fault:
    """Suspend a process that has received everything, while its publisher is idle."""

    async def strike(stage: Stage) -> None:
        stage.children[talker].tell("pause")
        await asyncio.sleep(1.0)  # everything arrives
        stage.children[name].send(signal.SIGSTOP)
        await asyncio.sleep(idle_s)
        stage.children[talker].tell("go on")
        await asyncio.sleep(seconds - idle_s)
        stage.children[name].send(signal.SIGCONT)

    return strike


def replace(name: str, *, after_s: float = 0.5, number: int = signal.SIGKILL) -> Fault:
    """Kill a process and restart it a moment later; over when the new one runs."""

    async def strike(stage: Stage) -> None:
        stage.children[name].send(number)
        await stage.children[name].until_ended()
        await asyncio.sleep(after_s)
        await stage.start(stage.role(name))
        await until_ready(stage, name)

    return strike


def arrive(roles: Iterable[Role]) -> Fault:
    """Start processes at the same time; over when the node of the last one runs."""

    async def strike(stage: Stage) -> None:
        for role in roles:
            await stage.start(role)
        for role in roles:
            await until_ready(stage, role.name, limit_s=60.0)

    return strike


def end_and_replace(name: str, times: int) -> Fault:
    """End a process cleanly and restart it, several times."""
    return all_of(*[replace(name, after_s=0.0, number=signal.SIGTERM)] * times)


def all_of(*faults: Fault) -> Fault:
    """Apply several faults, one after another."""

    async def strike(stage: Stage) -> None:
        for fault in faults:
            await fault(stage)

    return strike


async def until_ready(stage: Stage, name: str, limit_s: float = 20.0) -> None:
    """Wait until the node of a process runs."""
    async with asyncio.timeout(limit_s):
        while not stage.children[name].last.ready:  # noqa: ASYNC110 - it is what a process reports
            await asyncio.sleep(0.01)
