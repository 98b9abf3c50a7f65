"""``controller_manager spawner``: loads controllers, configures and activates them."""

from __future__ import annotations

import argparse
import asyncio
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import aionode
from aionode import Node
from aionode.arguments import parse_arguments, remove_ros_args
from aionode.errors import CommandError
from aionode.interfaces.controller_manager_msgs import srv
from aionode.programs._ros2_control.client import ManagerClient, manager_name

__all__ = ["Job", "Spawner", "main", "parsed"]


@dataclass
class Job:
    """What to do with one controller.

    Attributes:
        name: Its name.
        param_files: Files with its parameters.
        load_only: Whether it is only loaded.
        inactive: Whether it is configured, but not activated.
        ros_args: Arguments for its node.
        controller_type: Its type, if the manager's parameters do not name it.
    """

    name: str
    param_files: list[str] = field(default_factory=list)
    load_only: bool = False
    inactive: bool = False
    ros_args: list[str] = field(default_factory=list)
    controller_type: str = ""


def common_options() -> argparse.ArgumentParser:
    """Return the options for all controllers."""
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    option = parser.add_argument
    option("-c", "--controller-manager", default="controller_manager", help="name of the manager")
    option("-n", "--namespace", default="", help="deprecated: namespace of the manager")
    option(
        "--controller-manager-timeout",
        type=float,
        default=0.0,
        help="time to wait for the manager, in seconds; 0 waits forever",
    )
    option("--switch-timeout", type=float, default=5.0, help="time to activate, in seconds")
    option("--service-call-timeout", type=float, default=10.0, help="time for each answer")
    option("--activate-as-group", action="store_true", help="activate all controllers together")
    option("--switch-asap", action=argparse.BooleanOptionalAction, default=False, help="no effect")
    option("-u", "--unload-on-kill", action="store_true", help="wait, and unload them at the end")
    return parser


def controller_options() -> argparse.ArgumentParser:
    """Return the options that ``--controller`` gives to a single controller."""
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    option = parser.add_argument
    option("-p", "--param-file", action="append", default=[], help="file with its parameters")
    option("--load-only", action="store_true", help="leave it unconfigured")
    option("--inactive", "--stopped", action="store_true", help="configure, but do not activate it")
    option("--controller-ros-args", action="append", default=[], help="arguments for its node")
    option("-t", "--controller-type", default="", help="its type")
    return parser


def parsed(words: list[str]) -> tuple[argparse.Namespace, list[Job]]:
    """Return the options for all controllers, and what to do with each.

    Raises:
        CommandError: A file of parameters does not exist.
    """
    words = [word for word in words if word]  # launch files pass empty ones for unused options
    if "--controller" in words and not {"-h", "--help"} & set(words):
        common, _ = common_options().parse_known_args(words)
        starts = [index for index, word in enumerate(words) if word == "--controller"]
        parser = argparse.ArgumentParser(
            prog="spawner --controller", parents=[controller_options()], allow_abbrev=False
        )
        parser.add_argument("controller_names", nargs=1, help="name of a controller")
        given = [
            parser.parse_known_args(words[start + 1 : end])[0]
            for start, end in zip(starts, [*starts[1:], None], strict=True)
        ]
    else:
        parser = argparse.ArgumentParser(
            prog="spawner", parents=[common_options(), controller_options()], allow_abbrev=False
        )
        parser.add_argument("controller_names", nargs="+", help="names of controllers")
        parser.add_argument("--controller", nargs="*", help="options of a single controller follow")
        common = parser.parse_args(words)
        given = [common]
    jobs = [
        Job(
            name,
            each.param_file,
            each.load_only,
            each.inactive,
            [word for words in each.controller_ros_args for word in words.split()],
            each.controller_type,
        )
        for each in given
        for name in each.controller_names
    ]
    for file in (file for job in jobs for file in job.param_files):
        if not Path(file).is_file():
            raise CommandError(f"spawner: there is no file {file}")
    return common, jobs


class Spawner:
    """Brings controllers up.

    Args:
        node: The node that calls the manager.
        options: The options for all controllers.
        jobs: What to do with each.
    """

    def __init__(self, node: Node, options: argparse.Namespace, jobs: list[Job]) -> None:
        self.options = options
        self.jobs = jobs
        self.logger = node.get_logger()
        manager = manager_name(node, options.controller_manager, options.namespace)
        self.namespace = manager.rpartition("/")[0]
        self.client = ManagerClient(
            node,
            manager,
            wait_sec=options.controller_manager_timeout,
            call_sec=options.service_call_timeout,
        )

    async def run(self) -> None:
        """Spawn the controllers, and unload them at the end if that is wanted.

        Raises:
            CommandError: A step failed.
        """
        await self.spawn()
        if self.options.unload_on_kill:
            self.logger.info("Waiting until interrupt to unload controllers")
            try:
                await asyncio.Event().wait()
            finally:
                await self.unload()

    async def spawn(self) -> None:
        """Load, configure and activate the controllers.

        Raises:
            CommandError: A step failed.
        """
        waiting: list[str] = []
        for job in self.jobs:
            await self.load(job)
            if job.load_only:
                continue
            await self.need(srv.ConfigureController, "configure_controller", job.name)
            if job.inactive:
                continue
            waiting.append(job.name)
            if not self.options.activate_as_group:
                await self.activate(waiting, f"Failed to activate controller : {job.name}")
                self.logger.info(f"Configured and activated {job.name}")
                waiting.clear()
        if waiting:
            await self.activate(
                waiting, f"Failed to activate the parsed controllers list : {waiting}"
            )
            self.logger.info(
                f"Configured and activated all the parsed controllers list : {waiting}!"
            )

    async def load(self, job: Job) -> None:
        """Load a controller with its parameters, unless it is loaded."""
        if await self.client.is_loaded(job.name):
            self.logger.warning("Controller already loaded, skipping load_controller")
            return
        if job.ros_args:
            await self.client.set_parameter(job.name, "node_options_args", job.ros_args)
        await self.set_parameters(job)
        await self.need(srv.LoadController, "load_controller", job.name)
        self.logger.info(f"Loaded {job.name}")

    async def set_parameters(self, job: Job) -> None:
        """Set the type and the parameter files of a controller in the manager."""
        kind = job.controller_type
        files = []
        for file in job.param_files:
            words = ["spawner", "--ros-args", "--params-file", file]
            found: dict[str, Any] = parse_arguments(words).parameters_for(
                f"{self.namespace}/{job.name}"
            )
            if found:
                files.append(file)
                kind = kind or found.get("type", "")
        if files:
            await self.client.set_parameter(job.name, "params_file", files)
        elif job.param_files:
            self.logger.warning(
                f"Controller : {self.namespace}/{job.name} parameters not found in parameter files "
                f": {job.param_files}"
            )
        if kind:
            await self.client.set_parameter(job.name, "type", kind)

    async def need(self, kind: Any, name: str, controller: str) -> None:
        """Call a service for a controller, which has to succeed.

        Raises:
            CommandError: It failed.
        """
        if not (await self.client.call(kind, name, kind.Request(name=controller))).ok:
            failed = {
                "load_controller": f"Failed loading controller {controller}",
                "configure_controller": "Failed to configure controller",
                "unload_controller": f"Failed to unload controller : {controller}",
            }[name]
            raise CommandError(f"{failed}; the log of {self.client.manager} says why")

    async def activate(self, names: list[str], failed: str) -> None:
        """Activate controllers.

        Raises:
            CommandError: The manager refuses it.
        """
        if not await self.client.switch(
            start=names,
            stop=[],
            asap=self.options.switch_asap,
            timeout_sec=self.options.switch_timeout,
        ):
            raise CommandError(f"{failed}; the log of {self.client.manager} says why")

    async def unload(self) -> None:
        """Deactivate and unload the controllers.

        Raises:
            CommandError: The manager refuses it.
        """
        names = [job.name for job in self.jobs if not (job.inactive or job.load_only)]
        if not names:
            self.logger.info("No active controllers to unload.")
            return
        self.logger.info("Deactivating and unloading controllers...")
        if not await self.client.switch(
            start=[],
            stop=names,
            asap=self.options.switch_asap,
            timeout_sec=self.options.switch_timeout,
        ):
            raise CommandError("Failed to deactivate controller")
        self.logger.info(f"Successfully deactivated controllers : {names}")
        for name in names:
            await self.need(srv.UnloadController, "unload_controller", name)
        self.logger.info(f"Successfully unloaded controllers : {names}")


async def run(options: argparse.Namespace, jobs: list[Job]) -> None:
    """Run the node until the controllers are up, or until it is interrupted."""
    async with Node(f"spawner_{jobs[0].name}") as node:
        await Spawner(node, options, jobs).run()


def main() -> None:
    """Spawn the controllers that the arguments name."""
    options, jobs = parsed(remove_ros_args(sys.argv)[1:])
    aionode.run(lambda: run(options, jobs))
