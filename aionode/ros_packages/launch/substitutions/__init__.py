"""`launch.substitutions`."""

from __future__ import annotations

import importlib
import math
import os
import selectors
import shlex
import shutil
import subprocess
import sysconfig
import uuid
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Self

from aionode._packages import is_starter_file
from aionode._process.bounded_files import MAX_FILE, read_file
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    TextSubstitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    text_of,
)
from launch.utilities.type_utils import coerce_to_type

__all__ = [
    "AllSubstitution",
    "AndSubstitution",
    "AnonName",
    "AnySubstitution",
    "Command",
    "EnvironmentVariable",
    "EqualsSubstitution",
    "FileContent",
    "FindExecutable",
    "ForEachVar",
    "ForLoopIndex",
    "IfElseSubstitution",
    "LaunchConfiguration",
    "LaunchLogDir",
    "LocalSubstitution",
    "NotEqualsSubstitution",
    "NotSubstitution",
    "OrSubstitution",
    "PathJoinSubstitution",
    "PathSubstitution",
    "PythonExpression",
    "StringJoinSubstitution",
    "SubstitutionFailure",
    "TextSubstitution",
    "ThisLaunchFile",
    "ThisLaunchFileDir",
]


def boolean(context: LaunchContext, sub: SomeSubstitutionsType) -> bool:
    """Return the truth value of a text."""
    text = text_of(context, sub)
    try:
        return bool(coerce_to_type(text, bool))
    except ValueError as error:
        raise SubstitutionFailure(f"{error}; use true or false") from error


class UnknownConfiguration(SubstitutionFailure):
    """There is no launch configuration with the given name."""


class LaunchConfiguration(Substitution):
    """The value of a launch configuration, such as an argument."""

    _Substitution__second_word = "default"

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self.variable_name = normalize_to_list_of_substitutions(variable_name)
        if default is None:
            self._LaunchConfiguration__default = None
        elif isinstance(default, str | Substitution):
            self._LaunchConfiguration__default = normalize_to_list_of_substitutions(default)
        elif isinstance(default, Iterable):
            self._LaunchConfiguration__default = normalize_to_list_of_substitutions(
                [part if isinstance(part, str | Substitution) else str(part) for part in default]
            )
        else:
            self._LaunchConfiguration__default = normalize_to_list_of_substitutions(str(default))

    def describe(self) -> str:
        """Return the name."""
        return f"LaunchConfig({''.join(sub.describe() for sub in self.variable_name)})"

    def perform(self, context: LaunchContext) -> str:
        """Return the value, or the default."""
        name = perform_substitutions(context, self.variable_name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self._LaunchConfiguration__default is None:
            known = ", ".join(sorted(context.launch_configurations)) or "none"
            problem = f"launch configuration '{name}' does not exist here; known are: {known}"
            raise UnknownConfiguration(problem)
        return perform_substitutions(context, self._LaunchConfiguration__default)


class WithDefault(Substitution):
    """The value of a name, or a default."""

    _Substitution__second_word = "default_value"
    _WithDefault__problem = "'{}' does not exist"

    def __init__(
        self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None
    ) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.default_value = default_value

    def _WithDefault__find(self, context: LaunchContext, name: str) -> str | None:
        """Return the value, if there is one."""
        raise NotImplementedError(f"{type(self).__name__}.find")

    def perform(self, context: LaunchContext) -> str:
        """Return the value, or the default."""
        name = perform_substitutions(context, self.name)
        value = self._WithDefault__find(context, name)
        if value is not None:
            return value
        if self.default_value is None:
            raise SubstitutionFailure(self._WithDefault__problem.format(name))
        return text_of(context, self.default_value)


class EnvironmentVariable(WithDefault):
    """The value of an environment variable."""

    _WithDefault__problem = "environment variable '{}' does not exist"

    def _WithDefault__find(self, context: LaunchContext, name: str) -> str | None:
        """Return the value, if there is one."""
        return context.environment.get(name)


class PathJoinSubstitution(Substitution):
    """Parts of a path, joined."""

    def __init__(self, substitutions: Iterable[Any]) -> None:
        self.substitutions = [normalize_to_list_of_substitutions(part) for part in substitutions]

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return os.path.join(*(perform_substitutions(context, part) for part in self.substitutions))  # noqa: PTH118  # as launch: a trailing slash stays

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.substitutions, other])


class PathSubstitution(PathJoinSubstitution):
    """A path that ``/`` extends."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        super().__init__([path])


class StringJoinSubstitution(Substitution):
    """Texts, joined by a delimiter."""

    def __init__(self, substitutions: Iterable[Any], delimiter: SomeSubstitutionsType = "") -> None:
        self.substitutions = [normalize_to_list_of_substitutions(part) for part in substitutions]
        self.delimiter = delimiter

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        texts = (perform_substitutions(context, part) for part in self.substitutions)
        return text_of(context, self.delimiter).join(texts)


class ThisLaunchFile(Substitution):
    """The path of the launch file."""

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return str(context.locals.current_launch_file_path)


class ThisLaunchFileDir(Substitution):
    """The folder of the launch file."""

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return str(context.locals.current_launch_file_directory)


class LaunchLogDir(Substitution):
    """The folder of logs."""

    def perform(self, context: LaunchContext) -> str:
        """Return the path: ROS_LOG_DIR, or log below ROS_HOME."""
        home = context.environment.get("ROS_HOME") or str(Path.home() / ".ros")
        return context.environment.get("ROS_LOG_DIR") or str(Path(home, "log"))


class LocalSubstitution(Substitution):
    """A value that an entity left for later ones."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression = expression

    def perform(self, context: LaunchContext) -> str:
        """Return the value of an expression such as ``event.returncode``."""
        try:
            return str(eval("context.locals." + self.expression, {}, {"context": context}))  # noqa: S307  # the launch file is the user's own program
        except Exception:
            context.need_present(self.describe())
            raise


class ForEachVar(WithDefault):
    """The current value of a ``for_each`` in a file."""

    _WithDefault__problem = "no enclosing loop has '{}', and there is no default"

    @staticmethod
    def get_local_arg_name(name: str) -> str:
        """Return the name of the value in `locals`."""
        return f"ForEachVar__{name}"

    def _WithDefault__find(self, context: LaunchContext, name: str) -> str | None:
        """Return the value, if there is one."""
        return context.get_locals_as_dict().get(self.get_local_arg_name(name))


class ForLoopIndex(ForEachVar):
    """The current number of a ``for`` in a file."""


class AnonName(Substitution):
    """A name with a random suffix, the same each time within one description."""

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    def perform(self, context: LaunchContext) -> str:
        """Return the name."""
        name = perform_substitutions(context, self.name)
        key = f"anon{name}"
        if key not in context.launch_configurations:
            end = f"{os.uname().nodename}_{os.getpid()}_{uuid.uuid4().hex[:16]}"
            safe = "".join(char if char.isalnum() else "_" for char in end)
            context.launch_configurations[key] = f"{name}_{safe}"
        return str(context.launch_configurations[key])


class FindExecutable(Substitution):
    """The path of a program, searched as a shell does."""

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self.name = normalize_to_list_of_substitutions(name)

    @classmethod
    def _Substitution__of_words(cls, *words: Any) -> Self:
        """Return the substitution for ``$(find-exec name)``."""
        return cls(name=words[0])

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        name = perform_substitutions(context, self.name)
        program = program_of(name, context)
        if program is None:
            raise SubstitutionFailure(f"executable {missing_program(name)}")
        return program


def program_of(name: str, context: LaunchContext) -> str | None:
    """Return the path of a program on the PATH, or installed beside this Python.

    The PATH lacks the latter if this Python's environment is not activated.
    """
    found = shutil.which(name, path=context.environment.get("PATH"))
    if found is not None and not is_starter_file(found):
        return found
    return shutil.which(name, path=sysconfig.get_path("scripts")) or found


def missing_program(name: str) -> str:
    """Return the error text for a missing program, with its remedy."""
    remedy = "; pip install 'aionode[xacro]' installs it" if Path(name).name == "xacro" else ""
    return f"{name!r} not found on the PATH{remedy}"


class FileContent(Substitution):
    """The text of a file."""

    def __init__(self, path: SomeSubstitutionsType) -> None:
        self.path = normalize_to_list_of_substitutions(path)

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        context.need_present(self.describe())
        path = Path(perform_substitutions(context, self.path))
        try:
            return read_file(path).decode()
        except OSError as error:
            raise SubstitutionFailure(f"failed to open {path}: {error.strerror}") from error


class Command(Substitution):
    """The output of a command, such as xacro."""

    _Substitution__second_word = "on_stderr"

    def __init__(
        self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = "fail"
    ) -> None:
        self.command = normalize_to_list_of_substitutions(command)
        self.on_stderr = normalize_to_list_of_substitutions(on_stderr)

    def perform(self, context: LaunchContext) -> str:
        """Return the output."""
        context.need_present(self.describe())
        line = perform_substitutions(context, self.command)
        on_stderr = perform_substitutions(context, self.on_stderr)
        if on_stderr not in ("fail", "ignore", "warn", "capture"):
            raise SubstitutionFailure(
                f"on_stderr is {on_stderr!r}; use fail, ignore, warn or capture"
            )
        stderr = subprocess.STDOUT if on_stderr == "capture" else subprocess.PIPE
        try:
            words = shlex.split(line)
        except ValueError as error:
            raise SubstitutionFailure(f"command {line!r} cannot be parsed: {error}") from error
        if not words:
            raise SubstitutionFailure("the command is empty")
        program = program_of(words[0], context)
        if program is None:
            raise SubstitutionFailure(f"command {line!r}: {missing_program(words[0])}")
        options = ("--stand-ins",) if context.skips_missing else ()
        try:
            process = subprocess.Popen(  # noqa: S603  # the command of the user's file
                [*context.packages.starter(Path(program), options), *words[1:]],
                stdout=subprocess.PIPE,
                stderr=stderr,
                env=context.environment,
            )
        except OSError as error:
            raise SubstitutionFailure(f"command {line!r} cannot be run: {error}") from error
        output, errors = outputs_of(process, line)
        if process.returncode != 0:
            said = errors.rstrip()
            if "No module named 'ament_index_python'" in said:
                said += f"; {program} runs in another Python: pip install 'aionode[xacro]'"
            raise SubstitutionFailure(
                f"command {line!r} ended with status {process.returncode}: {said}"
            )
        if errors and on_stderr == "fail":
            raise SubstitutionFailure(
                f"command {line!r} wrote to stderr: {errors.rstrip()}; "
                "on_stderr='ignore' accepts that"
            )
        return output


def outputs_of(process: subprocess.Popen[bytes], line: str) -> tuple[str, str]:
    """Return a command's output on stdout and stderr, after it has ended.

    Raises:
        SubstitutionFailure: it writes more than a file may contain.
    """
    pieces: dict[str, list[bytes]] = {"stdout": [], "stderr": []}
    left = MAX_FILE
    with process, selectors.DefaultSelector() as selector:
        for name in pieces:
            if (pipe := getattr(process, name)) is not None:
                selector.register(pipe, selectors.EVENT_READ, name)
        try:
            while selector.get_map() and left >= 0:
                for key, _ in selector.select():
                    piece = os.read(key.fd, 64 << 10)
                    pieces[key.data].append(piece)
                    left -= len(piece)
                    if not piece:
                        selector.unregister(key.fileobj)
        finally:
            # too much output, or Ctrl-C: otherwise we would wait for its end
            if selector.get_map():
                process.kill()
    if left < 0:
        raise SubstitutionFailure(f"command {line!r} writes more than {MAX_FILE} bytes")
    output, said = (b"".join(each).decode(errors="replace") for each in pieces.values())
    return output, said


class PythonExpression(Substitution):
    """The value of a Python expression, as text."""

    def __init__(
        self,
        expression: SomeSubstitutionsType,
        python_modules: SomeSubstitutionsType = ("math",),
    ) -> None:
        self.expression = normalize_to_list_of_substitutions(expression)
        self.python_modules = normalize_to_list_of_substitutions(python_modules)

    @classmethod
    def _Substitution__of_words(cls, *words: Any) -> Self:
        """Return the substitution for ``$(eval 'expression' 'module, module')``."""
        if len(words) < 2:
            return cls(words[0])
        names = "".join(getattr(word, "text", "") for word in words[1]).split(",")
        return cls(words[0], [name.strip() for name in names])

    def perform(self, context: LaunchContext) -> str:
        """Return the value."""
        known: dict[str, Any] = {}
        for sub in self.python_modules:
            module = importlib.import_module(context.perform_substitution(sub))
            if module is math:
                known.update(vars(math))
            known[module.__name__] = module
        expression = perform_substitutions(context, self.expression)
        try:
            return str(eval(expression, {}, known))  # noqa: S307  # the launch file is the user's own program
        except Exception as error:
            context.need_present(self.describe())  # it may concern an event
            raise SubstitutionFailure(
                f"expression {expression!r} fails: {type(error).__name__}: {error}"
            ) from error


def as_text(value: Any) -> Any:
    """Return a value in the form that `EqualsSubstitution` compares."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    return value if isinstance(value, Substitution | list | tuple | str) else str(value)


class EqualsSubstitution(Substitution):
    """Whether two texts are equal: as truth values, as numbers or literally."""

    def __init__(self, left: Any, right: Any) -> None:
        self.left = normalize_to_list_of_substitutions(as_text(left))
        self.right = normalize_to_list_of_substitutions(as_text(right))

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        left = perform_substitutions(context, self.left)
        right = perform_substitutions(context, self.right)
        truths = {"true": True, "1": True, "false": False, "0": False}
        if left.lower() in truths and right.lower() in truths:
            return str(truths[left.lower()] == truths[right.lower()]).lower()
        try:
            return str(math.isclose(float(left), float(right))).lower()
        except ValueError:
            return str(left == right).lower()


class NotEqualsSubstitution(EqualsSubstitution):
    """Whether two texts differ."""

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return "false" if super().perform(context) == "true" else "true"


class NotSubstitution(Substitution):
    """The negation of a condition."""

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self.value = value

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return str(not boolean(context, self.value)).lower()


class AnySubstitution(Substitution):
    """Whether any of several conditions holds."""

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self._AnySubstitution__parts = args

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return str(any(boolean(context, part) for part in self._AnySubstitution__parts)).lower()


class AllSubstitution(Substitution):
    """Whether all of several conditions hold."""

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self._AllSubstitution__parts = args

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return str(all(boolean(context, part) for part in self._AllSubstitution__parts)).lower()


class AndSubstitution(AllSubstitution):
    """Whether both conditions hold."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)


class OrSubstitution(AnySubstitution):
    """Whether one of two conditions holds."""

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)


class IfElseSubstitution(Substitution):
    """One of two texts."""

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        self.condition, self.if_value, self.else_value = condition, if_value, else_value

    def perform(self, context: LaunchContext) -> str:
        """Return the text that the condition selects."""
        chosen = self.if_value if boolean(context, self.condition) else self.else_value
        return text_of(context, chosen)
