"""Encoding and decoding against rosbags, an independent implementation."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_typestore

from aionode.engine.wire import cdr
from aionode.engine.wire.cdr._fallback_decoder import decode_slowly
from aionode.message import DTYPES, FieldType, Message, fields, type_name
from tests.engine.wire.cdr.test_properties import few, many
from tests.support.strategies import message_classes, messages, packages_of, various_classes

if TYPE_CHECKING:
    from rosbags.interfaces.typing import Fielddefs, FieldDesc
    from rosbags.typesys.store import Typestore

NO_FIELDS: Fielddefs = [("structure_needs_at_least_one_member", (Nodetype.BASE, ("uint8", 0)))]


def has_wide_strings(cls: type[Message]) -> bool:
    """Return whether a class has wide strings, which rosbags does not know."""
    return any(
        kind.kind == "wstring" or (kind.nested is not None and has_wide_strings(kind.nested))
        for kind in (field.type for field in fields(cls))
    )


CLASSES = {name: cls for name, cls in message_classes().items() if not has_wide_strings(cls)}

any_class = st.sampled_from(list(CLASSES.values()))


def definition(cls: type[Message]) -> Fielddefs:
    """Return the definition of a class that rosbags does not bring along."""
    return [(field.name, description(field.type)) for field in fields(cls)] or NO_FIELDS


def description(kind: FieldType) -> FieldDesc:
    """Return the type of a field in the terms of rosbags."""
    element: Any = (Nodetype.BASE, (kind.kind, kind.string_bound or 0))
    if kind.nested is not None:
        element = (Nodetype.NAME, type_name(kind.nested))
    if kind.container == "single":
        return element  # type: ignore[no-any-return] # a pair
    if kind.container == "array":
        return (Nodetype.ARRAY, (element, kind.size))
    return (Nodetype.SEQUENCE, (element, kind.size))


@cache
def bundled_types() -> Typestore:
    """Return the types that rosbags brings along."""
    return get_typestore(Stores.ROS2_JAZZY)


@cache
def store(cls: type[Message]) -> Typestore:
    """Return a store that knows a class: rosbags takes several seconds to learn all of them."""
    types = bundled_types()
    for field in fields(cls):
        if field.type.nested is not None:
            store(field.type.nested)
    if type_name(cls) not in types.fielddefs:
        types.register({type_name(cls): ([], definition(cls))})
    return types


def to_rosbags(cls: type[Message], message: Any) -> Any:
    """Return the message as rosbags holds it."""
    made = store(cls).types[type_name(cls)]
    values = [to_value(field.type, getattr(message, field.name)) for field in fields(cls)]
    return made(*(values or [0]))


def to_value(kind: FieldType, value: Any) -> Any:
    """Return the value of a field as rosbags holds it: bytes as numbers."""
    if kind.nested is not None and kind.container == "single":
        return to_rosbags(kind.nested, value)
    if kind.nested is not None:
        return [to_rosbags(kind.nested, item) for item in value]
    if kind.form == "bytes":
        return np.frombuffer(value, np.uint8)
    if kind.kind == "byte":
        return np.frombuffer(value, np.int8)[0].item()
    return value


def same(cls: type[Message], message: Any, theirs: Any) -> bool:
    """Tell whether a message of rosbags has the same values."""
    return all(
        same_value(field.type, getattr(message, field.name), getattr(theirs, field.name))
        for field in fields(cls)
    )


def same_value(kind: FieldType, ours: Any, theirs: Any) -> bool:
    """Tell whether the values of a field are the same; no value is NaN here."""
    if kind.nested is not None and kind.container == "single":
        return same(kind.nested, ours, theirs)
    if kind.nested is not None:
        pairs = zip(ours, theirs, strict=True)
        return all(same(kind.nested, one, other) for one, other in pairs)
    if kind.form == "bytes":
        return bytes(ours) == np.asarray(theirs).tobytes()
    if kind.form == "ndarray":
        return ours.dtype == DTYPES[kind.kind] and list(ours) == list(theirs)
    if kind.kind == "byte" and kind.container == "single":
        return bool(ours[0] == theirs % 256)
    return bool(ours == theirs)


@pytest.mark.slow
@many
@given(cls=any_class, data=st.data())
def test_rosbags_and_aionode_read_each_other(cls: type[Message], data: st.DataObject) -> None:
    """The bytes are the same, and what one wrote the other understands."""
    check_both_ways(data.draw(messages(cls)))


@pytest.mark.stress
@pytest.mark.parametrize("package", packages_of(CLASSES))
def test_rosbags_and_aionode_read_each_other_in_every_class(package: str) -> None:
    """No class depends on being chosen by chance."""
    for name, cls in CLASSES.items():
        if name.startswith(f"{package}/"):
            few(given(messages(cls))(check_both_ways))()


@pytest.mark.slow
def test_rosbags_and_aionode_read_the_defaults_of_classes_of_every_kind() -> None:
    """Every run compares each kind of field."""
    for name in CLASSES.keys() & various_classes():
        cls = CLASSES[name]
        check_both_ways(cdr.decode(cls, cdr.encode(cls())))  # the 0.3 of a float32 is rounded


def check_both_ways(message: Message) -> None:
    """Encode a message with either library, and compare what the other makes of it."""
    cls = type(message)
    name = type_name(cls)
    encoded = cdr.encode(message)
    theirs = store(cls).deserialize_cdr(encoded, name)

    assert same(cls, message, theirs)
    assert bytes(store(cls).serialize_cdr(theirs, name)) == encoded
    assert bytes(store(cls).serialize_cdr(to_rosbags(cls, message), name)) == encoded


@many
@given(data=st.data(), cls=any_class)
def test_big_endian_data_is_read_into_native_values(
    data: st.DataObject, cls: type[Message]
) -> None:
    """Current systems do not send it, but the format allows it."""
    message = data.draw(messages(cls))
    theirs = to_rosbags(cls, message)
    encoded = bytes(store(cls).serialize_cdr(theirs, type_name(cls), little_endian=False))

    assert cdr.decode(cls, encoded) == message
    assert cdr.decode(cls, memoryview(encoded)) == message
    assert cdr.encode(decode_slowly(cls, memoryview(encoded))) == cdr.encode(message)
