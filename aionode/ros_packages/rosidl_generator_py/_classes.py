"""Creates the Python classes that rosidl generates, on first use.

Each is created from the description of the aionode class of the same ROS type. Its methods are
compiled from source text that contains only numbers and field names, which aionode has validated.
"""

from __future__ import annotations

import os
import threading
from array import array
from collections.abc import Callable
from functools import partial
from typing import Any, Final

from aionode.idl.search import module_name
from aionode.message import DTYPES, Field, Message, ServiceType, fields, type_name
from aionode.message import constants as constants_of
from rosidl_generator_py._field_types import TYPE_CODES, field_text, is_numeric, slot_type
from rosidl_parser.definition import AbstractSequence, BasicType

__all__ = ["ACTION_PARTS", "SERVICE_PARTS", "aionode_class", "python_class"]

SERVICE_PARTS: Final = ("Request", "Response", "Event")

ACTION_PARTS: Final = ("Goal", "Result", "Feedback")

ZEROS: Final = {"bool": "False", "byte": "b'\\0'", "string": "''", "wstring": "''"}

CLASSES: dict[type[Any], type[Any]] = {}
"""The rosidl class for each aionode class."""

SOURCES: dict[type[Any], type[Any]] = {}
"""The aionode class for each rosidl class."""

MAKING = threading.RLock()
"""Held while a class is created, so that each type has only one."""


def python_class(cls: type[Any]) -> type[Any]:
    """Return the rosidl class for a message, service or action class of aionode."""
    own = CLASSES.get(cls)
    if own is None:
        with MAKING:
            own = CLASSES.get(cls) or register(cls)
    return own


def aionode_class(cls: type[Any]) -> type[Any] | None:
    """Return the aionode class of a class created here or its subclass; None for other classes."""
    return next((SOURCES[base] for base in cls.__mro__ if base in SOURCES), None)


def register(cls: type[Any]) -> type[Any]:
    """Create the class for an aionode class."""
    package, kind, name = type_name(cls).split("/")
    # A part of a service or action is in the module of the whole, whose name has no underscore.
    module = module_name(package, kind, name.partition("_")[0])
    if issubclass(cls, Message):
        own = message_of(cls, name, module)
    elif issubclass(cls, ServiceType):
        own = service_of(cls, name, module)
    else:
        own = action_of(cls, name, module)
    CLASSES[cls], SOURCES[own] = own, cls
    return own


class TypeSupport:
    """Stands in for a C type support; rclpy only checks whether there is one."""

    def __init__(self, typename: str) -> None:
        self.typename = typename

    def __repr__(self) -> str:
        return f"<type support of {self.typename} by aionode>"


TYPE_SUPPORTS: Final = (
    "_CREATE_ROS_MESSAGE",
    "_CONVERT_FROM_PY",
    "_CONVERT_TO_PY",
    "_DESTROY_ROS_MESSAGE",
    "_TYPE_SUPPORT",
)


def metaclass_of(kind: str, name: str, module: str, cls: type[Any], body: dict[str, Any]) -> Any:
    """Return the metaclass of an interface.

    rclpy asks it for the type support, and it contains constants and defaults, which are read-only.
    """
    names = TYPE_SUPPORTS if kind == "message" else TYPE_SUPPORTS[-1:]
    support = TypeSupport(type_name(cls))

    def import_type_support(meta: Any) -> None:
        for attribute in names:
            setattr(meta, attribute, support)

    whole: dict[str, Any] = {
        "__module__": module,
        "__doc__": f"Metaclass of {kind} '{name}'.",
        **dict.fromkeys(names),
        "__import_type_support__": classmethod(import_type_support),
        **body,
    }
    return type(f"Metaclass_{name}", (type,), whole)


def read_only(name: str, doc: str, value: Callable[[], Any]) -> property:
    """Return a property of a metaclass that is named in its errors."""

    def get(_: Any) -> Any:
        return value()

    get.__name__ = name
    return property(get, doc=doc)


def itself(value: Any) -> Any:
    """Return the value of a constant."""
    return value


def message_of(cls: type[Message], name: str, module: str) -> type[Any]:
    """Create a message class."""
    constants = {constant.name: constant.value for constant in constants_of(cls)}
    defaults: dict[str, Callable[[], Any]] = {
        f"{field.name.upper()}__DEFAULT": default_of(field)
        for field in fields(cls)
        if field.default is not None
    }
    shown = {**constants, **{key: make() for key, make in defaults.items()}}
    body: dict[str, Any] = {
        f"_Metaclass_{name}__constants": constants,
        "__prepare__": classmethod(lambda meta, name, bases, **options: dict(shown)),  # noqa: ARG005
    }
    for key, value in constants.items():
        body[key] = read_only(key, f"Message constant '{key}'.", partial(itself, value))
    for key, make in defaults.items():
        field = key.removesuffix("__DEFAULT").lower()
        body[key] = read_only(key, f"Return default value for message field '{field}'.", make)
    metaclass = metaclass_of("message", name, module, cls, body)
    source = ClassSource(cls, name)
    namespace = source.namespace | {
        "METACLASS": metaclass,
        "MODULE": module,
        "REPR": represented,
        "FIELDS": {field.name: field_text(field.type) for field in fields(cls)},
        "SLOTS": [*(f"_{field.name}" for field in fields(cls)), "_check_fields"],
        "TYPES": tuple(slot_type(field.type) for field in fields(cls)),
        "CHECKED": os.environ.get("ROS_PYTHON_CHECK_FIELDS", "") == "1",
    }
    # The source contains only validated field names and numbers: see the module's docstring.
    exec(compile(source.text(), f"<{module}>", "exec"), namespace)  # noqa: S102
    message: type[Any] = namespace[name]
    return message


class LateNumpy:
    """Numpy, imported when the first array of a class is made: rclpy's own types have some."""

    def __getattr__(self, name: str) -> Any:
        import numpy as np

        value = getattr(np, name)
        setattr(self, name, value)
        return value


class ClassSource:
    """The source of one message class, and the values that it refers to by name."""

    def __init__(self, cls: type[Message], name: str) -> None:
        from rosidl_generator_py._checks import field_check, refuse_unknown

        self.fields = fields(cls)
        self.constants = [constant.name for constant in constants_of(cls)]
        self.name = name
        self.namespace: dict[str, Any] = {
            "ARRAY": array,
            "PROPERTY": property,
            "UNKNOWN": refuse_unknown,
        }
        if any(field.type.container == "array" and is_numeric(field.type) for field in self.fields):
            self.namespace["NUMPY"] = LateNumpy()
        for number, field in enumerate(self.fields):
            nested = None if field.type.nested is None else python_class(field.type.nested)
            self.namespace[f"CHECK{number}"] = field_check(field.name, field.type, nested)
            self.namespace[f"T{number}"] = nested

    def text(self) -> str:
        """Return the whole source."""
        lines = [
            f"class {self.name}(metaclass=METACLASS):",
            *self.docstring(),
            "    __module__ = MODULE",
            "    __slots__ = SLOTS",
            "    _fields_and_field_types = FIELDS",
            "    SLOT_TYPES = TYPES",
            "    __repr__ = REPR",
            "    def __init__(self, **kwargs):",
            "        self._check_fields = kwargs.get('check_fields', CHECKED)",
            "        if self._check_fields: UNKNOWN(SLOTS, kwargs)",
        ]
        lines += [self.initial(number, field) for number, field in enumerate(self.fields)]
        lines += ["    def __eq__(self, other):"]
        lines += ["        if not isinstance(other, self.__class__): return False"]
        lines += [self.difference(field) for field in self.fields]
        lines += ["        return True"]
        lines += ["    @classmethod", "    def get_fields_and_field_types(cls):"]
        lines += ["        return dict(cls._fields_and_field_types)"]
        for number, field in enumerate(self.fields):
            lines += self.accessors(number, field)
        return "\n".join(lines)

    def docstring(self) -> list[str]:
        """Return the lines of the docstring, which names the constants."""
        if not self.constants:
            return [f'    """Message class {self.name!r}."""']
        lines = ['    """', f"    Message class {self.name!r}.", "", "    Constants:"]
        return [*lines, *(f"      {name}" for name in self.constants), '    """']

    def initial(self, number: int, field: Field) -> str:
        """Return the constructor's line for a field."""
        name, type_ = field.name, field.type
        given = f"kwargs[{name!r}]"
        if field.default is not None:
            initial = f"{self.name}.{name.upper()}__DEFAULT"
        elif is_numeric(type_) and type_.container != "array":
            # As in rosidl, given values are converted before they are checked.
            code = TYPE_CODES[type_.kind]
            return f"        self.{name} = ARRAY({code!r}, kwargs.get({name!r}, ()))"
        elif is_numeric(type_):
            initial = f"NUMPY.zeros({type_.size}, dtype=NUMPY.{DTYPES[type_.kind]})"
        elif type_.container == "array":
            initial = f"[{self.zero(number, field)} for _ in range({type_.size})]"
        else:
            initial = self.zero(number, field) if type_.container == "single" else "[]"
        return f"        self.{name} = {given} if {name!r} in kwargs else {initial}"

    def zero(self, number: int, field: Field) -> str:
        """Return the expression of the zero of a field's type, or of one element."""
        if field.type.nested is not None:
            return f"T{number}()"
        return ZEROS.get(field.type.kind, "0.0" if field.type.kind.startswith("float") else "0")

    def difference(self, field: Field) -> str:
        """Return the line of ``__eq__`` for a field."""
        differ = f"self.{field.name} != other.{field.name}"
        if field.type.container == "array" and is_numeric(field.type):
            differ = f"any({differ})"
        return f"        if {differ}: return False"

    def accessors(self, number: int, field: Field) -> list[str]:
        """Return the lines of a field's property."""
        name, type_ = field.name, field.type
        value = "value"
        if is_numeric(type_) and type_.container == "array":
            value = f"NUMPY.array(value, dtype=NUMPY.{DTYPES[type_.kind]})"
        elif is_numeric(type_):
            value = f"ARRAY({TYPE_CODES[type_.kind]!r}, value)"
        return [
            "    @PROPERTY",
            f"    def {name}(self):",
            f'        """Message field {name!r}."""',
            f"        return self._{name}",
            f"    @{name}.setter",
            f"    def {name}(self, value):",
            f"        if self._check_fields and CHECK{number}(value):",
            f"            self._{name} = value",
            "        else:",
            f"            self._{name} = {value}",
        ]


def default_of(field: Field) -> Callable[[], Any]:
    """Return a function that creates the default value of a field."""
    type_, default = field.type, field.default
    if type_.container == "single":
        return lambda: default
    assert isinstance(default, tuple | bytes)  # noqa: S101 (of arrays and sequences)
    if is_numeric(type_) and type_.container == "array":

        def ndarray() -> Any:
            import numpy as np

            return np.array(default, dtype=DTYPES[type_.kind])

        return ndarray
    if is_numeric(type_):
        return lambda: array(TYPE_CODES[type_.kind], default)
    if type_.kind == "byte":
        return lambda: [bytes((octet,)) if isinstance(octet, int) else octet for octet in default]
    return lambda: list(default)


def represented(self: Any) -> str:
    """Return a message as rosidl prints it: ``std_msgs.msg.String(data='hi')``."""
    cls = type(self)
    name = ".".join([*cls.__module__.split(".")[:-1], cls.__name__])
    values = []
    for field, slot in zip(self.get_fields_and_field_types(), self.SLOT_TYPES, strict=True):
        value = getattr(self, field)
        text = repr(value)
        if (
            isinstance(slot, AbstractSequence)
            and isinstance(slot.value_type, BasicType)
            and slot.value_type.typename not in {"boolean", "octet"}
        ):
            text = text[len("array('X', ") : -1] if len(value) else "[]"
        values.append(f"{field}={text}")
    return f"{name}({', '.join(values)})"


def not_instantiated(kind: str) -> Callable[[Any], None]:
    """Return the constructor of a service or action class."""

    def refuse(self: Any) -> None:
        raise NotImplementedError(f"{kind} classes can not be instantiated")

    return refuse


def service_of(cls: Any, name: str, module: str) -> type[Any]:
    """Create a service class."""
    metaclass = metaclass_of("service", name, module, cls, {})
    body = {
        "__module__": module,
        "__init__": not_instantiated("Service"),
        **{part: python_class(getattr(cls, part)) for part in SERVICE_PARTS},
    }
    service: type[Any] = metaclass(name, (), body)
    return service


def action_of(cls: Any, name: str, module: str) -> type[Any]:
    """Make an action class."""
    metaclass = metaclass_of("action", name, module, cls, {})
    parts = (
        "SendGoalService",
        "GetResultService",
        "FeedbackMessage",
        "CancelGoalService",
        "GoalStatusMessage",
    )
    implementation = {
        "__module__": module,
        "__qualname__": f"{name}.Impl",
        **{part: python_class(getattr(cls.Impl, part)) for part in parts},
    }
    body = {
        "__module__": module,
        "__init__": not_instantiated("Action"),
        **{part: python_class(getattr(cls, part)) for part in ACTION_PARTS},
        "Impl": type("Impl", (), implementation),
    }
    action: type[Any] = metaclass(name, (), body)
    return action
