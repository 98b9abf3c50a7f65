"""The base class of messages, and functions that describe message classes.

The only public attributes of a message class are its fields and constants, as those may have any
name. Everything else is available from functions: `type_name`, `fields`, `constants`.
`aionode.wire.cdr` encodes messages, by the functions that `engine/wire/cdr/_encoder.py` generates.
"""

from __future__ import annotations

import copy
import functools
import re
import sys
from keyword import iskeyword
from typing import TYPE_CHECKING, Any, ClassVar, dataclass_transform, get_args, get_origin

import msgspec

from aionode.message._fastapi import NoDataclass
from aionode.message._field_types import Constant, Field, field_type
from aionode.message._serialized import unserialized
from aionode.message.type_names import TYPES_BY_NAME, checked_type_name
from aionode.message.validation import default_value, plain_default, same, shown

if TYPE_CHECKING:
    from types import FrameType

__all__ = [
    "DEFAULT",
    "Message",
    "MessageMeta",
    "constants",
    "fields",
    "message_class",
    "type_name",
]

DEFAULT: Any = object()
"""The zero value of any field type: ``header: Header = DEFAULT``.

It is also the default of fields without one; writing it tells type checkers that the field may be
omitted.
"""

FIELD_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")


class MessageMeta(msgspec.StructMeta):
    """Builds the description of a message from annotations, and gives every field a default."""

    def __new__(  # noqa: PYI034 (mypy has no Self in metaclasses)
        mcls,
        name: str,
        bases: tuple[type, ...],
        namespace: dict[str, Any],
        *,
        typename: str = "",
        by_name: bool = True,
        recorded: bool = False,
        **options: Any,
    ) -> MessageMeta:
        """Create the class.

        Args:
            name: Its name in Python.
            bases: Its base classes.
            namespace: Its attributes and annotations.
            typename: Its ROS name, such as ``std_msgs/msg/String``.
            by_name: Whether `aionode.interfaces.get_interface` finds it by its ROS name.
            recorded: Whether names may be others than ROS allows, as in recordings.
            options: Options of `msgspec.Struct`.
        """
        if typename:
            namespace["__ros_type__"] = typename if recorded else checked_type_name(typename)
        own: list[Field] = []
        known: list[Constant] = []
        for key, annotation in annotations_of(namespace, sys._getframe(1)).items():
            if get_origin(annotation) is ClassVar:
                if not key.startswith("__"):
                    (inner,) = get_args(annotation)
                    known.append(Constant(key, field_type(inner), namespace[key]))
                continue
            if not recorded:
                checked_field_name(typename or name, key)
            type_ = field_type(annotation)
            given = namespace.get(key, DEFAULT)
            path = f"{typename or name}.{key}"
            default = None if given is DEFAULT else plain_default(type_, given, path)
            own.append(Field(key, type_, default))
            namespace[key] = default_value(type_, default)
        inherited = [field for base in bases for field in getattr(base, "__ros_fields__", ())]
        namespace["__ros_fields__"] = (*inherited, *own)
        namespace["__ros_constants__"] = tuple(known)
        namespace["__ros_functions__"] = {}
        cls = super().__new__(mcls, name, bases, namespace, eq=False, **options)
        if typename and by_name:
            TYPES_BY_NAME[typename] = cls
        return cls


def annotations_of(namespace: dict[str, Any], frame: FrameType) -> dict[str, Any]:
    """Return the evaluated annotations of a class that is being created in `frame`."""
    annotations: dict[str, Any] | None = namespace.get("__annotations__")
    if annotations is None and sys.version_info >= (3, 14):  # annotations are created on demand
        import annotationlib

        make = annotationlib.get_annotate_from_class_namespace(namespace)
        if make is not None:
            form = annotationlib.Format.VALUE
            annotations = annotationlib.call_annotate_function(make, form)
    return {
        key: eval(value, frame.f_globals, frame.f_locals) if isinstance(value, str) else value  # noqa: S307 (an annotation in the source of a class)
        for key, value in (annotations or {}).items()
    }


def checked_field_name(owner: str, name: str) -> None:
    """Raise `TypeError` if `name` is not a valid name of a ROS field."""
    if not FIELD_NAME.fullmatch(name) or iskeyword(name):
        msg = (
            f"{owner}.{name}: not a valid ROS field name; use lower-case letters, digits and "
            "single underscores, starting with a letter, and no Python keyword"
        )
        raise TypeError(msg)


class PydanticSerializer:
    """What writes messages where Pydantic knows no type: in `Any`, and in lists and dicts of it."""

    def __get__(self, _message: object, cls: type[Message]) -> Any:
        """Return Pydantic's serializer of a message class, made when it is first asked for."""
        from aionode.message._schema import pydantic_serializer  # as below

        if "pydantic_serializer" not in cls.__ros_functions__:
            cls.__ros_functions__["pydantic_serializer"] = pydantic_serializer(cls)
        return cls.__ros_functions__["pydantic_serializer"]


def written(message: Message) -> dict[str, Any]:
    """Return a message as builtin types, only with values that JSON has."""
    from aionode.message._schema import in_json  # as above

    return in_json(message)


@dataclass_transform(kw_only_default=True, field_specifiers=(msgspec.field,))
class Message(msgspec.Struct, metaclass=MessageMeta):  # noqa: PLW1641 (mutable: no hash)
    """Base class of all messages.

    Write a message as a class with annotations from `aionode.message`::

        class Words(Message, typename="tutorial/msg/Words"):
            text: str = ""
            scores: Sequence[float32] = DEFAULT

    Every field has a default. Values are given by keyword, and validated when the message is
    published, sent or encoded. Two messages are equal if they have the same class and equal values,
    arrays included. Copies and pickles share no data with the original.
    """

    __ros_type__: ClassVar[str] = ""
    __ros_fields__: ClassVar[tuple[Field, ...]]
    __ros_constants__: ClassVar[tuple[Constant, ...]]
    __ros_functions__: ClassVar[dict[str, Any]]
    """Functions generated for this class, by purpose."""

    __pydantic_serializer__: ClassVar[Any] = PydanticSerializer()
    __dataclass_fields__: ClassVar[Any] = NoDataclass(written)

    def __eq__(self, other: object) -> bool:
        """Return whether both have the same class and values."""
        if other.__class__ is not self.__class__:
            return NotImplemented
        return all(same(getattr(self, f), getattr(other, f)) for f in self.__struct_fields__)

    def __ne__(self, other: object) -> bool:
        """Return whether class or values differ."""
        if other.__class__ is not self.__class__:
            return NotImplemented
        return not self == other

    def __repr__(self) -> str:
        """Return the message as rclpy prints it: ``std_msgs.msg.String(data='hi')``."""
        name = self.__ros_type__.replace("/", ".") or type(self).__qualname__
        values = (f"{f.name}={shown(f.type, getattr(self, f.name))}" for f in self.__ros_fields__)
        return f"{name}({', '.join(values)})"

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:
        """Return the schema with which Pydantic reads and writes messages."""
        # Imported here, as that module imports this one, and Pydantic, which few programs use.
        from aionode.message._schema import pydantic_core_schema

        return pydantic_core_schema(cls)

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema: Any, handler: Any) -> Any:
        """Return the JSON Schema of the message, for OpenAPI."""
        from aionode.message._schema import pydantic_json_schema  # as above

        return pydantic_json_schema(cls, handler)

    def __deepcopy__(self, memo: dict[int, Any]) -> Message:
        """Return a copy that shares no mutable data."""
        return type(self)(*(copy.deepcopy(owned(self, f), memo) for f in self.__struct_fields__))

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how to recreate the message, for pickle."""
        values = {name: owned(self, name) for name in self.__struct_fields__}
        return functools.partial(type(self), **values), ()


def owned(message: Message, name: str) -> object:
    """Return the value of a field; a memoryview as bytes, as it cannot be pickled."""
    value = getattr(message, name)
    return bytes(value) if isinstance(value, memoryview) else value


def type_name(cls: Any) -> str:
    """Return the ROS name of a message, service or action class, such as ``std_msgs/msg/String``.

    Nested messages have names such as ``example_interfaces/srv/AddTwoInts_Request``.

    Raises:
        TypeError: `cls` is not such a class, or has no ROS name.
    """
    name = getattr(cls, "__ros_type__", None) if isinstance(cls, type) else None
    if name is None:
        msg = f"{cls!r}: not a message, service or action class"
        raise TypeError(msg)
    if not name:
        msg = f"{cls.__qualname__}: has no ROS name; give it typename='my_package/msg/Name'"
        raise TypeError(msg)
    return str(name)


def message_class(cls: Any) -> type[Message]:
    """Return `cls` if it is a message class; raise `TypeError` otherwise."""
    if not isinstance(cls, MessageMeta):
        msg = f"{cls!r}: not a message class"
        if hasattr(cls, "__ros_type__"):
            msg += "; for a service or action use one of its nested messages, such as .Request"
        raise TypeError(msg)
    return cls  # type: ignore[return-value] # all classes of this metaclass are messages


def fields(cls: type[Message]) -> tuple[Field, ...]:
    """Return the fields of a message class, in the order of their encoding.

    Raises:
        TypeError: `cls` is not a message class.
    """
    return message_class(unserialized(cls)).__ros_fields__


def constants(cls: type[Message]) -> tuple[Constant, ...]:
    """Return the constants of a message class, in the order of its definition.

    Raises:
        TypeError: `cls` is not a message class.
    """
    return message_class(cls).__ros_constants__
