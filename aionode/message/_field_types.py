# ruff: noqa: PYI042 (the aliases have ROS's names)
"""The types of message fields, and the annotations for them.

At run time an annotation such as ``Array[float64, 9]`` is `typing.Annotated` with a `FieldType`.
Type checkers see ``int32`` as ``int``, ``float64`` as ``float``, ``Bounded[str, 10]`` as ``str``.
They do not support numbers as type arguments, so ``Array[T, N]`` and ``Sequence[T]`` are ``Any`` to
them; ``Annotated[Floats, Array[float64, 9]]``, which generated modules use, is checked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias, get_args, get_origin

from msgspec import Struct

from aionode.errors import brief

__all__ = [
    "DTYPES",
    "INT_RANGES",
    "Array",
    "Bools",
    "Bounded",
    "Bytes",
    "Constant",
    "Field",
    "FieldType",
    "Floats",
    "Ints",
    "Sequence",
    "byte",
    "char",
    "field_type",
    "float32",
    "float64",
    "int8",
    "int16",
    "int32",
    "int64",
    "uint8",
    "uint16",
    "uint32",
    "uint64",
    "wstring",
]

INT_RANGES: dict[str, tuple[int, int]] = {
    **{f"int{bits}": (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": (0, 2**bits - 1) for bits in (8, 16, 32, 64)},
    "char": (0, 255),
}
"""Minimum and maximum of each integer type; `char` is an unsigned byte in ROS 2."""

DTYPES: dict[str, str] = {
    **{kind: kind for kind in (*INT_RANGES, "float32", "float64", "bool")},
    "char": "uint8",
}
"""Name of the numpy dtype for each type whose arrays are `numpy.ndarray`."""


class FieldType(Struct, frozen=True):
    """The type of one field.

    Attributes:
        kind: ``int8`` to ``uint64``, ``float32``, ``float64``, ``bool``, ``byte``, ``char``,
            ``string``, ``wstring`` or ``message``.
        nested: The class, a subclass of `Message`, if `kind` is ``message``; None otherwise.
        string_bound: Largest length of a string in characters, or None.
        container: ``single`` value, ``array`` of exactly `size` elements, ``bounded`` sequence of
            at most `size` elements, or ``unbounded`` sequence.
        size: Number of elements; see `container`.
    """

    kind: str
    nested: Any = None
    string_bound: int | None = None
    container: Literal["single", "array", "bounded", "unbounded"] = "single"
    size: int = 0

    @property
    def form(self) -> Literal["value", "bytes", "ndarray", "list"]:
        """The kind of Python object that holds the value; ``bytes`` is any bytes-like object."""
        if self.container == "single":
            return "value"
        if self.kind == "byte" or (self.kind == "uint8" and self.container != "array"):
            return "bytes"
        return "ndarray" if self.kind in DTYPES else "list"

    @property
    def element(self) -> FieldType:
        """The type of one element, or of a single value itself."""
        return FieldType(self.kind, self.nested, self.string_bound)

    def __str__(self) -> str:
        """Return the type as written in a ``.msg`` file, such as ``string<=10[<=3]``."""
        name = self.nested.__ros_type__.replace("/msg/", "/") if self.nested else self.kind
        bound = "" if self.string_bound is None else f"<={self.string_bound}"
        ends = {
            "single": "",
            "array": f"[{self.size}]",
            "bounded": f"[<={self.size}]",
            "unbounded": "[]",
        }
        return f"{name}{bound}{ends[self.container]}"


class Field(Struct, frozen=True):
    """One field of a message.

    Attributes:
        name: Its name, in ROS and in Python.
        type: Its type.
        default: Its default value (a tuple for arrays and sequences), or None for the type's zero
            value.
    """

    name: str
    type: FieldType
    default: object = None


class Constant(Struct, frozen=True):
    """One constant of a message: its name, type and value."""

    name: str
    type: FieldType
    value: object


int8: TypeAlias = Annotated[int, FieldType("int8")]
int16: TypeAlias = Annotated[int, FieldType("int16")]
int32: TypeAlias = Annotated[int, FieldType("int32")]
int64: TypeAlias = Annotated[int, FieldType("int64")]
uint8: TypeAlias = Annotated[int, FieldType("uint8")]
uint16: TypeAlias = Annotated[int, FieldType("uint16")]
uint32: TypeAlias = Annotated[int, FieldType("uint32")]
uint64: TypeAlias = Annotated[int, FieldType("uint64")]
float32: TypeAlias = Annotated[float, FieldType("float32")]
float64: TypeAlias = Annotated[float, FieldType("float64")]
byte: TypeAlias = Annotated[bytes, FieldType("byte")]
char: TypeAlias = Annotated[int, FieldType("char")]
wstring: TypeAlias = Annotated[str, FieldType("wstring")]

BUILTINS = {bool: FieldType("bool"), str: FieldType("string")}


def field_type(annotation: object) -> FieldType:
    """Return the field type that `annotation` describes.

    Raises:
        TypeError: It is not one of this module's annotations, `bool`, `str` or a message class.
    """
    if isinstance(annotation, type):
        if annotation in BUILTINS:
            return BUILTINS[annotation]
        if hasattr(annotation, "__ros_fields__"):
            return FieldType("message", nested=annotation)
    elif get_origin(annotation) is Annotated:
        for extra in reversed(get_args(annotation)[1:]):
            if isinstance(extra, FieldType):
                return extra
            if get_origin(extra) is Annotated:
                return field_type(extra)
    hint = {int: "; int has no width, use int32 or int64", float: "; use float32 or float64"}
    shown = annotation.__name__ if isinstance(annotation, type) else repr(annotation)
    more = hint.get(annotation, "") if isinstance(annotation, type) else ""
    msg = f"{shown}: not a field type; the field types are listed in aionode.message{more}"
    raise TypeError(msg)


def contained(
    annotation: object, container: Literal["array", "bounded", "unbounded"], size: object = 0
) -> object:
    """Return the annotation for an array or sequence of `annotation`."""
    element = field_type(annotation)
    if element.container != "single":
        msg = f"{element}: ROS has no arrays of arrays; put the inner array into its own message"
        raise TypeError(msg)
    count = 0 if container == "unbounded" else checked_size(element, size)
    return Annotated[
        Any, FieldType(element.kind, element.nested, element.string_bound, container, count)
    ]


def checked_size(field_type: FieldType, size: object) -> int:
    """Return the size or bound of a container or string, or raise `TypeError`."""
    if get_origin(size) is Literal:
        (size,) = get_args(size)
    if not isinstance(size, int) or size < 1:
        msg = f"{field_type}: size or bound {brief(size)} given; it must be an int of at least 1"
        raise TypeError(msg)
    return size


# mypy accepts any type arguments for a name of type Any, pyright for a `__class_getitem__`.
MYPY = False

if TYPE_CHECKING:
    from collections.abc import Sequence as AbstractSequence
    from typing import Annotated as Bounded
    from typing import Generic, TypeVar, overload

    import numpy as np
    import numpy.typing as npt

    if MYPY:
        Array: Any
        Sequence: Any
    else:

        class Array:
            """``Array[T, N]``: exactly `N` elements."""

            def __class_getitem__(cls, item: Any) -> Any: ...
            def __get__(self, instance: Any, owner: Any) -> Any: ...
            def __set__(self, instance: Any, value: Any) -> None: ...

        class Sequence:
            """``Sequence[T]``: any number of elements; ``Sequence[T, N]``: at most `N`."""

            def __class_getitem__(cls, item: Any) -> Any: ...
            def __get__(self, instance: Any, owner: Any) -> Any: ...
            def __set__(self, instance: Any, value: Any) -> None: ...

    ItemT = TypeVar("ItemT")
    DtypeT = TypeVar("DtypeT", bound=np.generic)

    class Numbers(Generic[ItemT, DtypeT]):
        """For type checkers: reads as an array, accepts an array or a sequence of `ItemT`."""

        @overload
        def __get__(self, instance: None, owner: Any) -> Any: ...
        @overload
        def __get__(self, instance: object, owner: Any) -> npt.NDArray[DtypeT]: ...
        def __get__(self, instance: Any, owner: Any) -> Any: ...
        def __set__(
            self, instance: Any, value: npt.NDArray[Any] | AbstractSequence[ItemT]
        ) -> None: ...

    class Bytes:
        """For type checkers: reads as bytes-like, also accepts a sequence of int."""

        @overload
        def __get__(self, instance: None, owner: Any) -> Any: ...
        @overload
        def __get__(self, instance: object, owner: Any) -> bytes | bytearray | memoryview: ...
        def __get__(self, instance: Any, owner: Any) -> Any: ...
        def __set__(
            self,
            instance: Any,
            value: bytes
            | bytearray
            | memoryview
            | npt.NDArray[np.uint8]
            | AbstractSequence[int]
            | AbstractSequence[bytes],
        ) -> None: ...

    # One annotation stands for several dtypes, so what reads them may expect any of these.
    Bools: TypeAlias = Numbers[bool, np.bool_]
    Ints: TypeAlias = Numbers[int, Any]
    Floats: TypeAlias = Numbers[float, Any]
else:
    Bools = Bytes = Floats = Ints = Any

    class Array:
        """``Array[T, N]``: exactly `N` elements."""

        def __class_getitem__(cls, item: tuple[object, int]) -> object:
            """Return the annotation of a field."""
            if not isinstance(item, tuple) or len(item) != 2:
                msg = "Array: an element type and a size are needed, as in Array[float64, 9]"
                raise TypeError(msg)
            return contained(item[0], "array", item[1])

    class Sequence:
        """``Sequence[T]``: any number of elements; ``Sequence[T, N]``: at most `N`."""

        def __class_getitem__(cls, item: object) -> object:
            """Return the annotation of a field."""
            if isinstance(item, tuple):
                return contained(item[0], "bounded", item[1])
            return contained(item, "unbounded")

    class Bounded:
        """``Bounded[str, N]`` or ``Bounded[wstring, N]``: at most `N` characters."""

        def __class_getitem__(cls, item: tuple[object, int]) -> object:
            """Return the annotation of a field."""
            string = field_type(item[0])
            if string.kind not in {"string", "wstring"} or string.container != "single":
                msg = f"Bounded: only strings have a bound, not {string}"
                raise TypeError(msg)
            bound = checked_size(string, item[1])
            return Annotated[str, FieldType(string.kind, string_bound=bound)]
