"""A system as the main program."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Sequence

    from aionode.system._log import SystemLog
    from aionode.system._system import System

__all__ = ["run"]


def run(
    main: Callable[[System], Awaitable[object]],
    *,
    name: str = "",
    log: SystemLog | None = None,
    args: Sequence[str] | None = None,
) -> NoReturn:
    """Run a system until it is over, or until Ctrl-C, SIGTERM or SIGHUP, and exit.

    `main` adds the members and may await things such as `System.ready`; then the system runs until
    `System.wait` returns. The first signal stops the members in order. A signal more than a second
    later ends everything at once: every process is killed, and this one exits with the shell's
    status for the signal.

    Args:
        main: Called with the system, which has started.
        name: The name of the system.
        log: Receives the output of all members; `SystemLog` on ``sys.stdout`` by default.
        args: The command line without the program name; ``sys.argv[1:]`` if None. Arguments after
            ``--ros-args`` apply to the nodes of this process.

    Raises:
        SystemExit: always; with the exit status of the first member that failed for good, else
            with 1 if `main` failed, and with 0 after a clean end.
    """
    # Imported only when a system runs, as most commands of the command line need neither.
    from aionode.runner import run as run_until_stopped
    from aionode.system._system import System

    system: System | None = None

    async def work() -> None:
        nonlocal system
        async with System(name, log=log) as system:
            await system.run_main(main)

    status = 0
    try:
        run_until_stopped(work, args=args)
    except SystemExit as end:
        status = 1
        cause: BaseException | None = end
    else:
        cause = None
    raise SystemExit((system.exit_status if system else 0) or status) from cause
