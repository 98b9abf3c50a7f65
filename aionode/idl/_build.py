"""Creates message, service and action classes from parsed definitions."""

from __future__ import annotations

from collections.abc import Mapping
from types import new_class
from typing import Annotated, Any, ClassVar

from aionode.errors import IdlError, InterfaceNotFoundError
from aionode.idl._definition import (
    HALVES,
    InterfaceText,
    MemberText,
    MessageText,
    TypeText,
    split_type_name,
)
from aionode.idl._omg import messages_in
from aionode.idl._parser import BUILTINS, MAX_TEXT, PRIMITIVES, parse
from aionode.interfaces import get_interface, type_of
from aionode.message import (
    ActionType,
    FieldType,
    Interface,
    Message,
    ServiceType,
    constants,
    fields,
)

__all__ = ["Builder", "define"]

MAX_DEPTH = 50
"""Maximum nesting depth of types."""

MAX_MEMBERS = 10_000
"""Maximum fields and constants of a type, including those of all types it uses."""

BASES: dict[str, type[Interface]] = {"msg": Message, "srv": ServiceType, "action": ActionType}


def define(
    typename: str,
    text: str,
    *,
    types: Mapping[str, type[Interface]] | None = None,
    uses: Mapping[str, str] | None = None,
    reuse: bool = False,
    encoding: str = "ros2msg",
    recorded: bool = False,
) -> type[Any]:
    r"""Create the class that a definition describes.

    ::

        Words = define("tutorial/msg/Words", "string text\nfloat32[] scores")

    Args:
        typename: Its ROS name, such as ``tutorial/msg/Words``.
        text: The text of a ``.msg``, ``.srv`` or ``.action`` file, according to the name.
        types: Message classes that it may use besides those of aionode.interfaces, by ROS name.
        uses: Definitions of messages that it may use, by ROS name, in place of those of
            aionode.interfaces.
        reuse: Whether to use, instead of a new class, a type of aionode.interfaces with the same
            definition.
        encoding: The format of the text: ``ros2msg``, or ``ros2idl``, whose other structures may be
            used too.
        recorded: Whether to accept names that ROS does not allow, as found in recordings. A field
            named like a Python keyword gets a trailing underscore: ``from_``.

    Raises:
        IdlError: The text is not valid, or uses an unknown type.
        TypeError: `typename` is not a valid name of a ROS type.
    """
    if encoding == "ros2idl":
        found = messages_in(text, typename, recorded=recorded)
        if typename not in found:
            name = typename.rpartition("/")[2]
            raise IdlError(typename, 0, 0, f"the text has no struct {name}")
        texts = {name: InterfaceText(name, typename, (part,)) for name, part in found.items()}
    else:
        given = {**(uses or {}), typename: text}
        size = sum(map(len, given.values()))
        if size > MAX_TEXT:
            raise IdlError(typename, 0, 0, f"{size} characters; at most {MAX_TEXT} are read")
        texts = {name: parse(name, used, recorded=recorded) for name, used in given.items()}
    builder = Builder(texts, reuse=reuse, recorded=recorded)
    builder.built.update(types or {})
    return builder.build(typename)


class Builder:
    """Creates the classes of several definitions that may use each other."""

    def __init__(
        self, texts: Mapping[str, InterfaceText], *, reuse: bool, recorded: bool = False
    ) -> None:
        self.texts = texts
        self.reuse = reuse
        self.recorded = recorded
        self.members = 0
        self.built: dict[str, type[Interface]] = {}
        self.open: list[str] = []
        """Names of the types that are being built; each uses the next."""

    def build(self, typename: str) -> type[Interface]:
        """Return the class of one of the definitions, created on the first call.

        Raises:
            IdlError: The type of a field is unknown, or contains itself.
        """
        if typename not in self.built:
            text = self.texts[typename]
            self.members = self.members if self.open else 0
            self.members += sum(len(part.members) for part in text.parts)
            if len(self.open) >= MAX_DEPTH or self.members > MAX_MEMBERS:
                problem = f"types in types deeper than {MAX_DEPTH}, or with more than {MAX_MEMBERS}"
                raise IdlError(text.file, 0, 0, f"{problem} fields in all")
            self.open.append(typename)
            try:
                built = self.make(text)
            finally:
                self.open.pop()
            self.built[typename] = (self.reuse and self.existing(typename, built)) or built
        return self.built[typename]

    def existing(self, typename: str, built: type[Interface]) -> type[Interface] | None:
        """Return the existing class that has the same definition."""
        return existing(typename, built)

    def make(self, text: InterfaceText) -> type[Interface]:
        """Return a new class."""
        package, kind, name = split_type_name(text.typename)
        place: dict[str, Any] = {
            "__module__": f"aionode.interfaces.{package}.{kind}",
            "__qualname__": name,
        }
        fallback = f"{name}, as in {text.typename}."
        if kind == "msg":
            body = {**place, "__doc__": text.parts[0].docstring(fallback)}
            return self.message(text, text.parts[0], body)
        body = {**place, "__doc__": text.parts[0].comment or fallback}
        for half, part in zip(HALVES[kind], text.parts, strict=True):
            inside = {**place, "__qualname__": f"{name}.{half}"}
            inside["__doc__"] = part.docstring(f"The {half.lower()} of {name}.")
            body[half] = self.message(text, part, inside)
        return new_class(
            name,
            (BASES[kind],),
            {"typename": text.typename, "by_name": False},
            lambda namespace: namespace.update(body),
        )

    def message(
        self, text: InterfaceText, part: MessageText, body: dict[str, Any]
    ) -> type[Message]:
        """Return a new message class."""
        name = body["__qualname__"].rpartition(".")[2]
        annotations: dict[str, Any] = {}
        for member in part.members:
            annotation: Any = Annotated[Any, self.field_type(text, member)]
            annotations[member.name] = ClassVar[annotation] if member.constant else annotation
            if member.value is not None:
                body[member.name] = member.value
        body["__annotations__"] = annotations
        nested = "." in body["__qualname__"]
        options: dict[str, Any] = {"recorded": self.recorded}
        if not nested:
            options |= {"typename": text.typename, "by_name": False}
        return new_class(name, (Message,), options, lambda space: space.update(body))

    def field_type(self, text: InterfaceText, member: MemberText) -> FieldType:
        """Return the type of a field, with the class of a nested message."""
        type_ = member.type
        if type_.name in PRIMITIVES:
            return type_.primitive()
        package = split_type_name(text.typename)[0]
        try:
            nested = self.used(full_name(type_, package))
        except InterfaceNotFoundError as error:
            problem = f"no message type {type_.name!r} here or in aionode.interfaces"
            if type_.name == "Header":
                problem += "; did you mean std_msgs/Header?"
            elif type_.name in BUILTINS:
                problem += f"; did you mean {BUILTINS[type_.name]}?"
            elif error.suggestions:
                problem += f"; did you mean {error.suggestions[0]}?"
            raise IdlError(text.file, member.line, 1, problem) from None
        except RecursionError:
            chain = " uses ".join((*self.open, full_name(type_, package)))
            raise IdlError(
                text.file, member.line, 1, f"{chain}: a message cannot contain itself"
            ) from None
        return FieldType("message", nested, None, type_.container, type_.size)

    def used(self, typename: str) -> type[Message]:
        """Return a message class of these definitions or of aionode.interfaces."""
        if typename in self.open:
            raise RecursionError
        if typename in self.texts:
            cls = self.build(typename)
        else:
            cls = self.built.get(typename) or get_interface(typename)
        assert issubclass(cls, Message)  # noqa: S101 (the name says msg)
        return cls


def full_name(type_: TypeText, package: str) -> str:
    """Return the ROS name of a message type that is written in a definition of `package`."""
    parts = type_.name.split("/")
    return f"{parts[0] if len(parts) > 1 else package}/msg/{parts[-1]}"


def existing(typename: str, built: type[Interface]) -> type[Interface] | None:
    """Return the class of this name in aionode.interfaces if its definition is the same.

    That way a workspace with its own std_msgs can be used together with the shipped one.
    """
    package, kind, name = split_type_name(typename)
    known = type_of(package, kind, name)
    if known is None:
        return None
    halves = HALVES[kind]
    pairs: Any = ((getattr(built, h), getattr(known, h)) if h else (built, known) for h in halves)
    if all(fields(a) == fields(b) and constants(a) == constants(b) for a, b in pairs):
        return known
    return None
