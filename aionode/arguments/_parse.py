"""The ROS arguments of a program: those between ``--ros-args`` and ``--``.

::

    robot.py data.csv --ros-args -r chatter:=/talk -p rate:=10.0 --log-level debug -- --verbose

Each such block follows rcl's grammar; all other arguments belong to the program.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import PurePath

from msgspec import Struct, field

from aionode.arguments._parameter_yaml import (
    ParameterRule,
    ParameterValueType,
    matching_parameters,
    parse_value,
    read_parameter_file,
)
from aionode.errors import (
    InvalidLogLevelError,
    InvalidRemapRuleError,
    InvalidROSArgsError,
    ParameterFileError,
    UnknownROSArgsError,
)
from aionode.logging import LoggingSeverity, get_logging_severity_from_string
from aionode.names import RemapRule

__all__ = ["Arguments", "parse_arguments", "remove_ros_args"]

START, END = "--ros-args", "--"
VALUE = "value"  # the source in errors about values on the command line

ParameterFileReader = Callable[[str], Iterable[ParameterRule]]


class Arguments(Struct, frozen=True):
    """The parsed arguments.

    Attributes:
        remap_rules: The remapping rules, in order; the first match wins.
        parameter_rules: The rules from files and ``-p``, in order; the last match wins.
        params_files: Paths of the files that were read.
        log_level: The level of loggers that have none of their own.
        log_levels: Levels of individual loggers.
        log_config_file: A file to configure logging with.
        log_file_name: Prefix of the name of the log file.
        enclave: The security enclave.
        stdout_logs: Whether to log to the console.
        rosout_logs: Whether to log to `/rosout`.
        external_lib_logs: Whether to log to a file; None if not given.
        unparsed_ros_args: Unknown arguments between ``--ros-args`` and ``--``.
        non_ros_args: All other arguments, which belong to the program.
        warnings: Warnings for the user.
    """

    remap_rules: tuple[RemapRule, ...] = ()
    parameter_rules: tuple[ParameterRule, ...] = ()
    params_files: tuple[str, ...] = ()
    log_level: LoggingSeverity | None = None
    log_levels: dict[str, LoggingSeverity] = field(default_factory=dict)
    log_config_file: str | None = None
    log_file_name: str | None = None
    enclave: str | None = None
    stdout_logs: bool = True
    rosout_logs: bool = True
    external_lib_logs: bool | None = None
    unparsed_ros_args: tuple[str, ...] = ()
    non_ros_args: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def parameters_for(self, node_name: str) -> dict[str, ParameterValueType]:
        """Return the parameters for the node with this full name, after remapping."""
        return matching_parameters(self.parameter_rules, node_name)

    def log_file_prefix(self) -> str | None:
        """Return the prefix of the log file's name, or None for no log file.

        A file is written only on request: by ``--log-file-name``, or by
        ``--enable-external-lib-logs``, which names it after the program.
        """
        if self.external_lib_logs is None:
            return self.log_file_name
        if not self.external_lib_logs:
            return None
        program = PurePath(self.non_ros_args[0]).name if self.non_ros_args else "python"
        return self.log_file_name or program

    def refuse_unknown(self) -> None:
        """Raise if an argument between ``--ros-args`` and ``--`` is unknown.

        Raises:
            UnknownROSArgsError: One is unknown; the text names similar flags.
        """
        if not self.unparsed_ros_args:
            return
        import difflib  # for this error only

        word = self.unparsed_ros_args[0]
        alike = difflib.get_close_matches(word.partition("=")[0], [*VALUED, *SWITCHES], n=2)
        hint = f"did you mean {' or '.join(alike)}? " if alike else ""
        raise UnknownROSArgsError(
            list(self.unparsed_ros_args),
            f"unknown; {hint}The flags are {', '.join([*VALUED, *SWITCHES])}; arguments of the "
            f"program itself belong before {START} or after a closing {END}",
        )


def parse_arguments(
    args: Sequence[str], *, read_file: ParameterFileReader = read_parameter_file
) -> Arguments:
    """Parse a command line.

    Args:
        args: The command line, such as `sys.argv`.
        read_file: Reads a parameter file.

    Raises:
        InvalidROSArgsError: A flag lacks its value, or the value is invalid.
    """
    parser = Parser(read_file)
    remaining = list(args)
    inside = False
    while remaining:
        word = remaining.pop(0)
        if word == START:
            inside = True
        elif not inside:
            parser.outside(word)
        elif word == END:
            inside = False
        else:
            parser.inside(word, remaining)
    return parser.result()


def remove_ros_args(args: Sequence[str]) -> list[str]:
    """Return the arguments that belong to the program, in order."""
    own: list[str] = []
    inside = False
    for word in args:
        if word == START:
            inside = True
        elif not inside:
            if deprecated_rule(word) is None:
                own.append(word)
        elif word == END:
            inside = False
    return own


class Parser:
    """Collects the arguments of one command line."""

    def __init__(self, read_file: ParameterFileReader) -> None:
        self.read_file = read_file
        self.remap_rules: list[RemapRule] = []
        self.parameter_rules: list[ParameterRule] = []
        self.params_files: list[str] = []
        self.log_level: LoggingSeverity | None = None
        self.log_levels: dict[str, LoggingSeverity] = {}
        self.settings: dict[str, str] = {}
        self.switches: dict[str, bool] = {}
        self.unparsed: list[str] = []
        self.own: list[str] = []
        self.warnings: list[str] = []

    def outside(self, word: str) -> None:
        """Handle an argument outside of ``--ros-args`` blocks."""
        rule = deprecated_rule(word)
        if rule is None:
            self.own.append(word)
            return
        self.remap_rules.append(rule)
        self.warnings.append(
            f"Found remap rule '{word}'. This syntax is deprecated. "
            f"Use '{START} --remap {word}' instead."
        )

    def inside(self, word: str, rest: list[str]) -> None:
        """Handle an argument inside a block, and its value, if any, from `rest`."""
        if word in SWITCHES:
            setting, value = SWITCHES[word]
            self.switches[setting] = value
        elif word in VALUED:
            if not rest or rest[0] in {START, END}:
                raise InvalidROSArgsError(word, f"no value follows; it needs {FITS[word]}")
            value_word = rest.pop(0)
            try:
                VALUED[word](self, value_word)
            except InvalidRemapRuleError as error:
                raise InvalidROSArgsError(f"{word} {value_word}", error.problem) from error
            except ParameterFileError as error:
                where = f"line {error.line}: " if error.line and error.source != VALUE else ""
                problem = f"{where}{error.problem}"
                raise InvalidROSArgsError(f"{word} {value_word}", problem) from error
            except (InvalidLogLevelError, MalformedError) as error:
                raise InvalidROSArgsError(f"{word} {value_word}", str(error)) from error
        else:
            self.unparsed.append(word)

    def result(self) -> Arguments:
        """Return the parsed arguments."""
        return Arguments(
            remap_rules=tuple(self.remap_rules),
            parameter_rules=tuple(self.parameter_rules),
            params_files=tuple(self.params_files),
            log_level=self.log_level,
            log_levels=self.log_levels,
            log_config_file=self.settings.get("log_config_file"),
            log_file_name=self.settings.get("log_file_name"),
            enclave=self.settings.get("enclave"),
            stdout_logs=self.switches.get("stdout_logs", True),
            rosout_logs=self.switches.get("rosout_logs", True),
            external_lib_logs=self.switches.get("external_lib_logs"),
            unparsed_ros_args=tuple(self.unparsed),
            non_ros_args=tuple(self.own),
            warnings=tuple(self.warnings),
        )


# The values of flags


class MalformedError(ValueError):
    """A value does not have the form its flag requires; becomes an InvalidROSArgsError."""


PARAMETER = (
    r"(?sa)(?:(?P<node>/?[A-Za-z_]\w*(?:/[A-Za-z_]\w*)*):(?!=))?"
    r"(?P<name>[^:=\s]+):=(?P<value>.*)"
)


def add_remap(parser: Parser, text: str) -> None:
    """Handle the value of ``--remap``."""
    parser.remap_rules.append(RemapRule.parse(text))


def add_parameter(parser: Parser, text: str) -> None:
    """Handle the value of ``--param``."""
    parts = re.fullmatch(PARAMETER, text)
    if parts is None:
        message = "a parameter is 'name:=value' or 'node:name:=value'"
        raise MalformedError(message)
    node, name, value = parts.group("node", "name", "value")
    if node is None:
        node = "/**"
    elif "/" not in node:
        node = f"/**/{node}"  # a node of this name in any namespace
    elif not node.startswith("/"):
        node = f"/{node}"
    parser.parameter_rules.append(ParameterRule(node, name, parse_value(value, VALUE), text))


def add_file(parser: Parser, path: str) -> None:
    """Handle the value of ``--params-file``."""
    parser.parameter_rules.extend(parser.read_file(path))
    parser.params_files.append(path)


def set_log_level(parser: Parser, text: str) -> None:
    """Handle the value of ``--log-level``."""
    name, separator, level = text.rpartition(":=")
    if separator and not name:
        message = "the name of the logger is empty; a level is 'LEVEL' or 'name:=LEVEL'"
        raise MalformedError(message)
    severity = get_logging_severity_from_string(level)
    if separator:
        parser.log_levels[name] = severity
    else:
        parser.log_level = severity


def setting(name: str) -> Callable[[Parser, str], None]:
    """Return a function that stores the value of a flag; the last value wins."""

    def take(parser: Parser, value: str) -> None:
        parser.settings[name] = value

    return take


VALUED: dict[str, Callable[[Parser, str], None]] = {
    "--remap": add_remap,
    "-r": add_remap,
    "--param": add_parameter,
    "-p": add_parameter,
    "--params-file": add_file,
    "--log-level": set_log_level,
    "--log-config-file": setting("log_config_file"),
    "--log-file-name": setting("log_file_name"),
    "--enclave": setting("enclave"),
    "-e": setting("enclave"),
}

FITS = {
    "--remap": "a rule 'from:=to'",
    "-r": "a rule 'from:=to'",
    "--param": "a parameter 'name:=value'",
    "-p": "a parameter 'name:=value'",
    "--params-file": "the path of a parameter file",
    "--log-level": "a level such as 'debug', or 'logger:=debug'",
    "--log-config-file": "the path of a file",
    "--log-file-name": "the beginning of a file's name",
    "--enclave": "the path of an enclave",
    "-e": "the path of an enclave",
}

SWITCHES = {
    f"--{verb}-{what}-logs": (f"{what.replace('-', '_')}_logs", verb == "enable")
    for what in ("stdout", "rosout", "external-lib")
    for verb in ("enable", "disable")
}


def deprecated_rule(word: str) -> RemapRule | None:
    """Parse an argument outside of blocks as a remap rule; None if it is not one."""
    if ":=" not in word:
        return None
    try:
        return RemapRule.parse(word)
    except InvalidRemapRuleError:
        return None
