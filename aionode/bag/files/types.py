"""Type definitions in bags, and the classes that they describe."""

from __future__ import annotations

import re
from functools import cache
from typing import Any, Final

from aionode.engine.wire.typehash import referenced_types, type_hash
from aionode.errors import AionodeError, IdlError, InterfaceNotFoundError
from aionode.interfaces import get_interface
from aionode.message import type_name

__all__ = ["class_of", "definition_of"]

SEPARATOR: Final = "=" * 80
SECTION: Final = re.compile(r"^={20,}\s*\nMSG: (\S+)[^\n]*\n?", re.MULTILINE)
IDL_HEAD: Final = re.compile(r"^={20,}\s*\nIDL: [^\n]*\n?", re.MULTILINE)
LONG_NAME: Final = re.compile(r"\b([A-Za-z]\w*)/(?:msg|srv|action)/([A-Za-z]\w*)")


@cache
def definition_of(cls: type[Any]) -> str:
    """Return the definition of a message class and its dependencies, in ros2msg format."""
    sections = (
        f"{SEPARATOR}\nMSG: {short_name(type_name(part))}\n{own_text(part)}"
        for part in referenced_types(cls)
    )
    return own_text(cls) + "".join(sections)


def own_text(cls: type[Any]) -> str:
    """Return the definition of one message, naming the parts of services by full name."""
    from aionode.idl import definition_text  # only recordings of types by class need it

    package = type_name(cls).split("/")[0]
    return re.sub(r"^(srv|action)/", rf"{package}/\1/", definition_text(cls), flags=re.MULTILINE)


def short_name(typename: str) -> str:
    """Return a type's name as rosbag2 writes it in definitions."""
    return typename.replace("/msg/", "/")


def class_of(typename: str, wanted_hash: str, encoding: str, definition: str) -> Any:
    """Return the class of a type: our own if it is the same, or else built from the definition.

    Raises:
        InterfaceNotFoundError: the type is unknown here, and its definition cannot be used.
    """
    try:
        known = get_interface(typename)
    except (InterfaceNotFoundError, TypeError, ValueError):
        known = None
    if known is not None and (not definition or wanted_hash == type_hash(known)):
        return known
    problem = "the bag has no definition of it, and aionode does not know it"
    if definition:
        try:
            return made_class(typename, encoding, definition)
        except (IdlError, AionodeError, TypeError, ValueError, KeyError) as error:
            problem = f"the definition in the bag cannot be used: {error}"
    if known is not None and not wanted_hash:
        return known
    raise InterfaceNotFoundError(typename, problem=problem)


@cache
def made_class(typename: str, encoding: str, definition: str) -> Any:
    """Return the class that a definition describes, or an equal one from aionode."""
    from aionode.idl import define  # most bags contain known types only

    if encoding == "ros2idl":
        text = IDL_HEAD.sub("", definition)
        return define(plain(typename), text, reuse=True, encoding=encoding, recorded=True)
    if encoding != "ros2msg":
        raise ValueError(f"its format is {encoding!r}, not ros2msg or ros2idl")
    pieces = SECTION.split(definition)
    uses = {
        plain(name): with_plain_names(text)
        for name, text in zip(pieces[1::2], pieces[2::2], strict=True)
    }
    return define(
        plain(typename), with_plain_names(pieces[0]), uses=uses, reuse=True, recorded=True
    )


def plain(typename: str) -> str:
    """Return a valid message name: the parts of services and actions have other names."""
    parts = typename.split("/")
    return f"{parts[0]}/msg/{parts[-1].replace('_', '')}"


def with_plain_names(text: str) -> str:
    """Return a definition with its type names replaced by valid ones."""
    return LONG_NAME.sub(lambda match: plain(match[0]).replace("/msg/", "/"), text)
