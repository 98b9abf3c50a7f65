"""A whole system in a test, in its own domain."""

from __future__ import annotations

import contextlib
import inspect
import os
import runpy
import socket
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from aionode.engine.context import Context
from aionode.errors import ConfigurationError

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Awaitable, Callable, Iterator, Mapping

    from aionode.system import System

__all__ = ["system_under_test"]

DOMAINS: Final = range(102, 233)
"""The domains for tests; lower ones are for people, as their ports exist on every platform."""


@contextlib.asynccontextmanager
async def system_under_test(
    description: str | os.PathLike[str] | Callable[[System], Awaitable[object]],
    arguments: Mapping[str, str] | None = None,
) -> AsyncIterator[System]:
    """Start a system for a test, in its own domain, and yield it when it is ready.

    ::

        async with (
            system_under_test("robot.launch.py") as system,
            Node("test", context=system.context) as node,
        ):
            ...

    It is stopped at the end, and nothing of it is left. Its members' output goes to ``sys.stdout``,
    which pytest shows when the test fails.

    Args:
        description: A launch file of ROS 2, in Python, XML or YAML; or a file with
            ``async def main(system)``, or such a function, which adds the members.
        arguments: Values for the arguments of a launch file.

    Raises:
        LaunchFileError: the launch file cannot be evaluated; nothing was started (a ValueError).
        NotReadyError: a member is not ready; the text says what is missing, with the member's last
            lines (a TimeoutError).
        ConfigurationError: the file is neither a launch file nor has such a function (a
            ValueError).
        TypeError: `arguments` are given for something other than a launch file.
    """
    from aionode.system import System

    starting = how_to_start(description, arguments)
    with own_domain() as domain_id:
        context = Context(domain_id=domain_id, discovery_range="LOCALHOST")
        async with System("under_test", context=context) as system, starting(system):
            yield system


def how_to_start(
    description: str | os.PathLike[str] | Callable[[System], Awaitable[object]],
    arguments: Mapping[str, str] | None,
) -> Callable[[System], contextlib.AbstractAsyncContextManager[None]]:
    """Return a function that starts the members of a system and waits until they are ready."""
    if not callable(description) and is_launch_file(Path(description)):
        # Imported here, as most tests need no launch, and as rclpy's recordings import this
        # package.
        from aionode.launch import Plan, plan_running

        plan = Plan(os.fspath(description), arguments)
        return lambda system: plan_running(plan, system)
    if arguments is not None:
        raise TypeError(
            f"system_under_test: {description} is not a launch file and takes no arguments"
        )
    main = description if callable(description) else main_of(Path(description))
    return lambda system: started_by(main, system)


def is_launch_file(file: Path) -> bool:
    """Return whether a file is a ROS 2 launch file rather than one with ``main``."""
    return file.suffix != ".py" or b"generate_launch_description" in file.read_bytes()


@contextlib.asynccontextmanager
async def started_by(
    main: Callable[[System], Awaitable[object]], system: System
) -> AsyncIterator[None]:
    """Start the members that a function adds to a system, and yield when they are ready."""
    await main(system)
    await system.ready()
    yield


def main_of(file: Path) -> Callable[[System], Awaitable[object]]:
    """Return a file's function that adds the members of a system.

    Raises:
        ConfigurationError: it has none (a ValueError).
    """
    main: Any = runpy.run_path(str(file)).get("main")
    if not inspect.iscoroutinefunction(main):
        raise ConfigurationError(
            "system_under_test",
            str(file),
            "the file needs `async def main(system)` or generate_launch_description()",
        )
    return main  # type: ignore[no-any-return]  # a coroutine function


@contextlib.contextmanager
def own_domain() -> Iterator[int]:
    """Reserve a domain that no other test on this machine uses.

    Raises:
        ConfigurationError: all are taken (a ValueError).
    """
    start = os.getpid() % len(DOMAINS)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as reservation:
        for domain_id in (*DOMAINS[start:], *DOMAINS[:start]):
            if is_free(domain_id, reservation):
                yield domain_id
                return
    raise ConfigurationError("system_under_test", "no domain", "all domains for tests are taken")


def is_free(domain_id: int, reservation: socket.socket) -> bool:
    """Return whether a domain could be reserved: a socket has its name until it is closed."""
    try:
        reservation.bind(f"\0aionode-test-domain-{domain_id}")
    except OSError:  # another test has it
        return False
    return True
