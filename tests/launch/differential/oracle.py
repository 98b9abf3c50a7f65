"""What ROS 2's launch would start for a launch file, as JSON; it starts nothing.

Run it where the real `launch` and `launch_ros` are installed: ``python oracle.py FILE
name:=value``. Timers and event handlers are followed at once, in their order in the file.
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
from pathlib import Path
from typing import Any

import yaml

from aionode.launch.__main__ import InstalledLaunch
from aionode.rclpy import install

install()
sys.meta_path.insert(0, InstalledLaunch())

from launch_ros.actions.load_composable_nodes import get_composable_node_load_request  # noqa: E402

import launch  # noqa: E402
import launch_ros.actions  # noqa: E402
from launch.launch_description_sources import AnyLaunchDescriptionSource  # noqa: E402

if not hasattr(launch.substitutions, "PathSubstitution"):  # launch before 3.8

    class PathSubstitution(launch.substitutions.PathJoinSubstitution):
        """A path that ``/`` extends."""

        def __init__(self, path: Any) -> None:
            super().__init__([path])

        def __truediv__(self, other: Any) -> Any:
            joined = PathSubstitution("")
            parts = [*self.substitutions, other]
            launch.substitutions.PathJoinSubstitution.__init__(joined, parts)
            return joined

    launch.substitutions.PathSubstitution = PathSubstitution

RECORDS: list[dict[str, Any]] = []


class NoNode:
    """Stands in for launch's own node, which is not needed here."""

    def __getattr__(self, name: str) -> Any:
        return lambda *_args, **_options: self


def note_process(action: Any, context: Any) -> None:
    """Record what would be started."""
    action.prepare(context)
    described = action.process_description
    words = []
    for before, word in zip(["", *described.final_cmd], described.final_cmd, strict=False):
        is_file = before == "--params-file" and "launch_params_" in word
        words.append(yaml.unsafe_load(Path(word).read_text()) if is_file else word)
    changed = {
        name: value for name, value in described.final_env.items() if START.get(name) != value
    }
    RECORDS.append(
        {
            "name": described.final_name,
            "argv": plain(words),
            "env": changed,
            "cwd": described.final_cwd,
        }
    )


def plain(value: Any) -> Any:
    """Return a value with lists in place of tuples."""
    if isinstance(value, dict):
        return {str(name): plain(inner) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def note_components(action: Any, context: Any) -> None:
    """Record what a container would load."""
    target = action._LoadComposableNodes__target_container
    if isinstance(target, launch_ros.actions.ComposableNodeContainer):
        name = target.node_name
    else:
        subs = launch.utilities.normalize_to_list_of_substitutions(target)
        name = launch.utilities.perform_substitutions(context, subs)
    for node in action._LoadComposableNodes__composable_node_descriptions:
        request = get_composable_node_load_request(node, context)
        if request is not None:
            RECORDS.append(
                {
                    "container": name,
                    "plugin": request.plugin_name,
                    "package": request.package_name,
                    "node": request.node_name,
                    "namespace": request.node_namespace,
                    "remappings": list(request.remap_rules),
                    "parameters": {
                        parameter.name: value_of(parameter.value)
                        for parameter in request.parameters
                    },
                }
            )


def value_of(value: Any) -> Any:
    """Return the value in a message of a parameter."""
    from rclpy.parameter import parameter_value_to_python

    python_value = parameter_value_to_python(value)
    return python_value.tolist() if hasattr(python_value, "tolist") else plain(python_value)


def visit(entity: Any, context: Any) -> None:
    """Follow an entity, and everything that it consists of, to the end."""
    condition = getattr(entity, "condition", None)
    if condition is not None and not callable(condition) and not condition.evaluate(context):
        return
    if isinstance(entity, launch_ros.actions.LoadComposableNodes):
        note_components(entity, context)
    elif isinstance(entity, launch.actions.TimerAction):
        for inner in entity._TimerAction__actions:
            visit(inner, context)
    elif isinstance(entity, launch.actions.RegisterEventHandler):
        handler = entity.event_handler
        inside = getattr(handler, "_OnActionEventBase__actions_on_event", None)
        if inside is None:
            given = getattr(handler, "_OnShutdown__on_shutdown", ())
            inside = getattr(handler, "entities", None) or (() if callable(given) else given)
        for inner in inside if isinstance(inside, list | tuple) else [inside]:
            visit(inner, context)
    elif not isinstance(entity, launch.actions.EmitEvent):
        for inner in entity.visit(context) or ():
            visit(inner, context)


def main() -> None:
    """Print the records of a file."""
    path, *arguments = sys.argv[1:]
    context = launch.LaunchContext(argv=arguments)
    context._set_asyncio_loop(asyncio.new_event_loop())
    for argument in arguments:
        name, _, value = argument.partition(":=")
        context.launch_configurations[name] = value
    launch.actions.ExecuteLocal.execute = note_process
    launch_ros.actions.lifecycle_node.get_ros_node = lambda _context: NoNode()
    if hasattr(launch_ros.actions, "set_use_sim_time"):
        launch_ros.actions.set_use_sim_time.SetUseSimTime.execute = lambda *_: None
    visit(launch.actions.IncludeLaunchDescription(AnyLaunchDescriptionSource(path)), context)
    print(json.dumps(RECORDS))


START = dict(os.environ)
main()
