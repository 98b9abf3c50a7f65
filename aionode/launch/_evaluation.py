"""Evaluate a launch description to a plan, without starting anything."""

from __future__ import annotations

import difflib
import importlib.machinery
import importlib.util
import inspect
import os
import re
import subprocess  # to see that it failed
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from aionode._packages import is_window, package_of_stand_in
from aionode._process.bounded_files import read_file
from aionode.errors import (
    AionodeError,
    ExecutableNotFoundError,
    LaunchFileError,
    PackageNotFoundError,
)
from aionode.launch._frontend import description_of
from aionode.launch._markup import read_xml, read_yaml
from aionode.launch._stand_ins import missing_module, with_stand_ins
from aionode.launch.plan import Missing, Opaque, Step, Timer, Watch
from aionode.rclpy.missing import advice
from launch.actions import (
    DeclareLaunchArgument,
    GroupAction,
    IncludeLaunchDescription,
    TimerAction,
)
from launch.event_handler import entities_of
from launch.launch_context import KnownLater, LaunchContext
from launch.launch_description import LaunchDescription
from launch.launch_description_entity import LaunchDescriptionEntity, where_of
from launch.stand_in import StandIn, package_of
from launch.substitutions import UnknownConfiguration

__all__ = ["arguments_of", "check_later_steps", "evaluate", "load_file", "new_context"]

FUNCTION = "generate_launch_description"
PREFIX_PATH = "AMENT_PREFIX_PATH"

ENDINGS = {".py": "python", ".xml": "xml", ".launch": "xml", ".yaml": "yaml", ".yml": "yaml"}
"""The languages of launch files, by the endings of their names."""

MAX_DEPTH = 100
"""Maximum depth of included files."""

MAX_ENTITIES = 50_000
"""Most entities of one evaluation: files that include others twice grow without end."""


def new_context(path: str, arguments: Mapping[str, str]) -> LaunchContext:
    """Create the context in which a file's description is evaluated."""
    context = LaunchContext(argv=[f"{name}:={value}" for name, value in arguments.items()])
    context.load_file = load_description
    context.launch_configurations.update(arguments)
    file = Path(path).absolute()
    context.extend_locals(
        {
            "current_launch_file_path": str(file),
            "current_launch_file_directory": str(file.parent),
        }
    )
    return context


def load_description(path: str, kind: str = "any") -> Any:
    """Load the description in a file.

    Raises:
        LaunchFileError: There is no such file, or it is not a launch file.
    """
    return description_in_text(path, text_of(path), kind)


def description_of_text(path: str, text: bytes | None, endings: Iterable[str]) -> Any:
    """Return the description in a file, for a program that asks for it.

    Args:
        path: The file, or a name for what was read.
        text: Its text; read from the file if not given.
        endings: The endings of the languages that it may be in; one, if there is only one.

    Raises:
        LaunchFileError: There is no such file, or it is not a launch file of these languages.
    """
    kinds = [ENDINGS[f".{ending}"] for ending in endings]
    content = text_of(path) if text is None else text
    kind = kinds[0] if len(kinds) == 1 else kind_of(path, content)
    if kind not in kinds:
        allowed = " or ".join(dict.fromkeys(kinds))
        raise LaunchFileError(path, f"is in {kind}; {allowed} is expected")
    return description_in_text(path, content, kind)


def text_of(path: str) -> bytes:
    """Return the text of a launch file.

    Raises:
        LaunchFileError: It cannot be read.
    """
    try:
        return read_file(Path(path))
    except OSError as error:
        raise LaunchFileError(path, f"cannot be read: {error.strerror}") from error


def description_in_text(path: str, text: bytes, kind: str) -> Any:
    """Return the description in the text of a file."""
    if kind == "any":
        kind = kind_of(path, text)
    if kind == "python":
        return description_in(module_in(path), path)
    return description_of(path, (read_xml if kind == "xml" else read_yaml)(path, text))


def kind_of(path: str, text: bytes) -> str:
    """Return the language of a file, judged by its name or else by its text."""
    kind = ENDINGS.get(Path(path).suffix)
    if kind is not None:
        return kind
    begin = text.lstrip()[:200]
    if begin.startswith(b"<"):
        return "xml"
    if b"generate_launch_description" in text:
        return "python"
    if begin.startswith(b"launch:") or b"\nlaunch:" in text:
        return "yaml"
    raise LaunchFileError(path, "not a launch file in Python, XML or YAML")


def module_in(path: str) -> Any:
    """Run a Python file, and return its module.

    Raises:
        LaunchFileError: It fails.
    """
    spec = importlib.util.spec_from_loader(
        f"aionode_launch_file_{Path(path).name.replace('.', '_')}",
        importlib.machinery.SourceFileLoader("aionode_launch_file", str(path)),
    )
    assert spec is not None  # noqa: S101  # it has a loader
    assert spec.loader is not None  # noqa: S101  # as above
    module = importlib.util.module_from_spec(spec)
    module.__file__ = str(path)
    wrote = sys.dont_write_bytecode
    sys.dont_write_bytecode = True  # a launch file leaves no .pyc file behind
    try:
        code = compile(text_of(path), str(path), "exec", dont_inherit=True)  # as Python compiles it
        with prefix_path():
            with_stand_ins(lambda: exec(code, vars(module)))  # noqa: S102  # the user's own program
    except Exception as error:
        raise failure(path, error) from error
    finally:
        sys.dont_write_bytecode = wrote
    return module


def load_file(path: str) -> tuple[Any, Callable[..., Any] | None]:
    """Load the description in a file, and its ``async def main(system)`` if it has one.

    Raises:
        LaunchFileError: There is no such file, or it is not a launch file.
    """
    if Path(path).suffix == ".py" and Path(path).is_file():
        module = module_in(path)
        main = getattr(module, "main", None)
        if not hasattr(module, FUNCTION) and inspect.iscoroutinefunction(main):
            return LaunchDescription(), main
        return description_in(module, path), None
    return load_description(path), None


@contextmanager
def prefix_path() -> Iterator[None]:
    """Set AMENT_PREFIX_PATH for launch files that read it, as a sourced ROS 2 does.

    Without ROS 2, packages are installed with Python. What is started does not get the variable,
    which would say that ROS 2 is sourced.
    """
    if os.environ.get(PREFIX_PATH):
        yield
        return
    os.environ[PREFIX_PATH] = sys.prefix
    try:
        yield
    finally:
        if os.environ.get(PREFIX_PATH) == sys.prefix:
            del os.environ[PREFIX_PATH]


def description_in(module: Any, path: str) -> Any:
    """Return the result of a module's ``generate_launch_description()``."""
    function = getattr(module, FUNCTION, None)
    if function is None:
        raise LaunchFileError(path, f"has neither {FUNCTION}() nor `async def main(system)`")
    try:
        with prefix_path():
            description = with_stand_ins(function)
    except Exception as error:
        raise failure(path, error) from error
    if isinstance(description, StandIn):
        return LaunchDescription([description])
    if not isinstance(description, LaunchDescription):
        problem = f"{FUNCTION}() returned {description!r}; return a LaunchDescription"
        raise LaunchFileError(path, problem)
    return description


def failure(path: str, error: Exception) -> LaunchFileError:
    """Return the error of a launch file whose code fails: where, and what would be valid."""
    if isinstance(error, LaunchFileError):
        return error
    if isinstance(error, SyntaxError):
        return LaunchFileError(path, f"not valid Python: {error.msg}", line=error.lineno)
    frames = traceback.extract_tb(error.__traceback__)
    file, line = next(
        (
            (frame.filename, frame.lineno)
            for frame in reversed(frames)
            if not is_machinery(frame.filename)
        ),
        (path, None),
    )
    return LaunchFileError(file, problem_of(error), line=line)


def is_machinery(filename: str) -> bool:
    """Return whether a file belongs to aionode or to Python's import system."""
    return filename.startswith((str(Path(__file__).parents[1]), "<frozen"))


OWN_PACKAGES = frozenset(
    {
        *("ament_index_python", "controller_manager", "launch", "launch_param_builder"),
        *("launch_ros", "launch_xml", "launch_yaml", "moveit_configs_utils", "nav2_common"),
    }
)
"""The packages of ROS that aionode has for launch files."""

UNKNOWN = re.compile(r"(\w+)\.__init__\(\) got an unexpected keyword argument '(\w+)'")


def unknown_option(error: Exception) -> str | None:
    """Describe which class lacks an option, and what it has; None if that is not the problem.

    The error text names the class that was called last, which may be a base of the one in the file.
    """
    match = UNKNOWN.match(str(error))
    if match is None:
        return None
    name, option = match.groups()
    frames = [frame for frame, _ in traceback.walk_tb(error.__traceback__)]
    users = [at for at, frame in enumerate(frames) if not is_machinery(frame.f_code.co_filename)]
    inner = frames[users[-1] + 1 :] if users else []
    kind = frames[users[-1]].f_globals.get(name) if users else None
    kind = type(inner[0].f_locals["self"]) if inner and "self" in inner[0].f_locals else kind
    if not isinstance(kind, type):
        return None
    known = options_of(kind)
    close = difflib.get_close_matches(option, known)
    fits = f"is it '{close[0]}'?" if close else f"it has: {', '.join(known)}"
    return f"{kind.__name__} has no '{option}'; {fits}"


def options_of(kind: type) -> list[str]:
    """Return the names of the arguments of a class, including those it passes to its bases."""
    argument_names: set[str] = set()
    for cls in kind.__mro__:
        if "__init__" in vars(cls):
            _, *parameters = inspect.signature(vars(cls)["__init__"]).parameters.values()
            variable = {inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL}
            argument_names |= {
                parameter.name for parameter in parameters if parameter.kind not in variable
            }
            if all(parameter.kind is not inspect.Parameter.VAR_KEYWORD for parameter in parameters):
                break
    return sorted(argument_names)


def problem_of(error: Exception) -> str:
    """Describe what went wrong, and for a missing name the alternatives."""
    if (problem := unknown_option(error)) is not None:
        return problem
    if isinstance(error, ImportError) and error.name is not None:
        match = re.match(r"cannot import name '(\w+)'", str(error))  # before Python 3.12
        missing = None if match is None else match.group(1)
        if missing is not None and is_own(error.name):
            known = ", ".join(getattr(sys.modules.get(error.name), "__all__", ()))
            return (
                f"{error.name} has no {missing}; it has: {known}. "
                "--real runs the file with ROS 2's own launch, where that is installed"
            )
        return advice(error.name, OWN_PACKAGES) or f"no module {error.name}"
    text = str(error) or type(error).__name__
    if isinstance(error, KeyError) and type(error) is not KeyError:
        return str(error.args[0])  # its text rather than a key
    if is_of_environment(error):
        name = error.args[0]
        return (
            f"the environment has no {name!r}, which the file reads; give it a value: "
            f"{name}=VALUE aionode launch …"
        )
    plain = (AionodeError, TypeError, ValueError, RuntimeError, OSError)
    if isinstance(error, plain):
        return text
    return f"{type(error).__name__}: {text}"


def is_of_environment(error: Exception) -> bool:
    """Return whether an error comes from ``os.environ[name]``."""
    frames = [frame for frame, _ in traceback.walk_tb(error.__traceback__)]
    reads = type(os.environ).__getitem__
    return bool(frames) and frames[-1].f_code is reads.__code__


def is_own(module: str) -> bool:
    """Return whether a module is one of aionode's replacements for ROS's."""
    return module.partition(".")[0] in OWN_PACKAGES


def evaluate(entities: Iterable[Any], context: LaunchContext) -> list[Step]:
    """Return the steps of entities, in order, up to those that are known only at run time.

    Raises:
        LaunchFileError: An entity cannot be evaluated, with its file and line.
    """
    context.visited = 0
    try:
        with prefix_path():
            for entity in entities:
                visit(entity, context, 0)
    except KnownLater as later:
        context.steps.append(Opaque(str(later)))
    steps, context.steps = context.steps, []
    return steps


def check_later_steps(steps: Iterable[Step], checked: set[int]) -> None:
    """Evaluate timers and event handlers, as far as possible without running anything.

    That way their errors are found before anything starts.

    Args:
        steps: The steps.
        checked: The ids of lists of entities that were checked, as an event handler may register
            itself.

    Raises:
        LaunchFileError: An entity cannot be evaluated, with its file and line.
    """
    for step in steps:
        if isinstance(step, Timer):
            entities = step.entities
        elif isinstance(step, Watch):
            entities = step.entities or []
        else:
            continue
        if id(entities) in checked:
            continue
        checked.add(id(entities))
        check_later_steps(evaluate(entities, step.context.fork(ahead=True)), checked)


def visit(entity: LaunchDescriptionEntity, context: LaunchContext, depth: int) -> None:
    """Execute an entity and its children."""
    context.visited += 1
    is_too_much = context.visited > MAX_ENTITIES and isinstance(entity, IncludeLaunchDescription)
    if depth > MAX_DEPTH or is_too_much:
        path, _, line = where_of(entity).rpartition(":")
        many = f"{MAX_DEPTH} levels" if depth > MAX_DEPTH else f"{MAX_ENTITIES} entities"
        problem = f"includes more than {many}; does a file include itself?"
        raise LaunchFileError(path, problem, line=int(line))
    try:
        inner = entities_of(entity.visit(context))
    except KnownLater:
        raise
    except Exception as error:
        if not is_left_out(entity, error, context):
            raise failed(entity, error) from error
        return
    for child in inner:
        visit(child, context, depth + 1)


def failed(entity: LaunchDescriptionEntity, error: Exception) -> LaunchFileError:
    """Return the error of an entity; for an included file, with the place of the include."""
    if isinstance(error, LaunchFileError):
        if error.line is None and isinstance(entity, IncludeLaunchDescription):
            path, _, line = where_of(entity).rpartition(":")
            problem = f"includes {error.path}, which {error.problem}"
            return LaunchFileError(path, problem, line=int(line))
        return error
    return failure_of(entity, error)


def is_left_out(entity: LaunchDescriptionEntity, error: Exception, context: LaunchContext) -> bool:
    """Return whether an entity is left out for a missing package, and record it.

    A window is left out even where a missing package is an error: no robot depends on it.
    """
    missing = missing_behind(error) or declared_elsewhere(error, context)
    if missing is None or not (context.skips_missing or is_missing_window(missing)):
        return False
    entities = context.left_out.setdefault(missing, [])
    if not any(entity is known for known in entities):  # timers are evaluated twice
        entities.append(entity)
    return True


def is_missing_window(missing: Missing) -> bool:
    """Return whether what is missing only shows something on a screen."""
    return missing.kind == "package" and is_window(missing.name, missing.executable)


def missing_behind(error: BaseException | None) -> Missing | None:
    """Return what is missing behind an error."""
    while error is not None:
        if isinstance(error, PackageNotFoundError):
            return Missing(error.name)
        if isinstance(error, ExecutableNotFoundError):
            return Missing(error.package, executable=error.name)
        package = missing_module(error) or package_of_stand_in(str(error)) or mishandled(error)
        if package is not None:
            return Missing(package)
        if isinstance(error, LaunchFileError) and isinstance(error.__cause__, FileNotFoundError):
            return Missing(error.path, "file")
        if (program := missing_program(error)) is not None:
            return Missing(program, "program")
        error = error.__cause__ or error.__context__
    return None


def mishandled(error: BaseException) -> str | None:
    """Return the package of a stand-in that code could not handle, as the error says."""
    if not isinstance(error, TypeError) or StandIn.__name__ not in str(error):
        return None
    for frame, _ in reversed(list(traceback.walk_tb(error.__traceback__))):
        for value in frame.f_locals.values():
            if isinstance(value, StandIn):
                return package_of(value.describe())
    return None


def missing_program(error: BaseException) -> str | None:
    """Return the program that code of a launch file could not run, since it is not installed."""
    frames = [frame for frame, _ in traceback.walk_tb(error.__traceback__)]
    is_start = bool(frames) and frames[-1].f_globals.get("__name__") == subprocess.__name__
    if not (is_start and isinstance(error, FileNotFoundError)):
        return None
    return None if error.filename is None else str(error.filename)


def declared_elsewhere(error: BaseException | None, context: LaunchContext) -> Missing | None:
    """Return what is missing if an error is about an argument that it may have declared."""
    while error is not None:
        if isinstance(error, UnknownConfiguration):
            return next(
                (
                    missing
                    for missing, entities in reversed(context.left_out.items())
                    if any(isinstance(entity, IncludeLaunchDescription) for entity in entities)
                ),
                None,
            )
        error = error.__cause__ or error.__context__
    return None


def failure_of(entity: LaunchDescriptionEntity, error: Exception) -> LaunchFileError:
    """Return the error of an entity, at the line of the user's function or else its own."""
    path, _, line = where_of(entity).rpartition(":")
    for frame in reversed(traceback.extract_tb(error.__traceback__)):
        if frame.filename.endswith((".launch.py", "_launch.py")):
            path, line = frame.filename, str(frame.lineno)
            break
    problem = f"{type(entity).__name__}: {problem_of(error)}"
    return LaunchFileError(path, problem, line=int(line))


def arguments_of(description: Any, path: str) -> list[DeclareLaunchArgument]:
    """Return the arguments that a description declares, including those of its groups.

    Those of included files are listed if the file's path does not depend on arguments.
    """
    declared: dict[str, DeclareLaunchArgument] = {}
    context = new_context(path, {})

    def collect(entities: Iterable[Any], depth: int) -> None:
        for entity in entities:
            if isinstance(entity, DeclareLaunchArgument):
                declared.setdefault(entity.name, entity)
            elif isinstance(entity, LaunchDescription):
                collect(entity.entities, depth)
            elif isinstance(entity, IncludeLaunchDescription) and depth < MAX_DEPTH:
                try:
                    collect(
                        [entity.launch_description_source.get_launch_description(context)],
                        depth + 1,
                    )
                except Exception:  # noqa: BLE001, S112  # its path depends on arguments
                    continue
            elif isinstance(entity, GroupAction):
                collect(entity.get_sub_entities(), depth)
            elif isinstance(entity, TimerAction):
                collect(entity.actions, depth)

    collect([description], 0)
    return list(declared.values())
