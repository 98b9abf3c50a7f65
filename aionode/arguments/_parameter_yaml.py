"""Parameter files: YAML with the rules of rcl.

::

    /ns/node:               # a node; /* matches one token, /** any number of tokens
      ros__parameters:
        rate: 10.0
        camera:
          frame: "front"    # the parameter camera.frame

Scalars have the types that rcl gives them, which are neither YAML 1.1's nor YAML 1.2's: a plain
``1e3`` is a double, ``yes`` a bool, ``null`` a string. This module therefore reads the events of
the YAML parser, not its values.
"""

from __future__ import annotations

import base64
import re
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from msgspec import Struct

from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import VALUES_VARIABLE, fast_loader, most_values
from aionode.errors import ParameterFileError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

__all__ = [
    "ParameterRule",
    "ParameterValueType",
    "matching_parameters",
    "parse_parameter_yaml",
    "parse_scalar",
    "parse_value",
    "read_parameter_file",
]

ParameterValueType = (
    bool
    | int
    | float
    | str
    | bytes
    | list[bool]
    | list[int]
    | list[float]
    | list[str]
    | list[bytes]
)
"""The values that a parameter in a file may have."""

PARAMETERS_KEY = "ros__parameters"

TRUE = {"y", "Y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"}
FALSE = {"n", "N", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"}
INFINITY = {".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"}
MINUS_INFINITY = {"-.inf", "-.Inf", "-.INF"}
NOT_A_NUMBER = {".nan", ".NaN", ".NAN"}

# rcl reads numbers by C's strtoll with base 0 and strtod; these patterns accept the same.
MAX_INTEGER = 100  # digits: far more than 64 bits need, far fewer than Python refuses
INTEGER = r"[+-]?(?:0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)"
DECIMAL = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
HEXADECIMAL = r"[+-]?0[xX](?:[0-9a-fA-F]+(?:\.[0-9a-fA-F]*)?|\.[0-9a-fA-F]+)(?:[pP][+-]?[0-9]+)?"
SIGNIFICANT = r"(?i)^[+-]?(?:0x[0.]*[1-9a-f]|[0.]*[1-9])"
WORDS = r"(?ai)[+-]?(?:inf|infinity|nan)"

MAX_DEPTH = 100  # nested mappings: more parts than any name has, few enough for Python's stack

NODE_PART = r"\*\*?|[A-Za-z_][A-Za-z0-9_]*"


class ParameterRule(Struct, frozen=True):
    """One parameter for the nodes whose full name matches.

    Attributes:
        node: Full name of a node, in which ``*`` stands for one token and ``**`` for any number.
        name: Name of the parameter.
        value: Its value.
        typed: The text after ``-p``; empty for a parameter of a file.
    """

    node: str
    name: str
    value: ParameterValueType
    typed: str = ""

    def matches(self, node_name: str) -> bool:
        """Return whether the rule is for the node with this full name."""
        return node_pattern(self.node).fullmatch(node_name) is not None


@lru_cache(maxsize=1024)
def node_pattern(node: str) -> re.Pattern[str]:
    """Return a regular expression for the full names that a rule's node matches."""
    wild = {"/*": r"/\w+", "/**": r"(?:/\w+)*"}
    tokens = re.findall("/[^/]+", node)
    return re.compile("".join(wild.get(token) or re.escape(token) for token in tokens))


def matching_parameters(
    rules: Iterable[ParameterRule], node_name: str
) -> dict[str, ParameterValueType]:
    """Return the parameters of the node with this full name; the last rule that matches wins."""
    return {rule.name: rule.value for rule in rules if rule.matches(node_name)}


# Values


def parse_scalar(text: str) -> bool | int | float | str:
    """Return the value that rcl gives to a scalar without quotes."""
    if text in TRUE or text in FALSE:
        return text in TRUE
    if re.fullmatch(INTEGER, text) and len(text) < MAX_INTEGER:
        number = int(text, 0) if "x" in text.lower() else int(text, 8 if is_octal(text) else 10)
        if -(2**63) <= number < 2**63:
            return number
    if text in NOT_A_NUMBER:
        return float("nan")
    if text in INFINITY or text in MINUS_INFINITY:
        return float("-inf" if text in MINUS_INFINITY else "inf")
    return parse_double(text)


def is_octal(text: str) -> bool:
    """Return whether C parses an integer in base 8."""
    return text.lstrip("+-").startswith("0")


def parse_double(text: str) -> float | str:
    """Return the number that strtod parses; the text if there is none, or it has no room for it."""
    if re.fullmatch(WORDS, text):
        return float(text)
    number = None
    if re.fullmatch(DECIMAL, text):
        number = float(text)
    elif re.fullmatch(HEXADECIMAL, text):
        try:
            number = float.fromhex(text)
        except OverflowError:
            return text
    if number is None or abs(number) == float("inf"):
        return text
    is_lost = number == 0 and re.search(SIGNIFICANT, text) is not None  # too small for a double
    return text if is_lost else number


def parse_value(text: str, source: str = "value") -> ParameterValueType:
    """Return the value of a parameter as given on a command line: a scalar or a list of scalars.

    Args:
        text: The value, in YAML.
        source: Its name in errors.

    Raises:
        ParameterFileError: It is neither.
    """
    events = Events(text, source)
    if events.at("StreamEnd"):
        events.fail("no value; for an empty string write ''")
    events.take("DocumentStart")
    value = read_value(events)
    events.take("DocumentEnd")
    if not events.at("StreamEnd"):
        events.fail("more than one value")
    return value


# Files


def read_parameter_file(path: str | Path) -> tuple[ParameterRule, ...]:
    """Return the rules of a file, in its order.

    Raises:
        ParameterFileError: It cannot be read, or is not a parameter file.
    """
    try:
        text = read_file(path).decode()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise ParameterFileError(str(path), 0, f"cannot be read: {reason}") from error
    return parse_parameter_yaml(text, str(path))


def parse_parameter_yaml(text: str, source: str = "parameters") -> tuple[ParameterRule, ...]:
    """Return the rules of a parameter file's text, in its order.

    Raises:
        ParameterFileError: It is not a parameter file; the error has the line.
    """
    events = Events(text, source)
    rules: list[ParameterRule] = []
    while not events.at("StreamEnd"):
        events.take("DocumentStart")
        if events.at("MappingStart"):
            rules.extend(read_nodes(events, ()))
        elif not events.is_empty_scalar():
            events.fail("a parameter file maps names of nodes to 'ros__parameters'")
        else:
            events.take("Scalar")
        events.take("DocumentEnd")
    return tuple(rules)


class Events:
    """The events of the YAML parser, with one event of lookahead; errors have file and line."""

    def __init__(self, text: str, source: str) -> None:
        import yaml

        self.source = source
        self.depth = 0
        self.left = most_values()
        self._error = yaml.YAMLError
        self._events = self._wrapped(yaml.parse(text, Loader=fast_loader()))
        self.next: Any = next(self._events)
        self.take("StreamStart")

    def _wrapped(self, events: Iterator[Any]) -> Iterator[Any]:
        try:
            yield from events
        except (self._error, ValueError) as error:  # ValueError: a character that YAML forbids
            mark = getattr(error, "problem_mark", None)
            problem = getattr(error, "problem", None) or str(error).partition("\n")[0]
            line = mark.line + 1 if mark else 0
            raise ParameterFileError(self.source, line, f"not YAML: {problem}") from error
        while True:  # after the end
            yield None

    def at(self, kind: str) -> bool:
        """Return whether the next event is of this kind."""
        return type(self.next).__name__ == f"{kind}Event"

    def is_empty_scalar(self) -> bool:
        """Return whether the next event is the scalar that YAML inserts for a missing value."""
        return self.at("Scalar") and self.next.value == "" and not self.next.style

    def take(self, kind: str) -> Any:
        """Return the next event, which must be of this kind, and advance."""
        event = self.next
        if event is None or type(event).__name__ != f"{kind}Event":
            self.fail(f"{describe(event)} where a {kind.lower()} was expected")
        self.depth += {"MappingStart": 1, "MappingEnd": -1}.get(kind, 0)
        if self.depth > MAX_DEPTH:
            self.fail(f"nested deeper than {MAX_DEPTH}")
        self.left -= kind == "Scalar"
        if self.left < 0:
            self.fail(f"more than {most_values()} values; {VALUES_VARIABLE} raises the limit")
        self.next = next(self._events)
        return event

    def fail(self, problem: str) -> NoReturn:
        """Raise the error for the next event."""
        line = self.next.start_mark.line + 1 if self.next is not None else 0
        raise ParameterFileError(self.source, line, problem)


def describe(event: Any) -> str:
    """Return a description of an event for an error."""
    return {
        "AliasEvent": "an alias (rcl supports none)",
        "MappingStartEvent": "a mapping",
        "SequenceStartEvent": "a sequence",
        "ScalarEvent": f"the value '{getattr(event, 'value', '')}'",
    }.get(type(event).__name__, "nothing")


def read_nodes(events: Events, above: tuple[str, ...]) -> Iterator[ParameterRule]:
    """Read a mapping of names, nested to any depth, down to the parameters."""
    events.take("MappingStart")
    while not events.at("MappingEnd"):
        key = read_key(events)
        if key == PARAMETERS_KEY:
            if not above:
                events.fail(f"there is no name of a node before '{PARAMETERS_KEY}'")
            node = node_name(events, above)
            yield from (
                ParameterRule(node, *parameter) for parameter in read_parameters(events, "")
            )
        elif events.at("MappingStart"):
            yield from read_nodes(events, (*above, key))
        else:
            events.fail(f"{describe(events.next)} before '{PARAMETERS_KEY}'")
    events.take("MappingEnd")


def read_key(events: Events) -> str:
    """Read the key of a mapping."""
    if not events.at("Scalar"):
        events.fail(f"{describe(events.next)} cannot be a key")
    if events.next.value == "":
        events.fail("no key")
    key: str = events.take("Scalar").value
    return key


def node_name(events: Events, parts: tuple[str, ...]) -> str:
    """Return the full name, wildcards included, of a node whose name is spread over keys."""
    name = ""
    for part in parts:
        name += part if not name or name.endswith("/") else f"/{part}"
    full = name if name.startswith("/") else f"/{name}"
    for token in full[1:].split("/"):
        if not token:
            events.fail(f"'{full}' contains repeated forward slashes or ends with one")
        if not re.fullmatch(NODE_PART, token):
            events.fail(
                f"'{token}' in '{full}' is not a token of a node's name; use letters, digits and "
                "'_', or '*' or '**' alone"
            )
    return full


def read_parameters(events: Events, prefix: str) -> Iterator[tuple[str, ParameterValueType]]:
    """Read a mapping of parameters, joining nested names with dots."""
    if not events.at("MappingStart"):
        events.fail(f"{describe(events.next)} where parameters were expected, each 'name: value'")
    events.take("MappingStart")
    while not events.at("MappingEnd"):
        name = prefix + read_key(events)
        if events.at("MappingStart"):
            yield from read_parameters(events, f"{name}.")
        else:
            yield name, read_value(events)
    events.take("MappingEnd")


def read_value(events: Events) -> ParameterValueType:
    """Read a scalar or a sequence of scalars of one type."""
    if not events.at("SequenceStart"):
        return read_scalar(events, bytes_too=False)
    events.take("SequenceStart")
    values: list[Any] = []
    while not events.at("SequenceEnd"):
        if not events.at("Scalar"):
            events.fail(f"{describe(events.next)} in a sequence; only scalars are allowed there")
        text = events.next.value
        value = read_scalar(events, bytes_too=True)
        if values and type(value) is not type(values[0]):
            kinds = {bool: "bool", int: "integer", float: "double", str: "string", bytes: "byte"}
            events.fail(
                f"Sequence should be of same type: it starts with type {kinds[type(values[0])]}, "
                f"and '{text}' is of type {kinds[type(value)]}"
            )
        values.append(value)
    events.take("SequenceEnd")
    return values


def read_scalar(events: Events, *, bytes_too: bool) -> bool | int | float | str | bytes:
    """Read one scalar.

    Args:
        events: What follows in the file.
        bytes_too: Whether ``!!binary`` stands for bytes, as ``ros2 param dump`` writes the elements
            of a list of bytes; else for its text, as for rcl, which has no parameter of one byte.
    """
    if events.is_empty_scalar():
        events.fail("no value; for an empty string write ''")
    event = events.take("Scalar")
    text: str = event.value
    if event.style in {"'", '"'} or event.tag == "tag:yaml.org,2002:str":
        return text
    if event.tag == "tag:yaml.org,2002:binary":
        if not bytes_too:
            return text
        try:
            return base64.b64decode(text)
        except ValueError as error:
            events.fail(f"'{text}' is not in Base64: {error}")
    return parse_scalar(text)
