"""All functions of rcl, rmw and rclpy that the transport uses.

Messages are taken and published as CDR by functions of librcl, through ctypes, as rclpy has no raw
form of requests and holds the GIL while it publishes. Entities are created and destroyed, and the
graph is queried, through rclpy's own extension module, as used by its executors.
"""

from __future__ import annotations

import ctypes
import functools
import importlib.metadata
import importlib.util
import os
import sys
from ctypes import (
    POINTER,
    byref,
    c_char,
    c_char_p,
    c_int,
    c_int64,
    c_size_t,
    c_uint8,
    c_uint64,
    c_void_p,
)
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import TransportError

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["MessageInfo", "Rcl", "RequestId", "ServiceInfo", "load"]

OLDEST: Final = (7, 0)
"""The first release of rclpy with everything needed: that of ROS 2 Jazzy."""

UNNUMBERED: Final = 2**64 - 1
"""RMW_MESSAGE_INFO_SEQUENCE_NUMBER_UNSUPPORTED."""

RMW_VARIABLE: Final = "RMW_IMPLEMENTATION"

INSTALL: Final = (
    "source the ROS 2 of this machine (source /opt/ros/jazzy/setup.bash) and use its Python, or, "
    "on Linux x86-64: pip install 'aionode[ros]'"
)


class MessageInfo(ctypes.Structure):
    """The ``rmw_message_info_t`` of Jazzy and later."""

    _fields_ = (
        ("source_ns", c_int64),
        ("received_ns", c_int64),
        ("sequence", c_uint64),
        ("reception_sequence", c_uint64),
        ("implementation", c_void_p),
        ("gid", c_uint8 * 16),
        ("from_intra_process", ctypes.c_bool),
    )


class RequestId(ctypes.Structure):
    """An ``rmw_request_id_t``: the client, and its sequence number for the request."""

    _fields_ = (("gid", c_uint8 * 16), ("sequence", c_int64))


class ServiceInfo(ctypes.Structure):
    """An ``rmw_service_info_t``."""

    _fields_ = (("source_ns", c_int64), ("received_ns", c_int64), ("request_id", RequestId))


class Gid(ctypes.Structure):
    """An ``rmw_gid_t``."""

    _fields_ = (("implementation", c_void_p), ("data", c_uint8 * 16))


class Allocator(ctypes.Structure):
    """An ``rcutils_allocator_t``."""

    _fields_ = tuple(
        (name, c_void_p)
        for name in ("allocate", "deallocate", "reallocate", "zero_allocate", "state")
    )


class ByteArray(ctypes.Structure):
    """An ``rcutils_uint8_array_t``, which is an ``rmw_serialized_message_t``."""

    _fields_ = (
        ("buffer", c_void_p),
        ("length", c_size_t),
        ("capacity", c_size_t),
        ("allocator", Allocator),
    )


class ByteView(ctypes.Structure):
    """A `ByteArray` that rcl reads: it exposes a bytes object and keeps it alive."""

    _fields_ = (
        ("buffer", c_char_p),
        ("length", c_size_t),
        ("capacity", c_size_t),
        ("allocator", Allocator),
    )


class ErrorString(ctypes.Structure):
    """An ``rcutils_error_string_t``."""

    _fields_ = (("text", c_char * 1024),)


class Rcl:
    """The functions. Those named ``*_without_gil`` release the GIL, the others keep it.

    No thread of the middleware ever needs the GIL, so keeping it cannot deadlock; it saves the loop
    waiting for the GIL after each short call.

    Attributes:
        module: rclpy's extension module.
        middleware: The name of the middleware, such as ``rmw_fastrtps_cpp``.
        is_fast_dds: Whether that is Fast DDS: its gids are those of DDS, and its callbacks report
            each item.
        notify: libc's ``eventfd_write`` as an ``rcl_event_callback_t``, whose signature matches.
    """

    def __init__(self, module: Any, version: str) -> None:
        self.module = module
        self.version = version
        self.middleware: str = module.rclpy_get_rmw_implementation_identifier()
        self.is_fast_dds = self.middleware.startswith("rmw_fastrtps")
        # The functions of rmw and rcutils are found in the libraries that this one depends on,
        # whose names differ between installations.
        rcl = rmw = rcutils = ctypes.PyDLL("librcl.so")
        freely = ctypes.CDLL("librcl.so")
        libc = ctypes.CDLL(None)
        self.notify = ctypes.cast(libc.eventfd_write, c_void_p)

        array, shown, nothing = POINTER(ByteArray), POINTER(ByteView), c_void_p
        self.take = function(
            rcl.rcl_take_serialized_message, nothing, array, POINTER(MessageInfo), nothing
        )
        self.take_without_gil = function(
            freely.rcl_take_serialized_message, nothing, array, POINTER(MessageInfo), nothing
        )
        self.publish = function(rcl.rcl_publish_serialized_message, nothing, shown, nothing)
        self.publish_without_gil = function(
            freely.rcl_publish_serialized_message, nothing, shown, nothing
        )
        self.take_request = function(
            rcl.rcl_take_request_with_info, nothing, POINTER(ServiceInfo), nothing
        )
        self.send_response = function(rcl.rcl_send_response, nothing, POINTER(RequestId), nothing)
        self.send_request = function(rcl.rcl_send_request, nothing, nothing, POINTER(c_int64))
        self.take_response = function(
            rcl.rcl_take_response_with_info, nothing, POINTER(ServiceInfo), nothing
        )
        self.is_available = function(
            rcl.rcl_service_server_is_available, nothing, nothing, POINTER(ctypes.c_bool)
        )
        self.count_subscriptions = function(
            rcl.rcl_publisher_get_subscription_count, nothing, POINTER(c_size_t)
        )
        self.assert_liveliness = function(rcl.rcl_publisher_assert_liveliness, nothing)
        # These wait for running callbacks, which need no GIL.
        self.set_subscription_callback = function(
            freely.rcl_subscription_set_on_new_message_callback, nothing, nothing, nothing
        )
        self.set_service_callback = function(
            freely.rcl_service_set_on_new_request_callback, nothing, nothing, nothing
        )
        self.set_client_callback = function(
            freely.rcl_client_set_on_new_response_callback, nothing, nothing, nothing
        )
        self.add_guard = function(rcl.rcl_wait_set_add_guard_condition, nothing, nothing, nothing)
        self.graph_guard = function(
            rcl.rcl_node_get_graph_guard_condition, nothing, returns=nothing
        )
        self.serialize = function(rmw.rmw_serialize, nothing, nothing, array)
        self.deserialize = function(rmw.rmw_deserialize, shown, nothing, nothing)
        self._publisher_rmw = function(rcl.rcl_publisher_get_rmw_handle, nothing, returns=nothing)
        self._client_rmw = function(rcl.rcl_client_get_rmw_handle, nothing, returns=nothing)
        self._publisher_gid = function(rmw.rmw_get_gid_for_publisher, nothing, POINTER(Gid))
        self._client_gid = function(rmw.rmw_get_gid_for_client, nothing, POINTER(Gid))
        self._new_array = function(rcutils.rcutils_uint8_array_init, array, c_size_t, nothing)
        self._free_array = function(rcutils.rcutils_uint8_array_fini, array)
        self._allocator = Allocator()
        default = rcutils.rcutils_get_default_allocator
        default.argtypes, default.restype = (), Allocator
        self._allocator = default()
        self._get_error = rcutils.rcutils_get_error_string
        self._get_error.argtypes, self._get_error.restype = (), ErrorString
        self._reset_error = function(rcutils.rcutils_reset_error, returns=None)

    def error(self) -> str:
        """Return why this thread's last call failed, and reset it."""
        text: bytes = self._get_error().text
        self._reset_error()
        return text.decode(errors="replace").partition(", at ")[0]

    def forget_error(self) -> None:
        """Reset why this thread's last call failed."""
        self._reset_error()

    def new_array(self, size: int = 256) -> ByteArray:
        """Return an array that rcl can write to; `free_array` frees it."""
        array = ByteArray()
        if self._new_array(byref(array), size, byref(self._allocator)):
            raise TransportError(f"transport=rcl: {self.error()}")
        return array

    def free_array(self, array: ByteArray) -> None:
        """Free an array of `new_array`."""
        self._free_array(byref(array))

    def publisher_gid(self, pointer: int) -> bytes:
        """Return the gid of our publisher; its first 12 bytes identify the context."""
        gid = Gid()
        if self._publisher_gid(self._publisher_rmw(pointer), byref(gid)):
            self.forget_error()
        return bytes(gid.data)

    def client_gid(self, pointer: int) -> bytes:
        """Return the gid of a client of this process."""
        gid = Gid()
        if self._client_gid(self._client_rmw(pointer), byref(gid)):
            self.forget_error()
        return bytes(gid.data)


def function(symbol: Any, *arguments: Any, returns: Any = c_int) -> Any:
    """Return a C function with its signature."""
    symbol.argtypes, symbol.restype = arguments, returns
    return symbol


def view(payload: bytes) -> ByteView:
    """Return an array that exposes `payload` and keeps it alive."""
    size = len(payload)
    return ByteView(payload, size, size)


@functools.cache
def load() -> Rcl:
    """Return the functions of this Python's rclpy.

    Raises:
        TransportError: there is none, it is too old, or its middleware is missing.
    """
    if is_in_python():
        raise TransportError(
            "transport=rcl: in this process, rclpy is aionode's; to run over DDS, use ROS's own "
            "rclpy, or aionode's API instead of rclpy's"
        )
    version = installed_version()
    check_middleware(os.environ)
    try:
        from rclpy.impl.implementation_singleton import rclpy_implementation
    except ImportError as error:
        reason = str(error).partition("\n")[0]  # rclpy's messages have several lines
        raise TransportError(
            f"transport=rcl: Python {sys.version_info.major}.{sys.version_info.minor} cannot "
            f"import rclpy {version} ({reason}); use the Python that it is built for, with its "
            "ROS 2 sourced"
        ) from error
    if not hasattr(os, "eventfd"):
        raise TransportError("transport=rcl: it needs Linux, whose eventfds wake the event loop")
    try:
        return Rcl(rclpy_implementation, version)
    except (OSError, AttributeError) as error:
        raise TransportError(
            f"transport=rcl: the libraries of rclpy {version} are incompatible ({error}); it works "
            "with those of ROS 2 Jazzy and Kilted"
        ) from error
    except Exception as error:  # rclpy's own exceptions, none of which is public
        raise TransportError(middleware_problem(error)) from error


def is_in_python() -> bool:
    """Return whether the rclpy imported by programs of this process is aionode's.

    Its extension module is written in Python.
    """
    loaded = sys.modules.get("rclpy")
    spec = importlib.util.find_spec("rclpy") if loaded is None else None
    file = getattr(loaded, "__file__", None) if spec is None else spec.origin
    return file is not None and Path(file).with_name("_rclpy_pybind11.py").exists()


def installed_version() -> str:
    """Return the version of this Python's rclpy.

    Raises:
        TransportError: there is none, or it is too old.
    """
    try:
        version = importlib.metadata.version("rclpy")
    except importlib.metadata.PackageNotFoundError:
        if importlib.util.find_spec("rclpy") is not None:
            return "of unknown version"
        raise TransportError(
            f"transport=rcl: rclpy is not installed in this Python; {INSTALL}"
        ) from None
    if tuple(map(int, version.split(".")[:2])) < OLDEST:
        raise TransportError(
            f"transport=rcl: rclpy {version} is too old; it needs ROS 2 Jazzy or later (rclpy "
            f"{'.'.join(map(str, OLDEST))})"
        )
    return version


def check_middleware(environ: Mapping[str, str]) -> None:
    """Check that the environment's middleware can be loaded, as rcl would abort the process.

    Raises:
        TransportError: it cannot be loaded.
    """
    name = environ.get(RMW_VARIABLE, "")
    if not name:
        return
    try:
        ctypes.CDLL(f"lib{name}.so")
    except OSError as error:
        raise TransportError(middleware_problem(error)) from error


def middleware_problem(error: Exception) -> str:
    """Return why no middleware could be loaded."""
    name = os.environ.get(RMW_VARIABLE, "")
    return (
        f"transport=rcl: the middleware {RMW_VARIABLE}={name!r} cannot be used "
        f"({str(error).partition(', at ')[0]}); unset it, or install that middleware"
    )
