"""A node as a member of a system: tasks of this process, or a separate process."""

from __future__ import annotations

import asyncio
import inspect
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml
from msgspec.structs import replace

from aionode.arguments import parse_arguments
from aionode.endpoints.core.end_record import failure_line
from aionode.engine.context import Context
from aionode.engine.membership import with_arguments
from aionode.node import Node
from aionode.runner import failure_text
from aionode.system._member import Member
from aionode.system._status import MemberEnd

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from aionode.system._member import Host, Options

__all__ = ["NodeMember", "Parameters", "program_of", "ros_arguments"]

Parameters = Mapping[str, Any] | str | os.PathLike[str]


class NodeMember(Member):
    """A node that runs as tasks of this process; each start creates a new one.

    Args:
        name: Its name in the system.
        host: The system.
        options: The options that both kinds share.
        make_node: Creates the node.
        context: The context that it joins, unless `make_node` chooses another one.
        arguments: Its ROS arguments, as on a command line.
    """

    def __init__(
        self,
        name: str,
        host: Host,
        options: Options,
        make_node: Callable[[], Node],
        context: Context,
        arguments: Sequence[str],
    ) -> None:
        super().__init__(name, host, options)
        self._make_node = make_node
        self._context = context
        self._arguments = parse_arguments(["--ros-args", *arguments])
        self._arguments.refuse_unknown()

    async def run_once(self, stop: asyncio.Event) -> MemberEnd:
        """Create the node, and run it until it ends."""
        try:
            node = self._made()
            async with node:
                self.note_running(os.getpid())
                stopper = self.host.tasks.create_task(self._stop_at(stop, node))
                try:
                    await node.until_destroyed()
                finally:
                    stopper.cancel()
        except Exception as error:  # noqa: BLE001  # shown in the log and the status
            self.host.log.write(self.name, failure_text(error).encode())
            self.host.log.flush()
            return MemberEnd(
                self.name, failed=True, text=f"failed: {failure_line(error)}", status=1
            )
        return MemberEnd(self.name, failed=False, text="ended", status=0)

    async def _stop_at(self, stop: asyncio.Event, node: Node) -> None:
        await stop.wait()
        self.set_state("stopping")
        node.destroy_node()

    def _made(self) -> Node:
        """Create a node, with this member's arguments in addition to the shared ones."""
        context, own = self._context, self._arguments
        shared = context.arguments
        merged = replace(
            shared,
            remap_rules=own.remap_rules + shared.remap_rules,
            parameter_rules=shared.parameter_rules + own.parameter_rules,
        )
        with with_arguments(context, merged), Context.as_default(context):
            node = self._make_node()
        if not isinstance(node, Node):
            raise TypeError(f"{self.name}: {self._make_node!r} returned {node!r}, not a node")
        return node


def ros_arguments(
    name: str | None,
    namespace: str | None,
    parameters: Any,
    remappings: Any,
) -> list[str]:
    """Return the ROS arguments of a node, as on a command line after ``--ros-args``.

    Args:
        name: The node's new name; None keeps its own.
        namespace: Its namespace.
        parameters: A mapping of names to values, the path of a parameter file, or a sequence of
            both, of which later ones win.
        remappings: A mapping of names to names, or a sequence of pairs.
    """
    arguments = []
    if name is not None:
        arguments += ["-r", f"__node:={name}"]
    if namespace is not None:
        arguments += ["-r", f"__ns:={'/' + namespace.strip('/')}"]
    pairs = remappings.items() if hasattr(remappings, "items") else remappings or ()
    for source, target in pairs:
        arguments += ["-r", f"{source}:={target}"]
    if isinstance(parameters, str | os.PathLike) or hasattr(parameters, "items"):
        parameters = [parameters]
    for parameter in parameters or ():
        if isinstance(parameter, str | os.PathLike):
            arguments += ["--params-file", os.fspath(parameter)]
        else:
            for key, value in flat(parameter):
                arguments += ["-p", f"{key}:={yaml_text(value)}"]
    return arguments


def flat(parameters: Mapping[str, Any], prefix: str = "") -> list[tuple[str, Any]]:
    """Return parameters by full name; nested mappings are joined with dots."""
    flattened = []
    for key, value in parameters.items():
        if hasattr(value, "items"):
            flattened += flat(value, f"{prefix}{key}.")
        else:
            flattened.append((f"{prefix}{key}", value))
    return flattened


def yaml_text(value: Any) -> str:
    """Format a value as YAML on one line, so that a text stays a text."""
    value = list(value) if isinstance(value, tuple) else value
    text = yaml.safe_dump(value, default_flow_style=True, width=float("inf"), allow_unicode=True)
    return text.strip().removesuffix("...").strip()


def maker_of(node: Callable[[], Node] | str) -> Callable[[], Any]:
    """Return the factory of a node: the callable itself, or that of ``module:Class``.

    Raises:
        CommandError: there is none of that name.
    """
    if not isinstance(node, str):
        return node
    from aionode.system.node_source import node_maker

    return node_maker(node)


def program_of(node: Callable[[], Node] | str, name: str) -> list[str]:
    """Return the command line that runs a node in a separate process.

    Raises:
        ValueError: the factory has no name that another process could import.
    """
    return [sys.executable, "-m", "aionode", "run", spec_of(node, name), "--ros-args"]


def spec_of(node: Callable[[], Node] | str, name: str) -> str:
    """Return ``module:Class`` or ``file.py:Class`` of a node's factory."""
    if isinstance(node, str):
        return node
    module, path = getattr(node, "__module__", ""), getattr(node, "__qualname__", "<")
    if "<" in path or not module:
        raise ValueError(
            f"{name}: {node!r} cannot be imported by a process of its own; pass a class or "
            'function of a module, or its name as "module:Class"'
        )
    if module == "__main__":
        return f"{Path(inspect.getfile(node)).resolve()}:{path}"
    return f"{module}:{path}"
