"""ROS 2's standard interfaces as Python classes, under their ROS names.

``std_msgs/msg/String`` is `aionode.interfaces.std_msgs.msg.String`. The modules of the packages are
generated from ROS 2 Jazzy's definitions; this one finds a class by its name, including classes that
the program itself defines. Nothing is imported before it is asked for.

Packages with definitions of their own can be imported here as well, without a build:
``from aionode.interfaces.my_msgs.msg import Words``. They are looked for in the folders of
``AIONODE_INTERFACES`` and ``--interfaces``, in the ROS 2 that is sourced (``AMENT_PREFIX_PATH``),
and in the workspace around the program: the folder ``src``, or else the repository, that it is in.

The sourced ROS 2's definition of a type takes precedence over the shipped one. ``ROS_DISTRO`` alone
selects the known differences. Packages that are not in `OF_ROS` may be defined in a folder or in
the workspace, and that definition takes precedence as well.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from importlib.util import find_spec
from operator import attrgetter
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from aionode.errors import InterfaceNotFoundError
from aionode.message import ActionType, Message, ServiceType
from aionode.message.type_names import TYPES_BY_NAME

if TYPE_CHECKING:
    from importlib.abc import Loader
else:
    # Before Python 3.12 the module of the real class imports `importlib.resources`, and with it
    # archives and temporary files: 5 to 9 ms at the start of each program.
    Loader = object

__all__ = [
    "get_action",
    "get_interface",
    "get_message",
    "get_service",
    "interface_names",
    "part_of",
    "shipped_packages",
    "whole_of",
]

KINDS = ("msg", "srv", "action")

PARTS = {
    "Event": "Event",
    "Request": "Request",
    "Response": "Response",
    "Goal": "Goal",
    "Result": "Result",
    "Feedback": "Feedback",
    "FeedbackMessage": "Impl.FeedbackMessage",
    "SendGoal": "Impl.SendGoalService",
    "GetResult": "Impl.GetResultService",
}
"""The attribute of a service or an action that is a type, by the end of the type's name."""

MAX_NAME = 300
"""Longer names get no suggestions, since a comparison takes time that grows with their length."""

LISTED = r"(?ms)^__all__ = \[(.*?)\]"
"""Where a generated module lists its types."""

CLOSE = 0.85
"""How similar a name has to be to be suggested, from 0 to 1."""


def get_interface(name: str) -> Any:
    """Return the class of a message, service or action type.

    Type checkers know nothing of a class that is found by name: to them the result is `Any`, which
    they accept wherever a class of its kind is wanted. For a type that neither aionode nor the
    program has, `Node.find_type` asks the nodes that use it.

    Args:
        name: Its ROS name, such as ``std_msgs/msg/String``; ``std_msgs/String`` is understood if
            only one kind of interface has that name. The types that belong to a service or an
            action have names, too: ``example_interfaces/action/Fibonacci_FeedbackMessage``.

    Raises:
        InterfaceNotFoundError: There is no such type; the error suggests similar names.
        IdlError: The definition of the type, in a folder that was loaded, is not valid.
    """
    parts = name.split("/")
    kinds = KINDS if len(parts) == 2 else parts[1:2]
    if len(parts) in {2, 3}:
        for kind in kinds:
            found = type_of(parts[0], kind, parts[-1])
            if found is not None:
                return found
            module = sys.modules.get(f"{__name__}.{parts[0]}.{kind}")
            refused: dict[str, Exception] = vars(module).get("__refused__", {}) if module else {}
            if parts[-1] in refused:
                raise refused[parts[-1]]
    whole = whole_of(name)
    if whole is not None:
        return part_of(name, get_interface(whole))
    raise not_found(name, parts)


def whole_of(name: str) -> str | None:
    """Return the name of the service or action that a type belongs to; None for other types.

    Args:
        name: The name of a type, such as ``example_interfaces/action/Fibonacci_FeedbackMessage``.
    """
    whole, _, part = name.rpartition("_")
    is_part = part in PARTS and name.split("/")[1:2] in (["srv"], ["action"])
    return whole if is_part else None


def part_of(name: str, whole: Any) -> Any:
    """Return a type that belongs to a service or an action.

    Args:
        name: The name of the type.
        whole: The class of the service or action.

    Raises:
        InterfaceNotFoundError: There is no such part: a service has no goal, for example.
    """
    try:
        return attrgetter(PARTS[name.rpartition("_")[2]])(whole)
    except AttributeError:
        raise InterfaceNotFoundError(name, problem="there is no such part") from None


def get_message(name: str) -> Any:
    """Return the class of a message type; see `get_interface`."""
    return of_kind(name, Message, "a message")


def get_service(name: str) -> Any:
    """Return the class of a service type; see `get_interface`."""
    return of_kind(name, ServiceType, "a service")


def get_action(name: str) -> Any:
    """Return the class of an action type; see `get_interface`."""
    return of_kind(name, ActionType, "an action")


def fitting(cls: object, example: str) -> str:
    """Return, for an error, which class to use in place of one that is not aionode's.

    Classes that rosidl has generated, and those of `aionode.rclpy`, are in modules of their package.

    Args:
        cls: What was given.
        example: The class to name if the module of `cls` says nothing.
    """
    package, _, module = getattr(cls, "__module__", "").partition(".")
    kind = module.partition(".")[0]
    if not isinstance(cls, type) or kind not in KINDS or not PACKAGE_NAME.fullmatch(package):
        return f"use one such as {example}"
    return f"use aionode's own: `from {__name__}.{package}.{kind} import {cls.__name__}`"


def of_kind(name: str, base: type[Any], what: str) -> type[Any]:
    """Return the class of a type that has to be of one kind."""
    found: type[Any] = get_interface(name)
    if not issubclass(found, base):
        raise InterfaceNotFoundError(name, problem=f"not {what}")
    return found


@cache
def shipped_packages() -> frozenset[str]:
    """Return the names of the packages that come with aionode."""
    folder = Path(__file__).parent
    return frozenset(entry.name for entry in folder.iterdir() if (entry / "__init__.py").is_file())


def interface_names(package: str | None = None) -> tuple[str, ...]:
    """Return the ROS names of all types, sorted; those of one package if it is given."""
    packages = known_packages() if package is None else {package}
    return tuple(
        f"{one}/{kind}/{name}"
        for one in sorted(packages)
        for kind in KINDS
        for name in sorted(type_names_of(one, kind))
    )


def known_packages() -> frozenset[str]:
    """Return the names of all packages: shipped, loaded, defined here, in folders, or sourced."""
    names: frozenset[str] = shipped_packages() | loaded_packages()
    names |= {name.split("/")[0] for name in TYPES_BY_NAME}
    names |= import_module("aionode.idl.named").packages()  # by name, since it imports this package
    if is_sourced():
        names |= import_module("aionode.idl._installed").packages()
    return names


def loaded_packages() -> frozenset[str]:
    """Return the names of the packages that `aionode.idl.load_interfaces` has added."""
    prefix = f"{__name__}."
    return frozenset(
        name.removeprefix(prefix)
        for name in sys.modules
        if name.startswith(prefix) and "." not in name.removeprefix(prefix)
    )


def types_of(package: str, kind: str) -> dict[str, type[Any]]:
    """Return the types of one kind in a package, by name; none if there is no such package.

    Those of the program are among them, unless the package has one of the same name.
    """
    if not package.isidentifier() or kind not in KINDS:
        return {}
    imported = {
        name: value
        for name, value in package_members(package, kind).items()
        if getattr(value, "__ros_type__", "") == f"{package}/{kind}/{name}"
    }
    return types_written(package, kind) | imported


def type_of(package: str, kind: str, name: str) -> type[Any] | None:
    """Return the type that `types_of` has under a name, without looking at all the others."""
    if not package.isidentifier() or kind not in KINDS:
        return None
    typename = f"{package}/{kind}/{name}"
    imported: type[Any] | None = package_members(package, kind).get(name)
    if getattr(imported, "__ros_type__", "") == typename:
        return imported
    return TYPES_BY_NAME.get(typename)


def type_names_of(package: str, kind: str) -> set[str]:
    """Return the names of the types of one kind in a package, without creating their classes.

    A generated module lists them in ``__all__``; others are imported.
    """
    module_name = f"{__name__}.{package}.{kind}"
    if module_name not in sys.modules and package in shipped_packages():
        spec = find_spec(module_name)
        if spec is None:
            return set(types_written(package, kind))
        if isinstance(spec.loader, SourceFileLoader):
            listed = re.search(LISTED, spec.loader.get_source(module_name) or "")
            if listed is not None:
                return {*re.findall(r'"(\w+)"', listed[1]), *types_written(package, kind)}
    return set(types_of(package, kind))


def types_written(package: str, kind: str) -> dict[str, type[Any]]:
    """Return the types of one kind in a package that the program itself has defined, by name."""
    prefix = f"{package}/{kind}/"
    return {
        name.removeprefix(prefix): value
        for name, value in list(TYPES_BY_NAME.items())
        if name.startswith(prefix)
    }


def package_members(package: str, kind: str) -> dict[str, Any]:
    """Return the attributes of the module of one kind in a package; empty if there is none."""
    module_name = f"{__name__}.{package}.{kind}"
    try:
        return vars(import_module(module_name))
    except ModuleNotFoundError as error:
        if error.name is not None and module_name.startswith(error.name):
            return {}
        raise


def not_found(name: str, parts: list[str]) -> InterfaceNotFoundError:
    """Return the error for a name that does not exist, with suggestions of similar names."""
    import difflib  # for unknown names only

    packages = known_packages()
    if len(name) > MAX_NAME:
        return InterfaceNotFoundError(name)
    if len(parts) == 1:
        everything = interface_names()
        near = tuple(one for one in everything if one.endswith(f"/{name}"))
        return InterfaceNotFoundError(name, near[:3])
    if parts[0] not in packages:
        close = difflib.get_close_matches(parts[0], packages, 1)
        near = interface_names(close[0]) if close else ()
    else:
        near = interface_names(parts[0])
    wanted = name if len(parts) == 3 else f"{parts[0]}/msg/{parts[-1]}"
    return InterfaceNotFoundError(name, tuple(difflib.get_close_matches(wanted, near, 3, CLOSE)))


# Definitions besides the shipped ones

PACKAGE_NAME = re.compile(r"[a-z][a-z0-9_]*")

FIXED = frozenset(
    {
        "action_msgs",
        "builtin_interfaces",
        "rcl_interfaces",
        "rosgraph_msgs",
        "service_msgs",
        "type_description_interfaces",
        "unique_identifier_msgs",
    }
)
"""Packages that every node needs, whose definitions are the same in all distributions."""

OF_ROS = frozenset(
    {
        "action_msgs",
        "action_tutorials_interfaces",
        "actionlib_msgs",
        "builtin_interfaces",
        "composition_interfaces",
        "diagnostic_msgs",
        "example_interfaces",
        "geometry_msgs",
        "lifecycle_msgs",
        "nav_msgs",
        "rcl_interfaces",
        "rosbag2_interfaces",
        "rosgraph_msgs",
        "sensor_msgs",
        "service_msgs",
        "shape_msgs",
        "statistics_msgs",
        "std_msgs",
        "std_srvs",
        "stereo_msgs",
        "test_msgs",
        "tf2_msgs",
        "trajectory_msgs",
        "turtlesim",
        "type_description_interfaces",
        "unique_identifier_msgs",
        "visualization_msgs",
    }
)
"""Shipped packages that ROS 2 itself releases; of the others, a robot has its own versions."""


def is_sourced() -> bool:
    """Return whether to look for definitions besides the shipped ones."""
    return bool(os.environ.get("AMENT_PREFIX_PATH") or os.environ.get("ROS_DISTRO"))


class DefinitionFinder:
    """Finds ``aionode.interfaces.<package>.<kind>`` where the shipped one does not suffice."""

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None,
        target: ModuleType | None = None,
    ) -> ModuleSpec | None:
        """Return how to import a package, or None if there is only the shipped one."""
        package, _, kind = fullname.removeprefix(f"{__name__}.").partition(".")
        if not fullname.startswith(f"{__name__}.") or package in FIXED:
            return None
        if package not in OF_ROS and (package not in shipped_packages() or has_sources(package)):
            return found_elsewhere(fullname, package, kind)
        if not is_sourced():
            return None
        shipped = PathFinder.find_spec(fullname, path, target)
        # By name, since `aionode.idl` imports this package.
        installed = import_module("aionode.idl._installed")
        if kind not in KINDS or not installed.has_types(package, kind):
            return shipped
        loader = None if shipped is None else shipped.loader
        return ModuleSpec(fullname, InstalledTypes(installed, package, kind, loader))


def has_sources(package: str) -> bool:
    """Return whether a named folder or the workspace defines a package."""
    from aionode._packages import here  # for the few packages that may be in a workspace

    module = "aionode.idl.named"  # by name, since it imports this package; and it loads parsers
    is_named = module in sys.modules or os.environ.get("AIONODE_INTERFACES")
    if not is_named and package not in here().sources():
        return False
    has: bool = import_module(module).has_sources(package)
    return has


def found_elsewhere(fullname: str, package: str, kind: str) -> ModuleSpec | None:
    """Return how to import a package that is not shipped, or its types of one kind.

    Named folders come first, then the sourced ROS 2, then the workspace.

    Raises:
        ModuleNotFoundError: No package of that name has definitions.
    """
    if not PACKAGE_NAME.fullmatch(package) or (kind and kind not in KINDS):
        return None
    folders = import_module("aionode.idl.named")  # by name, since it imports this package
    spec: ModuleSpec | None = folders.found(fullname, package, kind)
    if spec is not None:
        return spec
    installed = import_module("aionode.idl._installed")
    if is_sourced() and installed.has_package(package):
        if not kind:
            return ModuleSpec(fullname, InstalledPackage(), is_package=True)
        if installed.has_types(package, kind):
            return ModuleSpec(fullname, InstalledTypes(installed, package, kind, None))
    if folders.add_workspace(package):
        spec = folders.found(fullname, package, kind)
    if spec is None and not kind:
        error: ModuleNotFoundError = folders.not_found(fullname, package)
        raise error
    return spec


class InstalledPackage(Loader):
    """An empty package, for modules of installed types."""

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:  # noqa: ARG002  # the protocol
        """Leave the creation to the import system."""
        return None

    def exec_module(self, module: ModuleType) -> None:
        """Leave the package empty."""


class InstalledTypes(InstalledPackage):
    """Executes the shipped module, if there is one, and adds the installed types that differ."""

    def __init__(self, installed: Any, package: str, kind: str, shipped: Loader | None) -> None:
        self._installed = installed
        self._package = package
        self._kind = kind
        self._shipped = shipped

    def exec_module(self, module: ModuleType) -> None:
        """Define the types in `module`."""
        if self._shipped is not None:
            self._shipped.exec_module(module)
        found = self._installed.replaced_types(self._package, self._kind, vars(module))
        vars(module).update(found)
        names = {*getattr(module, "__all__", ()), *found}
        module.__all__ = sorted(names)  # type: ignore[attr-defined]  # as in a written module


sys.meta_path.insert(0, DefinitionFinder())
