"""`launch.LaunchService`: launch descriptions run by a program."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from typing import Any

from launch.actions import EmitEvent
from launch.event import Event
from launch.events import Shutdown
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity

__all__ = ["LaunchService"]


class LaunchService:
    """Runs launch descriptions, until nothing of them is running."""

    def __init__(
        self,
        *,
        argv: Iterable[str] | None = None,
        noninteractive: bool = False,
        debug: bool = False,
    ) -> None:
        self.context = LaunchContext(argv=argv, noninteractive=noninteractive)
        self.shuts_down_when_idle = True
        self.included: list[LaunchDescriptionEntity] = []
        """Descriptions that the engine has not processed yet."""
        self.wake: Callable[[], object] = int
        """Called in the loop's thread when something is added to `included`."""
        self.event_loop: asyncio.AbstractEventLoop | None = None
        self.task: asyncio.Task[Any] | None = None

    def include_launch_description(self, launch_description: LaunchDescriptionEntity) -> None:
        """Also run this description; may be called from any thread."""
        self.included.append(launch_description)
        if self.event_loop is not None:
            self.event_loop.call_soon_threadsafe(self.wake)

    def emit_event(self, event: Event) -> None:
        """Pass an event to the handlers; may be called from any thread."""
        self.include_launch_description(EmitEvent(event=event))

    def shutdown(self, force_sync: bool = False) -> None:
        """Stop everything; may be called from any thread, and `run` returns afterwards."""
        self.emit_event(Shutdown(reason="LaunchService.shutdown() called"))

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run the descriptions, and return 0, or 1 if one of them cannot be evaluated.

        Args:
            shutdown_when_idle: Whether to return when nothing runs any more, rather than wait for
                `shutdown`.
        """
        from aionode.runner import run

        status = []

        async def main() -> None:
            status.append(await self.run_async(shutdown_when_idle=shutdown_when_idle))

        run(main, args=[])
        return status[0] if status else 0

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Run the descriptions like `run`, in the loop that is already running.

        Raises:
            RuntimeError: It is already running.
        """
        if self.task is not None:
            raise RuntimeError("LaunchService cannot be run multiple times concurrently.")
        from aionode.launch.running import run_service  # which imports this class

        self.shuts_down_when_idle = shutdown_when_idle
        self.task, self.event_loop = asyncio.current_task(), asyncio.get_running_loop()
        try:
            return await run_service(self)
        finally:
            self.task = self.event_loop = None
