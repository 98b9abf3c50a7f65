"""Parses the text of ``.msg``, ``.srv`` and ``.action`` files.

Each line has one member: ``type name``, ``type name default`` or ``type NAME=value``. ``#`` starts
a comment, ``---`` separates the messages of services and actions.
"""

from __future__ import annotations

import dataclasses
import difflib
import re
import sys
from collections.abc import Iterator
from keyword import iskeyword

from aionode.errors import IdlError, MessageError
from aionode.idl._definition import (
    HALVES,
    InterfaceText,
    LineError,
    MemberText,
    MessageText,
    TypeText,
    split_type_name,
)
from aionode.message import DTYPES, FieldType, fit, fit_element

__all__ = ["BUILTINS", "MAX_TEXT", "PRIMITIVES", "checked", "field_name", "parse", "unescaped"]

PRIMITIVES = frozenset({*DTYPES, "byte", "string", "wstring"})
BUILTINS = {
    "time": "builtin_interfaces/Time",
    "duration": "builtin_interfaces/Duration",
}
"""ROS 1 types without a package, and their ROS 2 counterparts."""

STRINGS = frozenset({"string", "wstring"})

TYPE = re.compile(
    r"(?P<name>[A-Za-z][A-Za-z0-9_]*(?:/[A-Za-z][A-Za-z0-9_]*){0,2})"
    r"(?:<=(?P<string_bound>\d+))?"
    r"(?P<brackets>\[(?P<upper><=)?(?P<size>\d*)\])?"
)
MESSAGE_NAME = re.compile(r"(?:[a-z][a-z0-9_]*/(?:msg/)?)?[A-Z][A-Za-z0-9]*")
FIELD_NAME = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*")
RECORDED_TYPE = re.compile(r"(?:[a-zA-Z]\w*/(?:msg/)?)?[A-Za-z]\w*", re.ASCII)
RECORDED_NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)
"""Types and names in recordings: ROS 1 allowed more, as does rosidl on request."""

CONSTANT_NAME = re.compile(r"[A-Z][A-Z0-9]*(?:_[A-Z0-9]+)*")
SEPARATOR = re.compile(r"---\s*(?:#.*)?")
QUOTED = re.compile(r"""(["'])((?:\\.|(?!\1)[^\\])*)\1""")
ESCAPE = re.compile(r"\\(x[0-9a-fA-F]{2}|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|[0-7]{1,3}|.)")
ESCAPED = {
    "a": "\a",
    "b": "\b",
    "f": "\f",
    "n": "\n",
    "r": "\r",
    "t": "\t",
    "v": "\v",
    "\\": "\\",
    '"': '"',
    "'": "'",
}


MAX_ELEMENTS = 2**32 - 1
"""Maximum bound of a sequence or string, whose length is encoded in 32 bits."""

MAX_TEXT = 1 << 20
"""Maximum characters of a definition; MoveIt's largest action has 100 000, with comments."""

MAX_MEMBERS = 2_000
"""Maximum fields and constants of one message; the largest one of mavros has 200."""

MAX_ARRAY = 2**26
"""Maximum elements of a fixed-size array, as each new message has all of them."""


def parse(typename: str, text: str, file: str = "", *, recorded: bool = False) -> InterfaceText:
    """Parse a definition.

    Args:
        typename: The type that it defines, such as ``std_msgs/msg/String``.
        text: The text of a ``.msg``, ``.srv`` or ``.action`` file, according to the name.
        file: The file that it comes from, for errors; by default the name of the type.
        recorded: Whether to accept names that ROS does not allow, as found in recordings. A field
            named like a Python keyword gets a trailing underscore.

    Raises:
        IdlError: The text is not valid; the error names file, line and column.
    """
    file = file or typename
    names = HALVES[split_type_name(typename)[1]]
    if len(text) > MAX_TEXT:
        raise IdlError(file, 0, 0, f"{len(text)} characters; at most {MAX_TEXT} are read")
    parts = [Part()]
    for number, line in enumerate(text.split("\n"), 1):
        stripped = line.strip()
        if SEPARATOR.fullmatch(stripped):
            parts.append(Part())
        elif not stripped or stripped.startswith("#"):
            parts[-1].note(stripped)
        else:
            try:
                parts[-1].add(member(line, number, recorded=recorded), comment_behind(line))
            except LineError as misfit:
                raise IdlError(file, number, misfit.offset + 1, misfit.problem) from None
    if len(parts) != len(names):
        wanted = " and ".join(name for name in names if name)
        needs = f"{wanted}, separated by '---'" if wanted else "one message, without '---'"
        raise IdlError(file, 0, 0, f"{len(parts)} part(s); this kind of file has {needs}")
    return InterfaceText(typename, file, tuple(part.message() for part in parts))


class Part:
    """One message while its lines are read: its members, and the comments on it and on them."""

    def __init__(self) -> None:
        self._members: list[MemberText] = []
        self._lines: dict[str, int] = {}
        self._comment: list[str] = []
        self._above: list[str] = []  # the comment that may be the next member's

    def note(self, line: str) -> None:
        """Take a comment or an empty line: what it ends belongs to the message, or to nothing."""
        if line:
            self._above.append(line.lstrip("#").strip())
            return
        if not self._members and self._above:
            self._comment += [*self._above, ""]
        self._above = []

    def add(self, new: MemberText, behind: str) -> None:
        """Take a member, and the comment behind it; the first comment is the message's.

        Raises:
            LineError: there is a member of its name, or there are too many.
        """
        if new.name in self._lines:
            problem = f"{new.name!r} is already defined on line {self._lines[new.name]}"
            raise LineError(new.column - 1, problem)
        if len(self._members) >= MAX_MEMBERS:
            raise LineError(0, f"a message has at most {MAX_MEMBERS} fields and constants")
        if not self._members and not self._comment:
            self._comment, self._above = self._above, []
        said = " ".join(" ".join([*self._above, behind]).split())
        self._above = []
        self._lines[new.name] = new.line
        self._members.append(dataclasses.replace(new, comment=said) if said else new)

    def message(self) -> MessageText:
        """Return the message."""
        comment = self._comment if self._members else [*self._comment, *self._above]
        return MessageText(tuple(self._members), "\n".join(comment).strip())


def member(line: str, number: int, *, recorded: bool) -> MemberText:
    """Parse the member on one line; raise `LineError` if it is invalid."""
    start = len(line) - len(line.lstrip())
    match = TYPE.match(line, start)
    if match is None:
        raise LineError(
            start, f"{line[start:].split(maxsplit=1)[0]!r} is not a type; a line begins with a type"
        )
    end = match.end()
    if end < len(line) and not line[end].isspace():
        raise LineError(
            end, f"{line[end]!r} does not belong to a type; a space and a name follow it"
        )
    type_ = type_text(match, recorded=recorded)
    name_match = re.compile(r"\s*([^\s=#]*)\s*").match(line, end)
    assert name_match is not None  # noqa: S101 (it also matches an empty text)
    name, at, rest = name_match[1], name_match.start(1), name_match.end()
    if not name:
        raise LineError(at, f"the name is missing; write '{line[start:end]} some_name'")
    constant = line.startswith("=", rest)
    name = field_name(name, at, recorded=recorded, constant=constant)
    if constant:
        rest = rest + 1 + len(line[rest + 1 :]) - len(line[rest + 1 :].lstrip())
    value = written_value(type_, line, rest, name, constant=constant)
    return MemberText(type_, name, value, constant, number, at + 1)


def type_text(match: re.Match[str], *, recorded: bool) -> TypeText:
    """Parse the type at the beginning of a line."""
    name, at = match["name"], match.start()
    allowed = RECORDED_TYPE if recorded else MESSAGE_NAME
    if name not in PRIMITIVES and name in BUILTINS and not recorded:
        raise LineError(at, f"{name!r} is not a type; did you mean {BUILTINS[name]}?")
    if name not in PRIMITIVES and not allowed.fullmatch(name):
        close = difflib.get_close_matches(name, PRIMITIVES, 1)
        hint = (
            f"did you mean {close[0]}?" if close else "use one of " + ", ".join(sorted(PRIMITIVES))
        )
        raise LineError(at, f"{name!r} is not a type; {hint}; message types look like pkg/Name")
    bound = None
    if match["string_bound"] is not None:
        at = match.start("string_bound")
        if name not in STRINGS:
            raise LineError(at - 2, f"only strings have a bound, not {name}")
        bound = limit(match["string_bound"], at, "a bound", MAX_ELEMENTS)
    if match["brackets"] is None:
        return TypeText(name, bound)
    size, at = match["size"], match.start("size")
    if match["upper"]:
        return TypeText(name, bound, "bounded", limit(size, at, "a size or bound", MAX_ELEMENTS))
    if size:
        return TypeText(name, bound, "array", limit(size, at, "a size or bound", MAX_ARRAY))
    return TypeText(name, bound, "unbounded")


def limit(text: str, at: int, what: str, max_value: int) -> int:
    """Parse the size or bound in `text`; raise `LineError` if it is invalid."""
    text = text.lstrip("0")
    if not text:
        number = "" if what == "a bound" else "a number of "
        raise LineError(at, f"{what} is {number}at least 1")
    if len(text) > len(str(max_value)) or int(text) > max_value:  # int() refuses too many digits
        raise LineError(at, f"{what} is at most {max_value} here")
    return int(text)


def field_name(name: str, at: int, *, recorded: bool, constant: bool = False) -> str:
    """Return the Python name of a field or constant; raise `LineError` if it is invalid."""
    if recorded:
        if not RECORDED_NAME.fullmatch(name):
            raise LineError(at, f"{name!r} is not a name: letters, digits and _")
        return f"{name}_" if iskeyword(name) else name
    if constant and not CONSTANT_NAME.fullmatch(name):
        raise LineError(
            at, f"{name!r} is not a valid constant name; use upper-case letters, digits and _"
        )
    if not constant and not FIELD_NAME.fullmatch(name):
        valid = "use lower-case letters, digits and single underscores, starting with a letter"
        raise LineError(at, f"{name!r} is not a valid field name; {valid}")
    if iskeyword(name):
        raise LineError(at, f"{name!r} is a Python keyword, which no field can be called")
    return name


def written_value(type_: TypeText, line: str, at: int, name: str, *, constant: bool) -> object:
    """Parse the default or the constant's value at offset `at`; None if there is none."""
    if (
        type_.name in STRINGS
        and type_.container == "single"
        and line[at : at + 1] not in {"'", '"'}
    ):
        text = unescaped(without_comment(line[at:]))
        if not text and not constant:
            return None
        value: object = text
    else:
        text = without_comment(line[at:])
        if not text:
            if constant:
                raise LineError(at, f"the value of {name} is missing")
            return None
        if type_.name not in PRIMITIVES:
            raise LineError(at, f"a nested message cannot have a default; remove {text!r}")
        value = literal(type_, text, at)
    if constant and type_.container != "single":
        raise LineError(at, "a constant must be a single value, not an array")
    return checked(type_, value, at)


def checked(type_: TypeText, default: object, at: int) -> object:
    """Convert a value to the field's type; raise `LineError` if it does not fit."""
    primitive = type_.primitive()
    unit = FieldType("uint8") if type_.name == "byte" else primitive
    try:
        if isinstance(default, list):
            fit(
                FieldType("string", None, None, type_.container, type_.size),
                [""] * len(default),
                "",
            )
            return tuple(fit_element(unit, item, f"[{i}]") for i, item in enumerate(default))
        value = fit_element(unit, default, "")
    except MessageError as error:
        where = f"element {error.path}: " if error.path else ""
        raise LineError(at, f"{where}{error.problem}") from None
    return bytes((value,)) if type_.name == "byte" else value


def without_comment(text: str) -> str:
    """Return the text up to the first ``#`` outside quotes."""
    return text[: code_end(text)].strip()


def comment_behind(line: str) -> str:
    """Return what stands behind the first ``#`` outside quotes."""
    return line[code_end(line) :].lstrip("#").strip() if "#" in line else ""


def code_end(text: str) -> int:
    """Return where the first ``#`` outside quotes is; the end if there is none."""
    position = 0
    while position < len(text) and text[position] != "#":
        quoted = QUOTED.match(text, position)
        position = quoted.end() if quoted else position + 1
    return position


def literal(type_: TypeText, text: str, at: int) -> object:
    """Parse a literal: a single value, or a list for an array or sequence."""
    if type_.container == "single":
        return single(type_.name, text, at)
    if not text.startswith("[") or not text.endswith("]"):
        raise LineError(at, f"{text!r} is not a list; write the default of an array like [1, 2, 3]")
    return [single(type_.name, item, at + offset) for offset, item in items(text, at)]


def items(text: str, at: int) -> Iterator[tuple[int, str]]:
    """Yield the offset and text of each element of a list."""
    position = start = 1
    while position < len(text):
        quoted = QUOTED.match(text, position)
        if quoted:
            position = quoted.end()
            continue
        if text[position] in ",]":
            item = text[start:position].strip()
            if item:
                yield start, item
            elif text[position] == "," or start > 1:
                raise LineError(at + position, "an element is missing before this character")
            start = position + 1
        position += 1


def single(kind: str, text: str, at: int) -> object:
    """Parse one literal."""
    if kind in STRINGS:
        quoted = QUOTED.fullmatch(text)
        if quoted is None and text[0] in "\"'":
            raise LineError(
                at, f"the quote {text[0]} is not closed; inside a string write \\{text[0]}"
            )
        return unescaped(quoted[2] if quoted else text)
    if kind == "bool":
        if text.lower() in {"true", "1"}:
            return True
        if text.lower() in {"false", "0"}:
            return False
        raise LineError(at, f"{text!r} is not a bool; write true or false")
    try:
        return float(text) if kind in {"float32", "float64"} else int(text, 0)
    except ValueError:
        pass
    try:
        return int(text)  # 007 is decimal
    except ValueError:
        raise LineError(at, f"{text!r} is not a valid {kind}") from None


def unescaped(text: str) -> str:
    r"""Replace escapes such as \n and \" in a text; unknown ones are kept."""

    def replaced(match: re.Match[str]) -> str:
        code = match[1]
        if code[0] in "xuU" and len(code) > 1:
            point = int(code[1:], 16)
            return chr(point) if point <= sys.maxunicode else match[0]
        if code[0] in "01234567":
            return chr(int(code, 8))
        return ESCAPED.get(code, match[0])

    return ESCAPE.sub(replaced, text)
