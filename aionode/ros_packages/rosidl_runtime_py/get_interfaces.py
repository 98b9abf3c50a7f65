"""Lists the available interfaces."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from aionode.idl.search import has_interfaces, names_in
from aionode.interfaces import shipped_packages
from ament_index_python import get_resources, has_resource

__all__ = [
    "get_action_interfaces",
    "get_interface_packages",
    "get_interface_path",
    "get_interfaces",
    "get_message_interfaces",
    "get_service_interfaces",
]


def get_interface_packages() -> dict[str, str]:
    """Return the packages with interfaces, and their folders; aionode's own are in aionode."""
    import aionode.interfaces

    own = dict.fromkeys(sorted(shipped_packages()), str(Path(aionode.interfaces.__file__).parent))
    try:
        return get_resources("rosidl_interfaces") | own
    except OSError:
        return own


def get_interfaces(package_names: Collection[str] = ()) -> dict[str, list[str]]:
    """Return the interfaces of packages, such as ``msg/String``; of all packages by default.

    Raises:
        LookupError: There is no such package.
    """
    return interfaces(package_names, "")


def get_message_interfaces(package_names: Collection[str] = ()) -> dict[str, list[str]]:
    """Return the messages of packages; see `get_interfaces`."""
    return interfaces(package_names, "msg/")


def get_service_interfaces(package_names: Collection[str] = ()) -> dict[str, list[str]]:
    """Return the services of packages; see `get_interfaces`."""
    return interfaces(package_names, "srv/")


def get_action_interfaces(package_names: Collection[str] = ()) -> dict[str, list[str]]:
    """Return the actions of packages; see `get_interfaces`."""
    return interfaces(package_names, "action/")


def interfaces(package_names: Collection[str], prefix: str) -> dict[str, list[str]]:
    """Return the interfaces of packages whose names begin with a prefix."""
    by_package: dict[str, list[str]] = {}
    for package in package_names or get_interface_packages():
        if not has_interfaces(package) and not installed(package):
            raise LookupError(f"Unknown package '{package}'")
        names = [name.partition("/")[2] for name in names_in(package)]
        by_package[package] = [name for name in names if name.startswith(prefix)]
    return {package: names for package, names in by_package.items() if names}


def installed(package: str) -> str:
    """Return the prefix of an installed package, or None."""
    try:
        return has_resource("packages", package) or ""
    except OSError:
        return ""


def get_interface_path(interface_name: str) -> str:
    """Return the file with the definition of an interface.

    Raises:
        ValueError: The name is not valid.
        LookupError: There is no such file; aionode's own interfaces have none.
    """
    parts = interface_name.split("/")
    bad = f"Invalid name '{interface_name}'. "
    if len(parts) < 2:
        raise ValueError(f"{bad}Expected at least two parts separated by '/'")
    if not all(parts):
        raise ValueError(f"{bad}Must not contain empty parts")
    if ".." in parts:
        raise ValueError(f"{bad}Must not contain '..'")
    prefix = installed(parts[0])
    if not prefix:
        own = parts[0] in shipped_packages()
        raise LookupError(
            f"Package '{parts[0]}' comes with aionode, which has no files of definitions"
            if own
            else f"Unknown package '{parts[0]}'"
        )
    path = Path(prefix, "share", interface_name)
    suffixes = ("",) if path.suffix else (f".{parts[-2]}", ".idl")
    for suffix in suffixes:
        if Path(f"{path}{suffix}").exists():
            return f"{path}{suffix}"
    raise LookupError(f"Could not find the interface '{path}{suffixes[-1]}'")
