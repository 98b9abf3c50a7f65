"""Messages of type_description_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.message import DEFAULT, Bounded, Message, Sequence, uint8, uint64

__all__ = [
    "Field",
    "FieldType",
    "IndividualTypeDescription",
    "KeyValue",
    "TypeDescription",
    "TypeSource",
]


class FieldType(Message, typename="type_description_interfaces/msg/FieldType"):
    """The type of a field.

    Attributes:
        type_id: One of the constants.
        capacity: Size of an array, or bound of a sequence.
        string_capacity: The longest string, in characters; 0 is no limit.
        nested_type_name: ROS name of a message type.
    """

    FIELD_TYPE_NOT_SET: ClassVar[uint8] = 0
    FIELD_TYPE_NESTED_TYPE: ClassVar[uint8] = 1
    FIELD_TYPE_INT8: ClassVar[uint8] = 2
    FIELD_TYPE_UINT8: ClassVar[uint8] = 3
    FIELD_TYPE_INT16: ClassVar[uint8] = 4
    FIELD_TYPE_UINT16: ClassVar[uint8] = 5
    FIELD_TYPE_INT32: ClassVar[uint8] = 6
    FIELD_TYPE_UINT32: ClassVar[uint8] = 7
    FIELD_TYPE_INT64: ClassVar[uint8] = 8
    FIELD_TYPE_UINT64: ClassVar[uint8] = 9
    FIELD_TYPE_FLOAT: ClassVar[uint8] = 10
    FIELD_TYPE_DOUBLE: ClassVar[uint8] = 11
    FIELD_TYPE_LONG_DOUBLE: ClassVar[uint8] = 12
    FIELD_TYPE_CHAR: ClassVar[uint8] = 13
    FIELD_TYPE_WCHAR: ClassVar[uint8] = 14
    FIELD_TYPE_BOOLEAN: ClassVar[uint8] = 15
    FIELD_TYPE_BYTE: ClassVar[uint8] = 16
    FIELD_TYPE_STRING: ClassVar[uint8] = 17
    FIELD_TYPE_WSTRING: ClassVar[uint8] = 18
    FIELD_TYPE_FIXED_STRING: ClassVar[uint8] = 19
    FIELD_TYPE_FIXED_WSTRING: ClassVar[uint8] = 20
    FIELD_TYPE_BOUNDED_STRING: ClassVar[uint8] = 21
    FIELD_TYPE_BOUNDED_WSTRING: ClassVar[uint8] = 22
    FIELD_TYPE_NESTED_TYPE_ARRAY: ClassVar[uint8] = 49
    FIELD_TYPE_INT8_ARRAY: ClassVar[uint8] = 50
    FIELD_TYPE_UINT8_ARRAY: ClassVar[uint8] = 51
    FIELD_TYPE_INT16_ARRAY: ClassVar[uint8] = 52
    FIELD_TYPE_UINT16_ARRAY: ClassVar[uint8] = 53
    FIELD_TYPE_INT32_ARRAY: ClassVar[uint8] = 54
    FIELD_TYPE_UINT32_ARRAY: ClassVar[uint8] = 55
    FIELD_TYPE_INT64_ARRAY: ClassVar[uint8] = 56
    FIELD_TYPE_UINT64_ARRAY: ClassVar[uint8] = 57
    FIELD_TYPE_FLOAT_ARRAY: ClassVar[uint8] = 58
    FIELD_TYPE_DOUBLE_ARRAY: ClassVar[uint8] = 59
    FIELD_TYPE_LONG_DOUBLE_ARRAY: ClassVar[uint8] = 60
    FIELD_TYPE_CHAR_ARRAY: ClassVar[uint8] = 61
    FIELD_TYPE_WCHAR_ARRAY: ClassVar[uint8] = 62
    FIELD_TYPE_BOOLEAN_ARRAY: ClassVar[uint8] = 63
    FIELD_TYPE_BYTE_ARRAY: ClassVar[uint8] = 64
    FIELD_TYPE_STRING_ARRAY: ClassVar[uint8] = 65
    FIELD_TYPE_WSTRING_ARRAY: ClassVar[uint8] = 66
    FIELD_TYPE_FIXED_STRING_ARRAY: ClassVar[uint8] = 67
    FIELD_TYPE_FIXED_WSTRING_ARRAY: ClassVar[uint8] = 68
    FIELD_TYPE_BOUNDED_STRING_ARRAY: ClassVar[uint8] = 69
    FIELD_TYPE_BOUNDED_WSTRING_ARRAY: ClassVar[uint8] = 70
    FIELD_TYPE_NESTED_TYPE_BOUNDED_SEQUENCE: ClassVar[uint8] = 97
    FIELD_TYPE_INT8_BOUNDED_SEQUENCE: ClassVar[uint8] = 98
    FIELD_TYPE_UINT8_BOUNDED_SEQUENCE: ClassVar[uint8] = 99
    FIELD_TYPE_INT16_BOUNDED_SEQUENCE: ClassVar[uint8] = 100
    FIELD_TYPE_UINT16_BOUNDED_SEQUENCE: ClassVar[uint8] = 101
    FIELD_TYPE_INT32_BOUNDED_SEQUENCE: ClassVar[uint8] = 102
    FIELD_TYPE_UINT32_BOUNDED_SEQUENCE: ClassVar[uint8] = 103
    FIELD_TYPE_INT64_BOUNDED_SEQUENCE: ClassVar[uint8] = 104
    FIELD_TYPE_UINT64_BOUNDED_SEQUENCE: ClassVar[uint8] = 105
    FIELD_TYPE_FLOAT_BOUNDED_SEQUENCE: ClassVar[uint8] = 106
    FIELD_TYPE_DOUBLE_BOUNDED_SEQUENCE: ClassVar[uint8] = 107
    FIELD_TYPE_LONG_DOUBLE_BOUNDED_SEQUENCE: ClassVar[uint8] = 108
    FIELD_TYPE_CHAR_BOUNDED_SEQUENCE: ClassVar[uint8] = 109
    FIELD_TYPE_WCHAR_BOUNDED_SEQUENCE: ClassVar[uint8] = 110
    FIELD_TYPE_BOOLEAN_BOUNDED_SEQUENCE: ClassVar[uint8] = 111
    FIELD_TYPE_BYTE_BOUNDED_SEQUENCE: ClassVar[uint8] = 112
    FIELD_TYPE_STRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 113
    FIELD_TYPE_WSTRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 114
    FIELD_TYPE_FIXED_STRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 115
    FIELD_TYPE_FIXED_WSTRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 116
    FIELD_TYPE_BOUNDED_STRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 117
    FIELD_TYPE_BOUNDED_WSTRING_BOUNDED_SEQUENCE: ClassVar[uint8] = 118
    FIELD_TYPE_NESTED_TYPE_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 145
    FIELD_TYPE_INT8_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 146
    FIELD_TYPE_UINT8_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 147
    FIELD_TYPE_INT16_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 148
    FIELD_TYPE_UINT16_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 149
    FIELD_TYPE_INT32_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 150
    FIELD_TYPE_UINT32_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 151
    FIELD_TYPE_INT64_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 152
    FIELD_TYPE_UINT64_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 153
    FIELD_TYPE_FLOAT_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 154
    FIELD_TYPE_DOUBLE_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 155
    FIELD_TYPE_LONG_DOUBLE_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 156
    FIELD_TYPE_CHAR_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 157
    FIELD_TYPE_WCHAR_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 158
    FIELD_TYPE_BOOLEAN_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 159
    FIELD_TYPE_BYTE_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 160
    FIELD_TYPE_STRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 161
    FIELD_TYPE_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 162
    FIELD_TYPE_FIXED_STRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 163
    FIELD_TYPE_FIXED_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 164
    FIELD_TYPE_BOUNDED_STRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 165
    FIELD_TYPE_BOUNDED_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[uint8] = 166

    type_id: uint8 = 0
    capacity: uint64 = 0
    string_capacity: uint64 = 0
    nested_type_name: Bounded[str, 255] = ""


class Field(Message, typename="type_description_interfaces/msg/Field"):
    """A field of a type: its name, type and default as text."""

    name: str = ""
    type: FieldType = DEFAULT
    default_value: str = ""


class IndividualTypeDescription(
    Message, typename="type_description_interfaces/msg/IndividualTypeDescription"
):
    """A message type: its ROS name and fields."""

    type_name: Bounded[str, 255] = ""
    fields: Annotated[list[Field], Sequence[Field]] = DEFAULT


class KeyValue(Message, typename="type_description_interfaces/msg/KeyValue"):
    """A name and a value, both as text."""

    key: str = ""
    value: str = ""


class TypeDescription(Message, typename="type_description_interfaces/msg/TypeDescription"):
    """A message type and all those it is made of: what its hash is computed from."""

    type_description: IndividualTypeDescription = DEFAULT
    referenced_type_descriptions: Annotated[
        list[IndividualTypeDescription], Sequence[IndividualTypeDescription]
    ] = DEFAULT


class TypeSource(Message, typename="type_description_interfaces/msg/TypeSource"):
    """The text that a type was defined with; `encoding` is ``msg``, ``srv``, ``action`` or ``idl``."""

    type_name: str = ""
    encoding: str = ""
    raw_file_contents: str = ""
