"""Numbers within messages, by paths such as ``linear.x``, ``data.0`` and ``position.shoulder``.

An array is followed by an index, or by the name of an element if the message lists the names of
its elements, as JointState (``name``) and JointTrajectory (``joint_names``) do. The elements of
such messages may be in any order, and in a different one each time.
"""

from __future__ import annotations

from typing import Any, Final, NoReturn

from aionode.errors import MessageError, escaped
from aionode.message import DTYPES, FieldType, Message, fields, from_builtins, type_name

__all__ = ["check_path", "filled", "number_at"]

NAME_FIELDS: Final = ("name", "joint_names", "names")
"""The fields that list the names of the elements of the other arrays."""


def check_path(cls: Any, path: str) -> FieldType:
    """Return the type of the numbers at a path of a message class.

    Raises:
        ValueError: messages of the class have no number at this path.
    """
    here: type[Message] | None = cls
    array: FieldType | None = None
    for part in path.split("."):
        if array is not None:
            type_, array = array.element, None
            if not part.isascii() or not (part.isdigit() or has_names(cls)):
                raise ValueError(
                    f"{part!r} is not an index, and {type_name(cls)} does not name elements"
                )
        else:
            known = {each.name: each.type for each in fields(here)} if here else {}
            if part not in known:
                where = f"{type_name(here)} has {', '.join(known)}" if here else "a number has none"
                raise ValueError(f"no field {part!r}: {where}")
            type_ = known[part]
            if type_.container != "single":
                array = type_
                continue
        here = type_.nested
    if array is not None:
        raise ValueError(
            f"it is an array, {array}; name one element, such as {path}.0"
            + (f" or {path}.NAME" if has_names(cls) else "")
        )
    if type_.kind not in DTYPES:
        raise ValueError(f"it is {type_}, not a number")
    return type_


def has_names(cls: Any) -> bool:
    """Return whether a message class lists the names of its elements."""
    return name_field(cls) is not None


def name_field(cls: Any) -> str | None:
    """Return the field that lists the names of the elements, if there is one."""
    types = {each.name: each.type for each in fields(cls)}
    return next(
        (
            name
            for name in NAME_FIELDS
            if name in types and types[name].kind == "string" and types[name].form == "list"
        ),
        None,
    )


def number_at(message: Message, path: str) -> float:
    """Return the number at a path of a message.

    Raises:
        MessageError: this message has no such element (a ValueError).
    """
    value: Any = message
    for part in path.split("."):
        if isinstance(value, Message):
            value = getattr(value, part)
        else:
            value = value[index_of(message, part, len(value), path)]
    return float(value)


def index_of(message: Message, part: str, length: int, path: str) -> int:
    """Return the index of an element, given as a number or by its name."""
    if part.isdigit():
        index = int(part)
        if index >= length:
            lacks(message, path, f"only {length} elements")
        return index
    field = name_field(type(message))
    names: list[str] = getattr(message, field) if field else []
    if part not in names:
        lacks(message, path, f"the names are {', '.join(names[:20]) or 'none'}")
    if names.count(part) > 1:
        lacks(message, path, f"{part} occurs {names.count(part)} times among the names")
    index = names.index(part)
    if index >= length:
        lacks(message, path, f"{length} elements for {len(names)} names")
    return index


def lacks(message: Message, path: str, problem: str) -> NoReturn:
    """Raise the error for a message without the element of a path."""
    raise MessageError(f"{type_name(type(message))}.{path}", f"not there: {escaped(problem)}")


def filled(
    cls: Any, paths: tuple[str, ...], values: list[float], template: dict[str, Any]
) -> Message:
    """Create a message with numbers at paths; other fields are taken from the template.

    Elements given by name are put in the order of the paths, with their names beside them.

    Raises:
        MessageError: a value does not fit its field (a ValueError).
    """
    names: list[str] = []
    tree: dict[str, Any] = copied(template)
    for path, value in zip(paths, values, strict=True):
        put(cls, tree, path.split("."), value, names)
    if names and (field := name_field(cls)) is not None:
        tree[field] = names
    message: Message = from_builtins(cls, tree)
    return message


def copied(value: Any) -> Any:
    """Return a copy of builtin values, with its own mappings and lists."""
    if isinstance(value, dict):
        return {key: copied(each) for key, each in value.items()}
    return [copied(each) for each in value] if isinstance(value, list) else value


def put(cls: Any, tree: Any, parts: list[str], value: float, names: list[str]) -> None:
    """Put a number into a tree of builtin types, and its name into `names`."""
    types = {each.name: each.type for each in fields(cls)}
    for position, part in enumerate(parts):
        is_last = position == len(parts) - 1
        if isinstance(tree, dict):
            type_ = types[part]
            if is_last:
                tree[part] = cast(type_, value)
                return
            is_array = type_.container != "single"
            tree = tree.setdefault(part, [] if is_array else {})
        else:
            type_ = type_.element
            if part.isdigit():
                index = int(part)
            else:
                names.extend([] if part in names else [part])
                index = names.index(part)
            fill = (lambda: cast(type_, 0)) if type_.nested is None else dict  # noqa: B023  # used at once
            tree.extend(fill() for _ in range(index + 1 - len(tree)))
            if is_last:
                tree[index] = cast(type_, value)
                return
            tree = tree[index]
        if type_.nested is not None:
            types = {each.name: each.type for each in fields(type_.nested)}


def cast(type_: FieldType, value: float) -> float | int | bool:
    """Return a number as the Python type of its field."""
    if type_.kind == "bool":
        return bool(round(value))
    return value if type_.kind.startswith("float") else round(value)
