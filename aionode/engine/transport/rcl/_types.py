"""Maps aionode's classes to the same types in the installed ROS."""

from __future__ import annotations

import ctypes
import importlib
from ctypes import CFUNCTYPE, POINTER, byref, c_uint8, c_void_p
from typing import TYPE_CHECKING, Any, Final

from aionode.engine.transport.rcl._bindings import view
from aionode.errors import TransportError

if TYPE_CHECKING:
    from aionode.engine.transport.rcl._bindings import ByteArray, Rcl

__all__ = ["MessageSupport", "rosidl_class", "type_hash_of"]

MESSAGE_HASH_FIELD: Final = 3
"""Position of ``get_type_hash_func`` in a ``rosidl_message_type_support_t``, in pointers."""

SERVICE_HASH_FIELD: Final = 8
"""The corresponding field of a ``rosidl_service_type_support_t``."""

PARTS: Final = ("Request", "Response", "Event")

IMPLEMENTED: Final = {
    "_SendGoal": "SendGoalService",
    "_GetResult": "GetResultService",
    "_FeedbackMessage": "FeedbackMessage",
}
"""The parts of an action, by the suffix of their names."""


class TypeHash(ctypes.Structure):
    """A ``rosidl_type_hash_t``."""

    _fields_ = (("version", c_uint8), ("value", c_uint8 * 32))


def rosidl_class(type_name: str, type_hash: str) -> Any:
    """Return the installed ROS's class for a message or service type.

    Args:
        type_name: Its ROS name, such as ``std_msgs/msg/String``.
        type_hash: Its RIHS01 hash, which the installed definition must match.

    Raises:
        TransportError: it is not installed, has no type support, or is defined differently.
    """
    cls = find(type_name)
    # Like rclpy.type_support.check_for_type_support, whose error says less.
    meta = type(cls)
    try:
        if meta._TYPE_SUPPORT is None:
            meta.__import_type_support__()
    except Exception as error:  # whatever the import of the generated module raises
        raise TransportError(f"{type_name}: its type support cannot be loaded ({error})") from error
    if meta._TYPE_SUPPORT is None:
        raise TransportError(
            f"{type_name}: its type support cannot be loaded; rebuild its package for this "
            "Python, and source its workspace"
        )
    installed = type_hash_of(cls)
    if installed and type_hash.startswith("RIHS") and installed != type_hash:
        raise TransportError(
            f"{type_name}: the installed ROS has another definition ({installed}, here "
            f"{type_hash}); they are incompatible: use the same version of the "
            "interface package on both sides"
        )
    return cls


def find(type_name: str) -> Any:
    """Return the installed ROS's class for a type.

    Raises:
        TransportError: there is none.
    """
    package, kind, name = type_name.split("/")
    try:
        interface: Any = importlib.import_module(f"{package}.{kind}")
        part = name.rpartition("_")[2]
        whole = name.removesuffix(f"_{part}") if kind != "msg" and part in PARTS else name
        suffix = next((end for end in IMPLEMENTED if whole.endswith(end)), "")
        interface = getattr(interface, whole.removesuffix(suffix) if kind == "action" else whole)
        if kind == "action" and suffix:
            interface = getattr(interface.Impl, IMPLEMENTED[suffix])
        return interface if whole == name else getattr(interface, part)
    except (ImportError, AttributeError) as error:
        raise TransportError(
            f"{type_name}: the installed ROS has no such type ({error}); transport=rcl sends only "
            "types that are built for it: install or build the package that defines it, and source "
            "its workspace"
        ) from error


def pointer(capsule: object) -> int:
    """Return the C pointer in a capsule."""
    api = ctypes.pythonapi
    get_name, get = api.PyCapsule_GetName, api.PyCapsule_GetPointer
    get_name.argtypes, get_name.restype = (ctypes.py_object,), ctypes.c_char_p
    get.argtypes, get.restype = (ctypes.py_object, ctypes.c_char_p), c_void_p
    return int(get(capsule, get_name(capsule)))


def type_hash_of(cls: Any) -> str:
    """Return the RIHS01 hash of an installed type whose support is loaded; empty if it has none."""
    support = pointer(type(cls)._TYPE_SUPPORT)
    index = SERVICE_HASH_FIELD if hasattr(cls, "Request") else MESSAGE_HASH_FIELD
    address = ctypes.cast(support, POINTER(c_void_p))[index]
    if not address:
        return ""
    type_hash = CFUNCTYPE(POINTER(TypeHash), c_void_p)(address)(support)
    return (
        hash_text(type_hash.contents.version, bytes(type_hash.contents.value)) if type_hash else ""
    )


def hash_text(version: int, value: bytes) -> str:
    """Return a type hash as text; empty if it is not set."""
    return f"RIHS{version:02}_{value.hex()}" if version else ""


class MessageSupport:
    """Converts messages of one type between CDR and rosidl's C structures, bypassing Python's.

    Raises:
        TransportError: see `rosidl_class`.
    """

    def __init__(self, rcl: Rcl, cls: Any) -> None:
        meta = type(cls)
        if meta._TYPE_SUPPORT is None:
            meta.__import_type_support__()
        self._rcl = rcl
        self._support = pointer(meta._TYPE_SUPPORT)
        self.create = CFUNCTYPE(c_void_p)(pointer(meta._CREATE_ROS_MESSAGE))
        self.destroy = CFUNCTYPE(None, c_void_p)(pointer(meta._DESTROY_ROS_MESSAGE))

    def to_cdr(self, message: int, array: ByteArray) -> bytes:
        """Serialize a C structure to CDR, using `array` as a buffer.

        Raises:
            TransportError: it cannot be serialized.
        """
        if self._rcl.serialize(message, self._support, byref(array)):
            raise TransportError(self._rcl.error())
        return ctypes.string_at(array.buffer, array.length)

    def from_cdr(self, payload: bytes, message: int) -> None:
        """Fill a C structure.

        Raises:
            TransportError: the bytes are not of this type.
        """
        array = view(payload)
        if self._rcl.deserialize(byref(array), self._support, message):
            raise TransportError(self._rcl.error())
