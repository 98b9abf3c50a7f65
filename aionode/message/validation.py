"""Validates, creates, compares and prints the values of message fields.

`fit` accepts every value that a user may reasonably assign to a field, and returns it in the form
that subscribers receive; a value already in that form is not copied. Nested messages are handled by
`aionode.message._snapshot`.
"""

from __future__ import annotations

import numbers
import operator
import reprlib
import struct
from collections.abc import Sequence as AbstractSequence
from functools import cache, partial
from typing import TYPE_CHECKING, Any, TypeGuard

import msgspec

from aionode.errors import MessageError
from aionode.message._field_types import DTYPES, INT_RANGES, FieldType

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    import numpy.typing as npt

__all__ = [
    "default_value",
    "fit",
    "fit_array",
    "fit_bytes",
    "fit_element",
    "listed",
    "plain_default",
    "same",
    "shown",
    "zero",
]


def fit(type_: FieldType, value: object, path: str) -> Any:
    """Convert `value` to the form in which subscribers receive a field of this type.

    Raises:
        MessageError: It does not fit; the error names `path`, with an index for an element.
    """
    form = type_.form
    if form == "ndarray":
        return fit_array(type_, value, path)
    if form == "bytes":
        return fit_bytes(type_, value, path)
    if form == "list":
        return fit_list(type_, value, path)
    return fit_element(type_, value, path)


def fit_element(type_: FieldType, value: object, path: str) -> Any:
    """Validate a single value, or one element of a sequence, like `fit`."""
    return ELEMENTS[type_.kind](type_, value, path)


HUGE = "a huge number"

HUGE_BITS = 14_000


def given(value: object) -> str:
    """Format a value and its type for an error text."""
    return f"{short(value)} ({type(value).__name__})"


def short(value: object) -> str:
    """Format a value, shortened, for an error text."""
    # Python refuses to convert ints of more than 4300 digits to text.
    if isinstance(value, int) and value.bit_length() > HUGE_BITS:
        return HUGE
    try:
        return reprlib.repr(value)
    except ValueError:  # such an int is inside a list
        return HUGE


def fit_int(type_: FieldType, value: object, path: str) -> int:
    """Return an int in the range of its type."""
    try:
        number = operator.index(value)  # type: ignore[arg-type] # raises TypeError if it is not an int
    except TypeError:
        number = None
    if number is None or isinstance(value, bool):
        raise MessageError(path, f"{given(value)}, needs an int")
    low, high = INT_RANGES[type_.kind]
    if not low <= number <= high:
        raise MessageError(path, f"{short(number)}, {type_.kind} holds {low} to {high}")
    return number


def fit_float(type_: FieldType, value: object, path: str) -> float:
    """Return a float; a float32 may be rounded, but must not overflow to infinity."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise MessageError(path, f"{given(value)}, needs a float")
    try:
        number = float(value)
        if type_.kind == "float32":
            struct.pack("<f", number)
    except OverflowError:
        problem = f"{short(value)}, too large for a {type_.kind}"
        raise MessageError(path, problem) from None
    return number


def fit_bool(_: FieldType, value: object, path: str) -> bool:
    """Return a bool; a numpy bool is converted."""
    if isinstance(value, bool):
        return value
    kind = type(value)
    if kind.__module__ == "numpy" and kind.__name__.startswith("bool"):
        return bool(value)
    raise MessageError(path, f"{given(value)}, needs a bool")


def fit_byte(_: FieldType, value: object, path: str) -> bytes:
    """Return a bytes object of length 1."""
    if not isinstance(value, bytes | bytearray | memoryview):
        hint = f"; write bytes([{value}])" if isinstance(value, int) else ""
        raise MessageError(path, f"{given(value)}, needs bytes of length 1{hint}")
    if len(value) != 1:
        raise MessageError(path, f"{len(value)} bytes, needs 1")
    return bytes(value)


def fit_string(type_: FieldType, value: object, path: str) -> str:
    """Return a str that can be encoded as UTF-8 and is not too long."""
    if not isinstance(value, str):
        raise MessageError(path, f"{given(value)}, needs a str")
    text = str.__str__(value)
    if not text.isascii():
        try:
            text.encode()
        except UnicodeEncodeError as error:
            problem = f"half a surrogate pair at index {error.start}, which UTF-8 cannot encode"
            raise MessageError(path, problem) from None
    if type_.string_bound is not None and len(text) > type_.string_bound:
        problem = f"{len(text)} characters, at most {type_.string_bound} fit"
        raise MessageError(path, problem)
    return text


ELEMENTS: dict[str, Callable[[FieldType, object, str], object]] = {
    **dict.fromkeys(INT_RANGES, fit_int),
    "float32": fit_float,
    "float64": fit_float,
    "bool": fit_bool,
    "byte": fit_byte,
    "string": fit_string,
    "wstring": fit_string,
}


def check_length(type_: FieldType, length: int, path: str) -> None:
    """Raise `MessageError` if a field of this type cannot have `length` elements."""
    if type_.container == "array" and length != type_.size:
        raise MessageError(path, f"{length} elements, needs {type_.size}")
    if type_.container == "bounded" and length > type_.size:
        raise MessageError(path, f"{length} elements, at most {type_.size} fit")


def is_listing(value: object) -> TypeGuard[AbstractSequence[Any]]:
    """Return whether a value is a sequence other than text or bytes."""
    kind = type(value)
    if kind is list or kind is tuple:  # the usual types, without the slower check of the ABC
        return True
    return isinstance(value, AbstractSequence) and not isinstance(
        value, str | bytes | bytearray | memoryview
    )


def listed(type_: FieldType, value: object, path: str) -> list[Any]:
    """Return a value as a list after checking its length, but not its elements."""
    if type(value).__module__ == "numpy" and hasattr(value, "tolist"):
        value = value.tolist()
    if not is_listing(value):
        raise MessageError(path, f"{given(value)}, needs a list")
    check_length(type_, len(value), path)
    return list(value)


def fit_list(type_: FieldType, value: object, path: str) -> list[str]:
    """Return a list of strings."""
    items = listed(type_, value, path)
    return [fit_string(type_, item, f"{path}[{i}]") for i, item in enumerate(items)]


def fit_bytes(type_: FieldType, value: object, path: str) -> bytes | bytearray | memoryview:
    """Return a bytes-like object; a view of `value` if it is a buffer of single bytes."""
    if isinstance(value, bytes | bytearray):
        data: bytes | bytearray | memoryview = value
    elif isinstance(value, AbstractSequence) and is_listing(value) and not buffered(value):
        data = b"".join(byte_of(type_, item, f"{path}[{i}]") for i, item in enumerate(value))
    else:
        data = bytes_view(value, path)
    check_length(type_, len(data), path)
    return data


def buffered(value: object) -> bool:
    """Return whether a value supports the buffer protocol."""
    if isinstance(value, list | tuple):
        return False
    try:
        memoryview(value)  # type: ignore[arg-type] # raises TypeError if it does not
    except (TypeError, BufferError):
        return False
    return True


def byte_of(type_: FieldType, item: object, path: str) -> bytes:
    """Return one element of a list as a byte; rclpy uses bytes of length 1 for `byte`."""
    if isinstance(item, bytes):
        return fit_byte(type_, item, path)
    return bytes((fit_int(UINT8, item, path),))


UINT8 = FieldType("uint8")


def bytes_view(value: object, path: str) -> bytes | memoryview:
    """Return a contiguous view, or a copy, of a buffer of single bytes."""
    if not buffered(value):
        raise MessageError(path, f"{given(value)}, needs bytes-like or a list of int")
    view = memoryview(value)  # type: ignore[arg-type] # just checked
    if view.nbytes == 0:
        return b""
    if view.ndim != 1:
        problem = f"{view.ndim} dimensions, needs 1; use .reshape(-1) or .tobytes()"
        raise MessageError(path, problem)
    if view.format not in {"B", "c"}:
        problem = f"a {type(value).__name__} of format {view.format!r}, needs single bytes ('B')"
        raise MessageError(path, problem)
    return view.cast("B") if view.contiguous else bytes(view)


def fit_array(type_: FieldType, value: object, path: str) -> npt.NDArray[Any]:
    """Return a one-dimensional array of the field's dtype; if newly created, it is read-only."""
    import numpy as np

    dtype = dtype_of(type_.kind)
    if isinstance(value, np.ndarray):
        array = value
    elif is_listing(value) and not buffered(value):
        array = array_of_items(type_, value, path, dtype)
    elif buffered(value) and not isinstance(value, bytes | bytearray):
        array = np.asarray(value)
    else:
        raise MessageError(path, f"{given(value)}, needs a list or a numpy array")
    if array.ndim != 1:
        raise MessageError(path, f"an array of {array.ndim} dimensions, needs 1")
    check_length(type_, len(array), path)
    return array if array.dtype is dtype or array.dtype == dtype else cast(type_, array, path)


@cache
def dtype_of(kind: str) -> np.dtype[Any]:
    """Return the dtype of arrays of an element type."""
    import numpy as np  # numpy is imported on first use

    return np.dtype(DTYPES[kind])


def frozen(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return the array after marking it read-only."""
    array.flags.writeable = False
    return array


FAST_ITEMS: dict[str, set[type]] = {"bool": {bool}, "float64": {float, int}}
"""Element classes that numpy converts correctly by itself; {int} for the other types."""


def array_of_items(
    type_: FieldType, items: AbstractSequence[object], path: str, dtype: npt.DTypeLike
) -> npt.NDArray[Any]:
    """Return the elements of a list as an array."""
    import numpy as np

    kinds = set(map(type, items))
    fast = FAST_ITEMS.get(type_.kind, {int})
    if type_.kind != "float32" and kinds <= fast:
        try:
            return frozen(np.array(items, dtype))
        except OverflowError:
            pass  # the invalid element is named below
    fitted = [fit_element(type_, item, f"{path}[{i}]") for i, item in enumerate(items)]
    return frozen(np.array(fitted, dtype))


def cast(type_: FieldType, array: npt.NDArray[Any], path: str) -> npt.NDArray[Any]:
    """Return an array converted to the field's dtype, if every element fits."""
    import numpy as np

    dtype = dtype_of(type_.kind)
    if array.dtype.kind == "O":
        return array_of_items(type_, list(array), path, dtype)
    fitting = {"b": "b", "i": "iu", "u": "iu", "f": "iuf"}[dtype.kind]
    if array.dtype.kind not in fitting and array.size:
        raise MessageError(path, f"an array of {array.dtype}, needs {dtype}")
    with np.errstate(over="ignore", invalid="ignore"):
        result = array.astype(dtype)
    if dtype.kind in "iu":
        low, high = INT_RANGES[type_.kind]
        misfits = (array < low) | (array > high)
    else:
        misfits = np.isinf(result) & ~np.isinf(array) if dtype.kind == "f" else ~(result == array)
    if misfits.any():
        index = int(misfits.argmax())
        fit_element(type_, array[index].item(), f"{path}[{index}]")
    return frozen(result)


SHOWN_ELEMENTS = 1000
"""Longer sequences are abbreviated in a repr, as in numpy, so that an image fits a log line."""


def zero(kind: str) -> Any:
    """Return the default value of a type."""
    if kind in INT_RANGES:
        return 0
    return {"bool": False, "byte": b"\0", "string": "", "wstring": ""}.get(kind, 0.0)


def plain_default(type_: FieldType, given_: object, path: str) -> object:
    """Return a default in its normal form, which is None for the zero of the type.

    Raises:
        MessageError: It does not fit the field.
    """
    if type_.kind == "message":
        raise MessageError(path, "a nested message cannot have a default here; write DEFAULT")
    if type_.container == "single":
        value = fit_element(type_, given_, path)
        return None if value == zero(type_.kind) and str(value) != "-0.0" else value
    if isinstance(given_, bytes) and type_.form == "bytes":
        given_ = list(given_)
    if not is_listing(given_):
        raise MessageError(path, f"{given(given_)}, needs a list or tuple")
    check_length(type_, len(given_), path)
    unit = FieldType("uint8") if type_.kind == "byte" else type_
    values = tuple(fit_element(unit, v, f"{path}[{i}]") for i, v in enumerate(given_))
    nothing = (zero(unit.kind),) * zeroed(type_)
    return None if values == nothing else values


def default_value(type_: FieldType, default: object) -> Any:
    """Return the default in the form that msgspec expects: a factory for mutable values."""
    if type_.form == "value" and type_.nested is None:
        return zero(type_.kind) if default is None else default
    if type_.form == "bytes":
        return bytes(default if isinstance(default, tuple) else zeroed(type_))
    return msgspec.field(default_factory=default_factory(type_, default))


def zeroed(type_: FieldType) -> int:
    """Return the number of elements of a default value."""
    return type_.size if type_.container == "array" else 0


def default_factory(type_: FieldType, default: object) -> Callable[[], Any]:
    """Return a function that creates the default of a field with a mutable value."""
    if type_.form == "ndarray":
        dtype = DTYPES[type_.kind]
        if default is not None:
            return partial(filled, dtype, default)
        return partial(zeros, dtype, type_.size) if type_.container == "array" else EMPTY[dtype]
    count = zeroed(type_)
    if type_.nested is not None:
        return (
            partial(several, type_.nested, count) if type_.container != "single" else type_.nested
        )
    if isinstance(default, tuple):
        return partial(list, default)
    return partial(several, str, count) if count else list


def several(make: Callable[[], Any], count: int) -> list[Any]:
    """Return `count` new messages or empty strings."""
    return [make() for _ in range(count)]


def filled(dtype: str, values: Any) -> npt.NDArray[Any]:
    """Return a new array of `values`."""
    import numpy as np

    return np.array(values, dtype)


def zeros(dtype: str, size: int) -> npt.NDArray[Any]:
    """Return a new array of zeros."""
    import numpy as np

    return np.zeros(size, dtype)


@cache
def empty(dtype: str) -> npt.NDArray[Any]:
    """Return the empty array of a dtype, which can be shared as it has no elements."""
    import numpy as np

    array = np.empty(0, dtype)
    array.flags.writeable = False
    return array


EMPTY = {dtype: partial(empty, dtype) for dtype in set(DTYPES.values())}
"""Functions that return the empty array of each dtype."""

BYTES_LIKE = bytes | bytearray | memoryview

SCALARS = frozenset({int, float, str, bool, bytes})


def same(value: Any, other: Any) -> bool:
    """Return whether two values of a field are equal, whatever types hold them."""
    kind = value.__class__
    if kind in SCALARS and other.__class__ is kind:
        return bool(value == other)
    if is_listing(value) and is_listing(other):
        return len(value) == len(other) and all(map(same, value, other))
    if isinstance(value, BYTES_LIKE) and isinstance(other, BYTES_LIKE):
        return value == other
    if isinstance(value, BYTES_LIKE | list) and isinstance(other, BYTES_LIKE | list):
        return list(value) == list(other)
    if hasattr(value, "__array__") or hasattr(other, "__array__"):
        return same_numbers(value, other)
    return bool(value == other)


def same_numbers(value: Any, other: Any) -> bool:
    """Return whether two values are equal, at least one of which is an array."""
    import numpy as np  # numpy is imported on first use

    if isinstance(other, BYTES_LIKE):
        value, other = other, value
    return np.array_equal(
        np.frombuffer(value, "B") if isinstance(value, BYTES_LIKE) else value, other
    )


def shown(type_: FieldType, value: Any) -> str:
    """Format a value like rclpy: sequences of numbers as lists, arrays like numpy."""
    if type_.container == "array" or type_.form in {"value", "list"}:
        return repr(value)
    if len(value) > SHOWN_ELEMENTS:
        first, last = (", ".join(map(repr, elements(part))) for part in (value[:3], value[-3:]))
        return f"[{first}, ..., {last}]"
    if type_.kind == "byte":
        return repr([bytes((item,)) if isinstance(item, int) else item for item in value])
    return repr(elements(value))


def elements(value: Any) -> list[Any]:
    """Return the elements of bytes, an array or a list as Python objects."""
    return value.tolist() if hasattr(value, "tolist") else list(value)
