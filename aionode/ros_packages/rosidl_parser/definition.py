"""The types of fields as described by rosidl; programs import it as `rosidl_parser.definition`.

Only the types are here, with the attributes that programs read from ``SLOT_TYPES``. `aionode.idl`
parses definitions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = [
    "ACTION_FEEDBACK_MESSAGE_SUFFIX",
    "ACTION_FEEDBACK_SUFFIX",
    "ACTION_GOAL_SERVICE_SUFFIX",
    "ACTION_GOAL_SUFFIX",
    "ACTION_RESULT_SERVICE_SUFFIX",
    "ACTION_RESULT_SUFFIX",
    "BASIC_TYPES",
    "BOOLEAN_TYPE",
    "CHARACTER_TYPES",
    "CONSTANT_MODULE_SUFFIX",
    "EMPTY_STRUCTURE_REQUIRED_MEMBER_NAME",
    "EXPLICIT_INTEGER_TYPES",
    "FLOATING_POINT_TYPES",
    "INTEGER_TYPES",
    "NONEXPLICIT_INTEGER_TYPES",
    "OCTET_TYPE",
    "SERVICE_EVENT_MESSAGE_SUFFIX",
    "SERVICE_REQUEST_MESSAGE_SUFFIX",
    "SERVICE_RESPONSE_MESSAGE_SUFFIX",
    "SIGNED_EXPLICIT_INTEGER_TYPES",
    "SIGNED_INTEGER_TYPES",
    "SIGNED_NONEXPLICIT_INTEGER_TYPES",
    "UNSIGNED_EXPLICIT_INTEGER_TYPES",
    "UNSIGNED_INTEGER_TYPES",
    "UNSIGNED_NONEXPLICIT_INTEGER_TYPES",
    "AbstractGenericString",
    "AbstractNestableType",
    "AbstractNestedType",
    "AbstractSequence",
    "AbstractString",
    "AbstractType",
    "AbstractWString",
    "Array",
    "BasicType",
    "BoundedSequence",
    "BoundedString",
    "BoundedWString",
    "NamedType",
    "NamespacedType",
    "UnboundedSequence",
    "UnboundedString",
    "UnboundedWString",
]

# The basic types of OMG IDL 4.2, sections 7.4.1.4.4.2 and 7.4.13.4.4.
SIGNED_NONEXPLICIT_INTEGER_TYPES = ("short", "long", "long long")
UNSIGNED_NONEXPLICIT_INTEGER_TYPES = ("unsigned short", "unsigned long", "unsigned long long")
NONEXPLICIT_INTEGER_TYPES = (
    *SIGNED_NONEXPLICIT_INTEGER_TYPES,
    *UNSIGNED_NONEXPLICIT_INTEGER_TYPES,
)
SIGNED_EXPLICIT_INTEGER_TYPES = ("int8", "int16", "int32", "int64")
UNSIGNED_EXPLICIT_INTEGER_TYPES = ("uint8", "uint16", "uint32", "uint64")
EXPLICIT_INTEGER_TYPES = (*SIGNED_EXPLICIT_INTEGER_TYPES, *UNSIGNED_EXPLICIT_INTEGER_TYPES)
SIGNED_INTEGER_TYPES = (*SIGNED_NONEXPLICIT_INTEGER_TYPES, *SIGNED_EXPLICIT_INTEGER_TYPES)
UNSIGNED_INTEGER_TYPES = (*UNSIGNED_NONEXPLICIT_INTEGER_TYPES, *UNSIGNED_EXPLICIT_INTEGER_TYPES)
INTEGER_TYPES = (*SIGNED_INTEGER_TYPES, *UNSIGNED_INTEGER_TYPES)
FLOATING_POINT_TYPES = ("float", "double", "long double")
CHARACTER_TYPES = ("char", "wchar")
BOOLEAN_TYPE = "boolean"
OCTET_TYPE = "octet"
BASIC_TYPES = (
    *INTEGER_TYPES,
    *FLOATING_POINT_TYPES,
    *CHARACTER_TYPES,
    BOOLEAN_TYPE,
    OCTET_TYPE,
)

# Suffixes by which rosidl names the parts of an interface.
EMPTY_STRUCTURE_REQUIRED_MEMBER_NAME = "structure_needs_at_least_one_member"
CONSTANT_MODULE_SUFFIX = "_Constants"
SERVICE_REQUEST_MESSAGE_SUFFIX = "_Request"
SERVICE_RESPONSE_MESSAGE_SUFFIX = "_Response"
SERVICE_EVENT_MESSAGE_SUFFIX = "_Event"
ACTION_GOAL_SUFFIX = "_Goal"
ACTION_RESULT_SUFFIX = "_Result"
ACTION_FEEDBACK_SUFFIX = "_Feedback"
ACTION_GOAL_SERVICE_SUFFIX = "_SendGoal"
ACTION_RESULT_SERVICE_SUFFIX = "_GetResult"
ACTION_FEEDBACK_MESSAGE_SUFFIX = "_FeedbackMessage"


@dataclass(slots=True)
class AbstractType:
    """Any type."""


@dataclass(slots=True)
class AbstractNestableType(AbstractType):
    """A type that may be the element type of arrays and sequences."""


@dataclass(slots=True)
class BasicType(AbstractNestableType):
    """A number, boolean or octet: one of `BASIC_TYPES`."""

    typename: str


@dataclass(slots=True)
class NamedType(AbstractNestableType):
    """A type known by name, but not looked up yet."""

    name: str


@dataclass(slots=True)
class NamespacedType(AbstractNestableType):
    """A message type: ``NamespacedType(['std_msgs', 'msg'], 'Header')``."""

    namespaces: list[str]
    name: str

    def namespaced_name(self) -> tuple[str, ...]:
        """Return all parts of its name."""
        return (*self.namespaces, self.name)


@dataclass(slots=True)
class AbstractGenericString(AbstractNestableType):
    """Any string."""

    def has_maximum_size(self) -> bool:
        """Return whether there is a `maximum_size`, in characters."""
        raise NotImplementedError("Only implemented in subclasses")


@dataclass(slots=True)
class AbstractString(AbstractGenericString):
    """A string of 8-bit characters."""


@dataclass(slots=True)
class BoundedString(AbstractString):
    """A string with a limited number of characters."""

    maximum_size: int

    def has_maximum_size(self) -> Literal[True]:
        """Return whether there is a `maximum_size`, in characters."""
        return True


@dataclass(slots=True)
class UnboundedString(AbstractString):
    """A string of any length."""

    def has_maximum_size(self) -> Literal[False]:
        """Return whether there is a `maximum_size`, in characters."""
        return False


@dataclass(slots=True)
class AbstractWString(AbstractGenericString):
    """A string of 16-bit characters."""


@dataclass(slots=True)
class BoundedWString(AbstractWString):
    """A wide string with a limited number of characters."""

    maximum_size: int

    def has_maximum_size(self) -> Literal[True]:
        """Return whether there is a `maximum_size`, in characters."""
        return True


@dataclass(slots=True)
class UnboundedWString(AbstractWString):
    """A wide string of any length."""

    def has_maximum_size(self) -> Literal[False]:
        """Return whether there is a `maximum_size`, in characters."""
        return False


@dataclass(slots=True)
class AbstractNestedType(AbstractType):
    """An array or sequence of `value_type`."""

    value_type: AbstractNestableType

    def has_maximum_size(self) -> bool:
        """Return whether the number of elements is limited."""
        raise NotImplementedError("Only implemented in subclasses")


@dataclass(slots=True)
class Array(AbstractNestedType):
    """Exactly `size` elements."""

    size: int

    def has_maximum_size(self) -> Literal[True]:
        """Return whether the number of elements is limited."""
        return True


@dataclass(slots=True)
class AbstractSequence(AbstractNestedType):
    """A sequence of elements."""


@dataclass(slots=True)
class BoundedSequence(AbstractSequence):
    """A sequence of at most `maximum_size` elements."""

    maximum_size: int

    def has_maximum_size(self) -> Literal[True]:
        """Return whether the number of elements is limited."""
        return True


@dataclass(slots=True)
class UnboundedSequence(AbstractSequence):
    """A sequence of any number of elements."""

    def has_maximum_size(self) -> Literal[False]:
        """Return whether the number of elements is limited."""
        return False
