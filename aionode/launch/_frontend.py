"""The meaning of each element of XML and YAML launch files, and the error for any other."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import launch_ros
from aionode.errors import LaunchFileError
from aionode.launch._markup import Element
from launch import actions, substitutions
from launch.actions.for_loop import PopLocals, PushLocals
from launch.conditions import IfCondition, UnlessCondition
from launch.frontend.expose import SUBSTITUTIONS
from launch.frontend.parse_substitution import parse_words
from launch.launch_description import LaunchDescription
from launch.launch_description_entity import set_where
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch.substitution import Substitution, TextSubstitution, of_words
from launch.utilities.type_utils import coerce_to_type
from launch_ros import actions as ros_actions
from launch_ros import descriptions

__all__ = ["description_of"]

Options = dict[str, Any]


def register_substitutions() -> None:
    """Register the names of substitutions with the text parser."""
    kinds: dict[str, Callable[..., Substitution]] = {
        "all": substitutions.AllSubstitution,
        "and": substitutions.AndSubstitution,
        "anon": substitutions.AnonName,
        "any": substitutions.AnySubstitution,
        "command": of_words(substitutions.Command),
        "dirname": substitutions.ThisLaunchFileDir,
        "env": of_words(substitutions.EnvironmentVariable),
        "equals": substitutions.EqualsSubstitution,
        "eval": of_words(substitutions.PythonExpression),
        "exec-in-pkg": launch_ros.substitutions.ExecutableInPackage,
        "file-content": substitutions.FileContent,
        "filename": substitutions.ThisLaunchFile,
        "find-exec": of_words(substitutions.FindExecutable),
        "find-pkg-prefix": launch_ros.substitutions.FindPackagePrefix,
        "find-pkg-share": launch_ros.substitutions.FindPackageShare,
        "for-var": of_words(substitutions.ForEachVar),
        "if": substitutions.IfElseSubstitution,
        "index": substitutions.ForLoopIndex,
        "launch_log_dir": substitutions.LaunchLogDir,
        "log_dir": substitutions.LaunchLogDir,
        "not": substitutions.NotSubstitution,
        "not-equals": substitutions.NotEqualsSubstitution,
        "or": substitutions.OrSubstitution,
        "param": of_words(launch_ros.substitutions.Parameter),
        "path-join": lambda *words: substitutions.PathJoinSubstitution(words),
        "var": of_words(substitutions.LaunchConfiguration),
    }
    SUBSTITUTIONS.update(kinds)


register_substitutions()


MARK = 0xF0000
MARKS = re.compile("([\U000f0000-\U000ffffd])")


class Reading:
    """The attributes and children of one element, all of which must be used."""

    def __init__(self, element: Element) -> None:
        self.element = element
        self.attributes = dict(element.attributes)
        self.names = {child.name for child in element.children}
        self.known: set[str] = set()

    def raw(self, name: str) -> Any:
        """Return an attribute as written; None if missing."""
        self.known.add(name)
        return self.attributes.pop(name, None)

    def need(self, name: str) -> Any:
        """Return a required attribute."""
        value = self.raw(name)
        if value is None:
            raise ValueError(f"'{self.element.name}' needs '{name}'")
        return value

    def text(self, name: str) -> list[Substitution] | None:
        """Return an attribute whose text may contain substitutions."""
        value = self.raw(name)
        return None if value is None else words_of(value)

    def flag(self, name: str) -> Any:
        """Return a boolean attribute, which may be a substitution."""
        value = self.raw(name)
        if not isinstance(value, str):
            return value
        parts = parse_words(value)
        if len(parts) == 1 and isinstance(parts[0], TextSubstitution):
            return coerce_to_type(value, bool)
        return parts

    def inner(self, name: str) -> list[Element]:
        """Return the children with this name."""
        self.known.add(name)
        self.names.discard(name)
        return list(self.element.all(name))

    def pairs(self, name: str, first: str, second: str) -> list[tuple[Any, Any]]:
        """Return two attributes of each child with this name."""
        result = []
        for child in self.inner(name):
            reading = Reading(child)
            result.append((words_of(reading.need(first)), words_of(reading.need(second))))
            reading.finish()
        return result

    def finish(self) -> None:
        """Raise ValueError if something was not used."""
        left = [*self.attributes, *sorted(self.names)]
        if left:
            fits = ", ".join(sorted(self.known)) or "nothing"
            raise ValueError(f"'{self.element.name}' has no '{left[0]}'; it has: {fits}")


def words_of(value: Any) -> list[Substitution]:
    """Return the substitutions of an attribute."""
    return parse_words(value if isinstance(value, str) else str(value))


def given(**options: Any) -> Options:
    """Return the options that are not None."""
    return {name: value for name, value in options.items() if value is not None}


def command_words(text: str) -> list[list[Substitution]]:
    """Split a command line, whose text may contain substitutions, into words.

    A substitution belongs to the word that contains it, and quotes around it are respected.
    """
    parts = parse_words(text)
    later = [part for part in parts if not isinstance(part, TextSubstitution)]
    # Each is replaced by a character that no command line contains, until the words are known.
    marks = iter(range(len(later)))
    line = "".join(
        part.text if isinstance(part, TextSubstitution) else chr(MARK + next(marks))
        for part in parts
    )
    return [
        [
            later[ord(piece) - MARK] if is_mark(piece) else TextSubstitution(text=piece)
            for piece in MARKS.split(word)
            if piece
        ]
        or [TextSubstitution(text="")]
        for word in shlex.split(line)
    ]


def is_mark(piece: str) -> bool:
    """Return whether a piece of a word is a placeholder for a substitution."""
    return bool(MARKS.fullmatch(piece))


def description_of(path: str, root: Element) -> LaunchDescription:
    """Return the launch description of a file.

    Raises:
        LaunchFileError: An element is unknown, or has something it must not have.
    """
    if root.name != "launch":
        raise LaunchFileError(path, f"begins with '{root.name}'; begin with 'launch'", line=1)
    return LaunchDescription([action_of(child) for child in root.children])


def action_of(element: Element) -> actions.Action:
    """Return the action of an element."""
    path, _, line = element.where.rpartition(":")
    make = ACTIONS.get(element.name)
    if make is None:
        known = ", ".join(sorted(ACTIONS))
        problem = f"'{element.name}' is not an action; there are: {known}"
        raise LaunchFileError(path, problem, line=int(line))
    reading = Reading(element)
    try:
        condition = condition_of(reading)
        action = make(reading, {"condition": condition} if condition else {})
        reading.finish()
    except LaunchFileError:
        raise
    except (TypeError, ValueError, KeyError, RuntimeError) as error:
        raise LaunchFileError(path, str(error), line=int(line)) from error
    set_where(action, element.where)
    return action


def condition_of(reading: Reading) -> Any:
    """Return the condition in ``if`` or ``unless``."""
    holds, fails = reading.raw("if"), reading.raw("unless")
    if holds is not None and fails is not None:
        raise ValueError(f"'{reading.element.name}' has 'if' and 'unless'; use one of them")
    if holds is not None:
        return IfCondition(words_of(truth_text(holds)))
    return None if fails is None else UnlessCondition(words_of(truth_text(fails)))


def truth_text(value: Any) -> str:
    """Return a truth as text."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def simple(
    kind: Callable[..., actions.Action], names: Iterable[str], reading: Reading, options: Options
) -> actions.Action:
    """Return an action whose options are attributes; ``name=attribute`` renames one."""
    for name in names:
        option, _, attribute = name.partition("=")
        optional = option.endswith("?")
        attribute = (attribute or option).rstrip("?")
        value = reading.text(attribute) if optional else words_of(reading.need(attribute))
        if value is not None:
            options[option.rstrip("?")] = value
    return kind(**options)


def process_options(reading: Reading) -> Options:
    """Return the options that every process has."""
    return given(
        cwd=reading.text("cwd"),
        prefix=reading.text("launch-prefix"),
        output=reading.text("output"),
        respawn=reading.flag("respawn"),
        respawn_delay=number(reading.raw("respawn_delay")),
        respawn_max_retries=integer(reading.raw("respawn_max_retries")),
        sigkill_timeout=number(reading.raw("sigkill_timeout")),
        sigterm_timeout=number(reading.raw("sigterm_timeout")),
        emulate_tty=reading.flag("emulate_tty"),
        shell=reading.flag("shell"),
        additional_env={tuple(name): value for name, value in reading.pairs("env", "name", "value")}
        or None,
    )


def number(value: Any) -> float | None:
    """Return a number."""
    return None if value is None else float(value)


def integer(value: Any) -> int | None:
    """Return a whole number."""
    return None if value is None else int(value)


def executable(reading: Reading, options: Options) -> actions.Action:
    """Return the action of an ``executable``."""
    cmd = command_words(str(reading.need("cmd")))
    args = reading.raw("args")
    if args is not None:
        cmd += command_words(str(args))
    named = given(name=reading.text("name"))
    return actions.ExecuteProcess(cmd=cmd, **named, **process_options(reading), **options)


def node_options(reading: Reading) -> Options:
    """Return the options of a node."""
    args, ros_args = reading.raw("args"), reading.raw("ros_args")
    return given(
        package=reading.text("pkg"),
        name=reading.text("name"),
        namespace=reading.text("namespace"),
        exec_name=reading.text("exec_name"),
        arguments=None if args is None else command_words(str(args)),
        ros_arguments=None if ros_args is None else command_words(str(ros_args)),
        parameters=parameters_of(reading) or None,
        remappings=reading.pairs("remap", "from", "to") or None,
        **process_options(reading),
    )


def node(reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``node``."""
    exec_ = words_of(reading.need("exec"))
    return ros_actions.Node(executable=exec_, **node_options(reading), **options)


def lifecycle_node(reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``lifecycle_node``."""
    exec_ = words_of(reading.need("exec"))
    options |= {"namespace": "", "name": reading.element.attributes.get("name", "")}
    options |= node_options(reading) | given(autostart=reading.flag("autostart"))
    return ros_actions.LifecycleNode(executable=exec_, **options)


def parameters_of(reading: Reading) -> list[Any]:
    """Return the parameters inside an element."""
    parameters: list[Any] = []
    for child in reading.inner("param"):
        inside = Reading(child)
        file = inside.text("from")
        if file is not None:
            allow = inside.flag("allow_substs")
            parameters.append(descriptions.ParameterFile(file, allow_substs=allow or False))
        else:
            parameters.append(parameter(inside))
        inside.finish()
    return parameters


def parameter(reading: Reading) -> dict[Any, Any]:
    """Return a parameter, or nested ones, as a dictionary."""
    name = tuple(words_of(reading.need("name")))
    value, kind = reading.raw("value"), reading.raw("type")
    separator = reading.raw("value-sep")
    if value is None:
        inner: dict[Any, Any] = {}
        for child in reading.inner("param"):
            inside = Reading(child)
            inner.update(parameter(inside))
            inside.finish()
        if not inner:
            raise ValueError("'param' needs 'value', 'from' or a 'param' inside")
        return {name: inner}
    if separator is not None:
        value = [item.strip() for item in str(value).split(str(separator))]
    return {name: typed(value, kind)}


TYPES = {
    "bool": bool,
    "float": float,
    "int": int,
    "str": str,
    "list_of_bool": list[bool],
    "list_of_float": list[float],
    "list_of_int": list[int],
    "list_of_str": list[str],
}


def typed(value: Any, kind: str | None) -> Any:
    """Return the value of a parameter, whose text may contain substitutions."""
    if kind is not None and kind not in TYPES:
        raise ValueError(f"type {kind!r} is not known; there are: {', '.join(TYPES)}")
    if isinstance(value, list):
        return [words_of(item) if isinstance(item, str) else item for item in value]
    if not isinstance(value, str):
        return value
    words = words_of(value)
    return descriptions.ParameterValue(words, value_type=TYPES[kind]) if kind else words


def component(element: Element) -> descriptions.ComposableNode:
    """Return a node of a container."""
    reading = Reading(element)
    extra = reading.pairs("extra_arg", "name", "value")
    node = descriptions.ComposableNode(
        package=words_of(reading.need("pkg")),
        plugin=words_of(reading.need("plugin")),
        condition=condition_of(reading),
        **given(
            name=reading.text("name"),
            namespace=reading.text("namespace"),
            parameters=parameters_of(reading) or None,
            remappings=reading.pairs("remap", "from", "to") or None,
            extra_arguments=[{tuple(name): value} for name, value in extra] or None,
        ),
    )
    reading.finish()
    return node


def container(reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``node_container``."""
    exec_ = words_of(reading.need("exec"))
    inner = [component(child) for child in reading.inner("composable_node")]
    options |= {"namespace": "", "name": reading.element.attributes.get("name", "")}
    options |= node_options(reading)
    return ros_actions.ComposableNodeContainer(
        executable=exec_, composable_node_descriptions=inner, **options
    )


def load(reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``load_composable_node``."""
    inner = [component(child) for child in reading.inner("composable_node")]
    target = words_of(reading.need("target"))
    return ros_actions.LoadComposableNodes(
        composable_node_descriptions=inner, target_container=target, **options
    )


def argument(reading: Reading, options: Options) -> actions.Action:
    """Return the action of an ``arg``."""
    choices = [str(child.attributes.get("value", "")) for child in reading.inner("choice")]
    options |= given(
        default_value=reading.text("default"),
        description=reading.raw("description"),
        choices=choices or None,
    )
    return actions.DeclareLaunchArgument(str(reading.need("name")), **options)


def include(reading: Reading, options: Options) -> actions.Action:
    """Return the action of an ``include``."""
    source = AnyLaunchDescriptionSource(words_of(reading.need("file")))
    arguments = [
        *reading.pairs("arg", "name", "value"),
        *reading.pairs("let", "name", "value"),
    ]
    return actions.IncludeLaunchDescription(source, launch_arguments=arguments, **options)


def inner_actions(reading: Reading, without: Iterable[str] = ()) -> list[actions.Action]:
    """Return the actions inside an element."""
    reading.names.clear()
    return [action_of(child) for child in reading.element.children if child.name not in without]


def group(reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``group``."""
    kept = {tuple(name): value for name, value in reading.pairs("keep", "name", "value")}
    options |= given(
        scoped=reading.flag("scoped"),
        forwarding=reading.flag("forwarding"),
        launch_configurations=kept or None,
    )
    return actions.GroupAction(inner_actions(reading, without=("keep",)), **options)


def timer(kind: Any, reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``timer``."""
    period = words_of(reading.need("period"))
    action: actions.Action = kind(period=period, actions=inner_actions(reading), **options)
    return action


def for_each(reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``for_each``."""
    once = iteration(reading)
    values = words_of(reading.need("values"))
    return actions.ForEach(values, function=lambda **given: once(given), **options)


def for_loop(reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``for``."""
    once, name = iteration(reading), str(reading.need("name"))
    length = words_of(reading.need("len"))
    return actions.ForLoop(length, function=lambda i: once({name: i}), name=name, **options)


def iteration(reading: Reading) -> Callable[[Options], list[actions.Action]]:
    """Return a function that creates the actions inside a loop for the values of one iteration."""
    inner_actions(reading)  # reports errors even without an iteration
    name_of = substitutions.ForEachVar.get_local_arg_name

    def once(values: Options) -> list[actions.Action]:
        known = {name_of(name): str(value) for name, value in values.items()}
        return [PushLocals(known), *inner_actions(reading), PopLocals()]

    return once


def set_parameter(reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``set_parameter``."""
    name = words_of(reading.need("name"))
    value = typed(reading.need("value"), reading.raw("type"))
    return ros_actions.SetParameter(name, value, **options)


def append_env(reading: Reading, options: Options) -> actions.Action:
    """Return the action of an ``append_env``."""
    options |= given(prepend=reading.flag("prepend"), separator=reading.text("separator"))
    name, value = words_of(reading.need("name")), words_of(reading.need("value"))
    return actions.AppendEnvironmentVariable(name, value, **options)


def reset(reading: Reading, options: Options) -> actions.Action:
    """Return the action of a ``reset``."""
    kept: dict[Any, Any] = {
        tuple(name): value for name, value in reading.pairs("keep", "name", "value")
    }
    return actions.ResetLaunchConfigurations(kept, **options)


def of(kind: Callable[..., actions.Action], *names: str) -> Callable[..., actions.Action]:
    """Return the factory of an action whose options are attributes."""
    return partial(simple, kind, names)


ACTIONS: dict[str, Callable[[Reading, Options], actions.Action]] = {
    "append_env": append_env,
    "arg": argument,
    "executable": executable,
    "for": for_loop,
    "for_each": for_each,
    "group": group,
    "include": include,
    "let": of(actions.SetLaunchConfiguration, "name", "value"),
    "lifecycle_node": lifecycle_node,
    "load_composable_node": load,
    "log": of(actions.LogInfo, "msg=message"),
    "log_info": of(actions.LogInfo, "msg=message"),
    "node": node,
    "node_container": container,
    "push-ros-namespace": of(ros_actions.PushROSNamespace, "namespace"),
    "push_ros_namespace": of(ros_actions.PushROSNamespace, "namespace"),
    "reset": reset,
    "reset_env": of(actions.ResetEnvironment),
    "ros_timer": partial(timer, ros_actions.ROSTimer),
    "set_env": of(actions.SetEnvironmentVariable, "name", "value"),
    "set_parameter": set_parameter,
    "set_parameters_from_file": of(ros_actions.SetParametersFromFile, "filename"),
    "set_remap": of(ros_actions.SetRemap, "src=from", "dst=to"),
    "set_ros_log_dir": of(ros_actions.SetROSLogDir, "new_log_dir"),
    "set_use_sim_time": of(ros_actions.SetUseSimTime, "value"),
    "shutdown": of(actions.Shutdown, "reason?"),
    "timer": partial(timer, actions.TimerAction),
    "unset_env": of(actions.UnsetEnvironmentVariable, "name"),
}
