"""Parses definitions in OMG's IDL, as found in ``.idl`` files and recordings.

The language is the subset that rosidl accepts: modules, structures, constants, ``typedef`` and
annotations. Directives such as ``#include`` are skipped, as types are found by name.
"""

from __future__ import annotations

import ast
import re
from bisect import bisect_left
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from aionode.errors import IdlError
from aionode.idl._definition import (
    HALVES,
    InterfaceText,
    LineError,
    MemberText,
    MessageText,
    TypeText,
    split_type_name,
)
from aionode.idl._parser import MAX_TEXT, PRIMITIVES, checked, field_name, unescaped

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["messages_in", "parse_idl"]

TOKEN: Final = re.compile(
    r"""(?P<space>\s+|//[^\n]*|/\*.*?\*/|^[ \t]*\#[^\n]*)
    |(?P<text>L?"(?:\\.|[^"\\])*"|L?'(?:\\.|[^'\\])*')
    |(?P<number>(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)[fFdDlL]?)
    |(?P<name>(?:::)?[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*)
    |(?P<sign><<|>>|[{}()\[\]<>;:,=@+\-*/%|&^~])""",
    re.VERBOSE | re.DOTALL | re.MULTILINE | re.ASCII,
)
KINDS: Final = {
    "boolean": "bool",
    "octet": "byte",
    "char": "char",
    "wchar": "uint16",
    "float": "float32",
    "double": "float64",
    "short": "int16",
    "long": "int32",
    "long long": "int64",
    "unsigned short": "uint16",
    "unsigned long": "uint32",
    "unsigned long long": "uint64",
    **{f"{sign}int{bits}": f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)},
}
"""The ROS types by IDL type."""

PLACEHOLDER: Final = "structure_needs_at_least_one_member"
"""The member of an empty structure, which IDL does not allow."""

CONSTANTS: Final = "_Constants"
"""The suffix of the module that holds the constants of a structure."""

MAX_DEPTH: Final = 10
"""Maximum nesting of modules; two levels are usual."""

MAX_NUMBER: Final = 400


class Token(NamedTuple):
    """A token of the text, and its position."""

    kind: str
    text: str
    at: int


class Structure(NamedTuple):
    """A structure, with its constants."""

    members: list[MemberText]
    comment: str


def parse_idl(typename: str, text: str, file: str = "") -> InterfaceText:
    """Parse the definition of one type; other types in the text are ignored.

    Args:
        typename: The type that it defines, such as ``std_msgs/msg/String``.
        text: The text of an ``.idl`` file.
        file: The file that it comes from, for errors; by default the name of the type.

    Raises:
        IdlError: The text is not valid, or does not define the type.
    """
    package, kind, name = split_type_name(typename)
    file = file or typename
    found = messages_in(text, file, recorded=False)
    parts: list[MessageText] = []
    for half in HALVES[kind]:
        wanted = f"{name}_{half}" if half else name
        part = found.get(named((package, kind, wanted)))
        if part is None:
            raise IdlError(file, 0, 0, f"there is no struct {package}::{kind}::{wanted}")
        parts.append(part)
    return InterfaceText(typename, file, tuple(parts))


def messages_in(text: str, file: str, *, recorded: bool) -> dict[str, MessageText]:
    """Parse all structures in a text; return them by message name.

    Args:
        text: The text of one or more ``.idl`` files.
        file: Where it comes from, for errors.
        recorded: Whether to accept names that ROS does not allow.

    Raises:
        IdlError: The text is not valid; the error names line and column.
    """
    if len(text) > MAX_TEXT:
        raise IdlError(file, 0, 0, f"{len(text)} characters; at most {MAX_TEXT} are read")
    try:
        reader = Reader(text, recorded=recorded)
        reader.definitions(())
    except LineError as misfit:
        line = text.count("\n", 0, misfit.offset) + 1
        column = misfit.offset - text.rfind("\n", 0, misfit.offset)
        raise IdlError(file, line, column, misfit.problem) from None
    return {
        named(scope): MessageText(
            (*reader.constants.get((*scope[:-1], scope[-1] + CONSTANTS), ()), *found.members),
            found.comment,
        )
        for scope, found in reader.structures.items()
    }


def named(scope: tuple[str, ...]) -> str:
    """Return the message name of a structure; parts of services are messages, too."""
    package, *kind, name = ("", *scope)[-3:]
    return f"{package}/msg/{name if kind == ['msg'] else name.replace('_', '')}"


class Reader:
    """Reads the tokens of a text one after another.

    Attributes:
        structures: The structures by their scoped names.
        constants: The constants of each module.
    """

    def __init__(self, text: str, *, recorded: bool) -> None:
        self._text = text
        self._recorded = recorded
        self._breaks = [match.start() for match in re.finditer("\n", text)]
        self._tokens = self._words()
        self._next = next(self._tokens)
        self._types: dict[tuple[str, ...], TypeText] = {}
        self._values: dict[tuple[str, ...], object] = {}
        self.structures: dict[tuple[str, ...], Structure] = {}
        self.constants: dict[tuple[str, ...], list[MemberText]] = {}

    def _words(self) -> Iterator[Token]:
        at = 0
        while at < len(self._text):
            match = TOKEN.match(self._text, at)
            if match is None:
                raise LineError(at, f"{self._text[at]!r} is not a token of IDL")
            kind = str(match.lastgroup)
            if kind != "space":
                yield Token(kind, match[0], at)
            at = match.end()
        while True:
            yield Token("end", "", at)

    def _take(self) -> Token:
        taken, self._next = self._next, next(self._tokens)
        return taken

    def _has(self, text: str) -> bool:
        """Consume the next token if it is this one."""
        if self._next.text != text or self._next.kind == "text":
            return False
        self._take()
        return True

    def _expect(self, text: str) -> None:
        if not self._has(text):
            shown = repr(self._next.text[:40]) if self._next.kind != "end" else "the end"
            raise LineError(self._next.at, f"{shown} where {text!r} was expected")

    def _name(self) -> Token:
        if self._next.kind != "name":
            raise LineError(self._next.at, f"{self._next.text[:40]!r} where a name was expected")
        return self._take()

    def definitions(self, scope: tuple[str, ...]) -> None:
        """Read the contents of a module, up to its end."""
        if len(scope) > MAX_DEPTH:
            raise LineError(self._next.at, f"modules are nested deeper than {MAX_DEPTH}")
        while self._next.kind != "end" and self._next.text != "}":
            if self._has(";"):
                continue
            notes = self._annotations(scope)
            word = self._name()
            if word.text == "module":
                name = self._name().text
                self._expect("{")
                self.definitions((*scope, name))
                self._expect("}")
            elif word.text == "struct":
                self._structure(scope, comment_in(notes))
            elif word.text == "typedef":
                self._typedef(scope)
            elif word.text == "const":
                self._constant(scope)
            else:
                problem = f"{word.text!r} is not module, struct, typedef or const"
                raise LineError(word.at, problem)
            self._expect(";")
        if not scope and self._next.kind != "end":
            raise LineError(self._next.at, "'}' without a '{' before it")

    def _annotations(self, scope: tuple[str, ...]) -> dict[str, Any]:
        """Read annotations, and return the values of each by ``name.parameter``."""
        notes: dict[str, Any] = {}
        while self._has("@"):
            name = self._name().text
            if not self._has("("):
                continue
            while not self._has(")"):
                if self._next.kind == "name" and not self._is_value():
                    parameter = self._take().text
                    if self._has("="):
                        notes[f"{name}.{parameter}"] = self._value(scope)
                elif self._next.kind == "end":
                    raise LineError(self._next.at, f"the annotation @{name} has no end")
                elif not self._has(","):
                    notes[name] = self._value(scope)
        return notes

    def _is_value(self) -> bool:
        return self._next.text in {"TRUE", "FALSE"}

    def _value(self, scope: tuple[str, ...]) -> object:
        """Read a value: a number, adjacent string literals, or the name of a constant."""
        sign = -1 if self._has("-") else 1
        if sign == 1:
            self._has("+")
        word = self._take()
        if word.kind == "number":
            return sign * number(word)
        if sign == 1 and word.kind == "text":
            text = text_in(word)
            while self._next.kind == "text":
                text += text_in(self._take())
            return text
        if sign == 1 and word.text in {"TRUE", "FALSE"}:
            return word.text == "TRUE"
        if word.kind == "name":
            for depth in range(len(scope), -1, -1):
                value = self._values.get((*scope[:depth], *split(word.text)))
                if isinstance(value, int | float):
                    return sign * value
                if value is not None and sign == 1:
                    return value
        raise LineError(word.at, f"{word.text[:40]!r} is not a known value")

    def _structure(self, scope: tuple[str, ...], comment: str) -> None:
        name = self._name()
        if self._next.text == ";":
            return  # only a forward declaration
        self._expect("{")
        members: list[MemberText] = []
        seen: set[str] = set()
        while not self._has("}"):
            notes = self._annotations(scope)
            type_ = self._type(scope)
            for at, word, its_type in self._declarators(type_, scope):
                if word in seen:
                    raise LineError(at, f"{word!r} is already defined")
                seen.add(word)
                value = default_in(its_type, notes, at)
                line, column = self._place(at)
                said = " ".join(comment_in(notes).split())
                members.append(MemberText(its_type, word, value, False, line, column, said))
            self._expect(";")
        if [member.name for member in members] == [PLACEHOLDER]:
            members = []
        self.structures[*scope, name.text] = Structure(members, comment)

    def _place(self, at: int) -> tuple[int, int]:
        line = bisect_left(self._breaks, at)
        return line + 1, at - (self._breaks[line - 1] if line else -1)

    def _declarators(
        self, type_: TypeText, scope: tuple[str, ...]
    ) -> Iterator[tuple[int, str, TypeText]]:
        """Read declarators: names with their positions and the types that their brackets make."""
        while True:
            word = self._name()
            its_type = type_
            while self._has("["):
                size = self._size(scope)
                self._expect("]")
                if its_type.container != "single":
                    raise LineError(word.at, "ROS has no arrays of arrays or sequences")
                its_type = TypeText(type_.name, type_.string_bound, "array", size)
            name = field_name(word.text, word.at, recorded=self._recorded)
            yield word.at, name, its_type
            if not self._has(","):
                return

    def _size(self, scope: tuple[str, ...]) -> int:
        at = self._next.at
        size = self._value(scope)
        if not isinstance(size, int) or not 0 < size < 1 << 32:
            raise LineError(at, f"{str(size)[:40]!r} is not a valid size: use 1 to 2^32 - 1")
        return size

    def _typedef(self, scope: tuple[str, ...]) -> None:
        type_ = self._type(scope)
        for _, name, its_type in self._aliases(type_, scope):
            self._types[*scope, name] = its_type

    def _aliases(
        self, type_: TypeText, scope: tuple[str, ...]
    ) -> Iterator[tuple[int, str, TypeText]]:
        """Read names of types, which may have any spelling."""
        recorded, self._recorded = self._recorded, True
        try:
            yield from self._declarators(type_, scope)
        finally:
            self._recorded = recorded

    def _constant(self, scope: tuple[str, ...]) -> None:
        type_ = self._type(scope)
        word = self._name()
        self._expect("=")
        at = self._next.at
        value = checked_value(type_, self._value(scope), at)
        if type_.container != "single":
            raise LineError(at, "a constant must be a single value, not an array")
        self._values[*scope, word.text] = value
        line, column = self._place(word.at)
        name = field_name(word.text, word.at, recorded=self._recorded, constant=True)
        known = self.constants.setdefault(scope, [])
        known.append(MemberText(type_, name, value, constant=True, line=line, column=column))

    def _type(self, scope: tuple[str, ...]) -> TypeText:
        """Read a type."""
        word = self._name()
        text = word.text
        if text == "sequence":
            return self._sequence(scope)
        if text in {"string", "wstring"}:
            bound = None
            if self._has("<"):
                bound = self._size(scope)
                self._expect(">")
            return TypeText(text, bound)
        while text in {"unsigned", "long", "unsigned long"} and self._next.text in {
            "short",
            "long",
            "double",
        }:
            text += f" {self._take().text}"
        if text in KINDS:
            return TypeText(KINDS[text])
        parts = split(text)
        for depth in range(len(scope), -1, -1):
            known = self._types.get((*scope[:depth], *parts))
            if known is not None:
                return known
        if len(parts) == 1:
            parts = (*scope, *parts)
        if len(parts) < 2 or " " in text:  # it has no package and name
            raise LineError(word.at, f"{text!r} is not a known type")
        package, _, name = named(parts).split("/")
        return TypeText(f"{package}/{name}")

    def _sequence(self, scope: tuple[str, ...]) -> TypeText:
        self._expect("<")
        if self._next.text == "sequence":
            raise LineError(self._next.at, "ROS has no sequences of sequences")
        at = self._next.at
        element = self._type(scope)
        if element.container != "single":
            raise LineError(at, "ROS has no sequences of arrays or sequences")
        size = self._size(scope) if self._has(",") else 0
        self._expect(">")
        if size:
            return TypeText(element.name, element.string_bound, "bounded", size)
        return TypeText(element.name, element.string_bound, "unbounded")


def split(text: str) -> tuple[str, ...]:
    """Return the parts of a scoped name."""
    return tuple(text.removeprefix("::").split("::"))


def number(word: Token) -> int | float:
    """Parse a number."""
    text = word.text
    if len(text) > MAX_NUMBER:
        raise LineError(word.at, f"a number of {len(text)} characters")
    if text[:2] in {"0x", "0X"}:
        return int(text.rstrip("lL"), 16)
    plain = text.rstrip("fFdDlL")
    if plain.isdigit():
        is_octal = plain[0] == "0" and len(plain) > 1 and not set(plain) & set("89")
        return int(plain, 8 if is_octal else 10)
    return float(plain)


def text_in(word: Token) -> str:
    """Return the text between quotes."""
    return unescaped(word.text.removeprefix("L")[1:-1])


def comment_in(notes: dict[str, Any]) -> str:
    """Return the comment in annotations."""
    comment = notes.get("verbatim.text", "")
    return comment.strip() if isinstance(comment, str) else ""


def default_in(type_: TypeText, notes: dict[str, Any], at: int) -> object:
    """Return the default in annotations, or None."""
    value = notes.get("default.value", notes.get("default"))
    if value is None:
        return None
    if type_.container != "single" and isinstance(value, str):
        try:
            given = ast.literal_eval(value)
        except (ValueError, SyntaxError, MemoryError, RecursionError, TypeError) as error:
            raise LineError(at, f"the default {value[:40]!r} is not a list of values") from error
        value = list(given) if isinstance(given, list | tuple) else [given]
    return checked_value(type_, value, at)


def checked_value(type_: TypeText, value: object, at: int) -> object:
    """Convert a value to its type; raise `LineError` if it does not fit."""
    if type_.name not in PRIMITIVES:
        raise LineError(at, f"{type_.name} cannot have values here")
    return checked(type_, value, at)
