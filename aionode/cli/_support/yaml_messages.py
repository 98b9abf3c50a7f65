"""Messages from YAML typed by a user."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from aionode.errors import CommandError, MessageError
from aionode.message import check, fields, from_builtins, type_name

if TYPE_CHECKING:
    from aionode.clock import Time
    from aionode.message import Message

__all__ = ["Filler", "message_from_yaml", "shortened"]

HEADER = "std_msgs/msg/Header"
TIME = "builtin_interfaces/msg/Time"


def plain_values(text: str, what: str) -> dict[str, Any]:
    """Parse a YAML text and return its mapping as plain values.

    Raises:
        CommandError: the text is not valid YAML, or not a mapping.
    """
    import yaml

    from aionode._process.bounded_yaml import documents_in

    try:
        documents = [value for value in documents_in(text, loader()) if value is not None]
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = "" if mark is None else f" at line {mark.line + 1}, column {mark.column + 1}"
        if mark is not None and mark.line >= len(text.splitlines()):
            where = " at its end"
        problem = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise CommandError(
            f"The passed value is not valid YAML: {shortened(text)}{where}: {problem}; "
            f"expected {what}"
        ) from error
    if len(documents) > 1:
        raise CommandError(
            f"The passed value has {len(documents)} YAML documents: {shortened(text)}; expected one"
        )
    # `topic echo` prints `---` after each message, which starts another, empty document.
    values = documents[0] if documents else {}
    if isinstance(values, str) and UNSEPARATED.match(values):
        raise unseparated(values)
    if not isinstance(values, dict):
        raise CommandError(
            "The passed value needs to be a dictionary in YAML format: "
            f"{shortened(text)} is a {type(values).__name__}; expected {what}"
        )
    return values


def loader() -> Any:
    """Return PyYAML's safe loader, with dates as strings: no ROS field holds a date."""
    import yaml

    base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # libyaml is optional
    resolvers = {
        first: [(tag, regexp) for tag, regexp in pairs if not tag.endswith(":timestamp")]
        for first, pairs in base.yaml_implicit_resolvers.items()
    }
    return type("Loader", (base,), {"yaml_implicit_resolvers": resolvers})


def shortened(text: str) -> str:
    """Return the beginning of a text, quoted and on one line."""
    limit = 60
    return repr(text if len(text) <= limit else f"{text[:limit]}...")


def example_of(msg_type: type[Message]) -> str:
    """Return an example of values for a type, in YAML."""
    names = [field.name for field in fields(msg_type)]
    return f"'{{{names[0]}: ...}}'" if names else "'{}'"


def message_from_yaml(msg_type: type[Message], text: str) -> Message:
    """Return the message for values typed in YAML.

    Raises:
        CommandError: the values do not fit the type.
    """
    return message_from(msg_type, plain_values(text, example_of(msg_type)))


UNSEPARATED = re.compile(r"\w+:\S")
"""A key and a value without the space between them, which YAML reads as one word."""


def expect_separated(values: object) -> None:
    """Raise CommandError for a key that contains its value: ``order:3``."""
    seen: set[int] = set()  # YAML aliases allow a value to contain itself
    waiting = [values]
    while waiting:
        value = waiting.pop()
        if id(value) in seen:
            continue
        seen.add(id(value))
        if isinstance(value, list):
            waiting.extend(value)
        elif isinstance(value, dict):
            waiting.extend(value.values())
            for key in value:
                if value[key] is None and isinstance(key, str) and UNSEPARATED.match(key):
                    raise unseparated(key)


def unseparated(pair: str) -> CommandError:
    """Return the error for a key and a value without the space between them."""
    meant = shortened(pair.replace(":", ": ", 1))
    return CommandError(
        f"The passed value has the field {shortened(pair)}; YAML requires a space after the colon: "
        f"{meant}"
    )


def message_from(msg_type: type[Message], values: dict[str, Any]) -> Message:
    """Return the message with the given field values."""
    try:
        msg = from_builtins(msg_type, values)
        check(msg)
    except MessageError as error:
        expect_separated(values)
        raise CommandError(f"Failed to populate field: {error}") from error
    return msg


class Filler:
    """Creates messages from YAML in which a Header may be ``auto`` and a Time ``now``.

    Raises:
        CommandError: the text does not fit the type.
    """

    def __init__(self, msg_type: type[Message], text: str) -> None:
        self._stamps: list[Callable[[Message, Any], None]] = []
        values = plain_values(text, example_of(msg_type))
        self._strip(msg_type, values, ())
        self._message = message_from(msg_type, values)

    def message(self, now: Time) -> Message:
        """Return the message, with every ``auto`` and ``now`` replaced by `now`."""
        for stamp in self._stamps:
            stamp(self._message, now.to_msg())
        return self._message

    def _strip(
        self, msg_type: type[Message], values: dict[str, Any], path: tuple[str, ...]
    ) -> None:
        """Remove every ``auto`` and ``now`` from `values`, and remember their fields."""
        for field in fields(msg_type):
            nested, value = field.type.nested, values.get(field.name)
            if nested is None or field.type.container != "single":
                continue
            here = (*path, field.name)
            if value == "auto" and type_name(nested) == HEADER:
                values[field.name] = {}
                self._stamps.append(setter((*here, "stamp")))
            elif value == "now" and type_name(nested) == TIME:
                values[field.name] = {}
                self._stamps.append(setter(here))
            elif isinstance(value, dict):
                self._strip(nested, value, here)


def setter(path: tuple[str, ...]) -> Callable[[Any, Any], None]:
    """Return a function that sets the field at `path` of a message."""

    def set_field(msg: Any, value: Any) -> None:
        for name in path[:-1]:
            msg = getattr(msg, name)
        setattr(msg, path[-1], value)

    return set_field
