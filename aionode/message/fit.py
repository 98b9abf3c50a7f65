"""Whether a value fits a field, and the form in which its readers get it.

`fit` takes every value that a user may reasonably put into a field and returns it in the one form
that readers see; a value that is in that form already comes back as it is, without a copy. Messages
within messages are the business of `aionode.message.snapshot`, which takes them apart.
"""

from __future__ import annotations

import numbers
import operator
import reprlib
import struct
from collections.abc import Sequence as AbstractSequence
from functools import cache
from typing import TYPE_CHECKING, Any, TypeGuard

from aionode.errors import MessageError
from aionode.message.fieldtypes import DTYPES, INT_RANGES, FieldType

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    import numpy.typing as npt

__all__ = ["fit", "fit_array", "fit_bytes", "fit_element", "listed"]


def fit(type_: FieldType, value: object, path: str) -> Any:
    """Return `value` as the readers of a field of this type see it.

    Raises:
        MessageError: It does not fit; the error names `path`, with an index where there is one.
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
    """Return one value, or one element of several, as readers see it; raise `MessageError`."""
    return ELEMENTS[type_.kind](type_, value, path)


HUGE = "a huge number"
HUGE_BITS = 14_000


def given(value: object) -> str:
    """Return a value and its type for the text of an error."""
    return f"{short(value)} ({type(value).__name__})"


def short(value: object) -> str:
    """Return a value, shortened, for the text of an error."""
    # Python writes no int of more than 4300 digits, and says so in other words from 3.14 on.
    if isinstance(value, int) and value.bit_length() > HUGE_BITS:
        return HUGE
    try:
        return reprlib.repr(value)
    except ValueError:  # there is one in a list
        return HUGE


def fit_int(type_: FieldType, value: object, path: str) -> int:
    """Return an exact int in the range of its kind."""
    try:
        number = operator.index(value)  # type: ignore[arg-type] # the question is whether it is one
    except TypeError:
        number = None
    if number is None or isinstance(value, bool):
        raise MessageError(path, f"{given(value)}, needs an int")
    low, high = INT_RANGES[type_.kind]
    if not low <= number <= high:
        raise MessageError(path, f"{short(number)}, {type_.kind} holds {low} to {high}")
    return number


def fit_float(type_: FieldType, value: object, path: str) -> float:
    """Return a float; a float32 has to be able to hold it, if not exactly, then not as infinity."""
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
    """Return a bool, made of numpy's where it is one of those."""
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
    """Return an exact str that UTF-8 can hold and that is not too long."""
    if not isinstance(value, str):
        raise MessageError(path, f"{given(value)}, needs a str")
    text = str.__str__(value)
    if not text.isascii():
        try:
            text.encode()
        except UnicodeEncodeError as error:
            problem = f"half a surrogate pair at index {error.start}, which UTF-8 cannot hold"
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
    """Return whether a value is a sequence of elements, as opposed to text or bytes."""
    kind = type(value)
    if kind is list or kind is tuple:  # the usual ones, without the detour of an ABC
        return True
    return isinstance(value, AbstractSequence) and not isinstance(
        value, str | bytes | bytearray | memoryview
    )


def listed(type_: FieldType, value: object, path: str) -> list[Any]:
    """Return a list of as many elements as the field can have, whatever they are."""
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
    """Return a bytes-like object, of the memory of `value` where that holds single bytes."""
    if isinstance(value, bytes | bytearray):
        found: bytes | bytearray | memoryview = value
    elif isinstance(value, AbstractSequence) and is_listing(value) and not buffered(value):
        found = b"".join(byte_of(type_, item, f"{path}[{i}]") for i, item in enumerate(value))
    else:
        found = bytes_view(value, path)
    check_length(type_, len(found), path)
    return found


def buffered(value: object) -> bool:
    """Return whether a value gives access to its memory."""
    if isinstance(value, list | tuple):
        return False
    try:
        memoryview(value)  # type: ignore[arg-type] # the question is whether it does
    except (TypeError, BufferError):
        return False
    return True


def byte_of(type_: FieldType, item: object, path: str) -> bytes:
    """Return one element of a list as a byte; rclpy has bytes of length 1 in lists of `byte`."""
    if isinstance(item, bytes):
        return fit_byte(type_, item, path)
    return bytes((fit_int(UINT8, item, path),))


UINT8 = FieldType("uint8")


def bytes_view(value: object, path: str) -> bytes | memoryview:
    """Return the memory of a buffer of single bytes, in one piece."""
    if not buffered(value):
        raise MessageError(path, f"{given(value)}, needs bytes-like or a list of int")
    view = memoryview(value)  # type: ignore[arg-type] # just asked
    if view.nbytes == 0:
        return b""
    if view.ndim != 1:
        problem = f"{view.ndim} dimensions, needs 1; .reshape(-1) or .tobytes() give that"
        raise MessageError(path, problem)
    if view.format not in {"B", "c"}:
        problem = f"a {type(value).__name__} of format {view.format!r}, needs single bytes ('B')"
        raise MessageError(path, problem)
    return view.cast("B") if view.contiguous else bytes(view)


def fit_array(type_: FieldType, value: object, path: str) -> npt.NDArray[Any]:
    """Return an array of one dimension and the right dtype; one made here is read-only."""
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
    """Return the dtype of the arrays of a kind."""
    import numpy as np  # numpy is loaded when it is first needed

    return np.dtype(DTYPES[kind])


def frozen(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Return the array after marking it read-only."""
    array.flags.writeable = False
    return array


FAST_ITEMS: dict[str, set[type]] = {"bool": {bool}, "float64": {float, int}}
"""What numpy converts without a closer look at each element; {int} for the other kinds."""


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
            pass  # found and named below
    fitted = [fit_element(type_, item, f"{path}[{i}]") for i, item in enumerate(items)]
    return frozen(np.array(fitted, dtype))


def cast(type_: FieldType, array: npt.NDArray[Any], path: str) -> npt.NDArray[Any]:
    """Return an array of another dtype as one of this field's, if every element fits."""
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
