"""Lets programs import `rclpy`, message packages and ROS's small Python packages from aionode."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from importlib.util import find_spec, spec_from_loader
from pathlib import Path
from types import ModuleType
from typing import Any, Final

from aionode._process.imports import uncollected
from aionode.idl.search import add_folder, has_interfaces, module_name, names_in
from aionode.interfaces import shipped_packages

__all__ = ["SUPPLIED", "install", "provide"]

FOLDER: Final = Path(__file__).parents[1] / "ros_packages"
"""The folder with the Python packages of ROS that aionode provides."""
SUPPLIED: Final = frozenset(path.name for path in FOLDER.iterdir() if path.name != "__pycache__")
"""Their names."""
YIELDING: Final = (
    "controller_manager",
    "generate_parameter_library_py",
    "interactive_markers",
    "launch_param_builder",
    "moveit_configs_utils",
    "nav2_common",
    "nav2_simple_commander",
    "py_trees_ros",
    "ros2action",
    "ros2cli",
    "ros2lifecycle",
    "ros2node",
    "ros2param",
    "ros2pkg",
    "ros2run",
    "ros2service",
    "ros2topic",
    "turtlebot4_navigation",
)
"""The packages that yield to one with the same name in the workspace or installed."""
A_MODULE_FOR_EACH_CLASS: Final = ("launch", "launch_ros", "nav2_common")
"""The packages that have one module per class in ROS, but fewer here."""

FOR_SEVERAL: Final = frozenset(
    {
        "any_launch_file_utilities",
        "boolean_substitution",
        "frontend_launch_file_utilities",
        "process_matchers",
        "python_launch_file_utilities",
    }
)
"""The modules of these packages that have several classes or functions in ROS, too."""

SHARED_ELSEWHERE: Final = {
    "InvalidQoSProfileException": "rclpy.qos",
    "InvalidQosOverridesError": "rclpy.qos_overriding_options",
}
"""The exceptions of `aionode.errors` that rclpy has outside of ``rclpy.exceptions``."""

KINDS: Final = ("msg", "srv", "action")


def install(
    *,
    interfaces: Iterable[str | Path] = (),
    workspace: str | Path | None = None,
    prefer_ros: bool = False,
) -> None:
    """Make `import rclpy` and `from std_msgs.msg import String` mean aionode's, in this process.

    Message packages come from aionode, from the given folders, and from AMENT_PREFIX_PATH. If ROS
    2's rclpy is installed as well, the log says which of the two is used. A second call only adds
    folders.

    Args:
        interfaces: Folders with message packages (``my_msgs/msg/Words.msg``), which need no build.
        workspace: The folder with the program's packages, which need no build either; by default
            the workspace around the program.
        prefer_ros: If ROS 2's rclpy is installed, use ROS 2's packages and change nothing.

    Raises:
        ImportError: Another rclpy has been imported already.
        FileNotFoundError: There is no such folder.
    """
    loaded = sys.modules.get("rclpy")
    if loaded is not None and not (loaded.__spec__ and is_own(loaded.__spec__)):
        raise ImportError(
            f"aionode.rclpy.install: the rclpy of {loaded.__file__} is imported already; "
            "call install() before the first import of rclpy",
            name="rclpy",
        )
    if FINDER not in sys.meta_path:
        ros = rclpy_of_ros()
        if ros is not None:
            from aionode.logging import get_logger  # only if there is something to log

            which = f"ROS ({ros})" if prefer_ros else f"aionode, not that of ROS ({ros})"
            get_logger("aionode.rclpy").info(f"using the rclpy of {which}")
            if prefer_ros:
                return
        sys.meta_path[:] = [FINDER, *sys.meta_path, PARAMETER_FINDER]
    for folder in interfaces:
        add_folder(folder)
    if workspace is not None:
        from aionode._packages import use  # it searches for packages

        use(workspace)


def rclpy_of_ros() -> Path | None:
    """Return the folder of an installed rclpy that is not aionode's, if any."""
    spec = PathFinder.find_spec("rclpy")
    if spec is None or spec.origin is None:
        return None
    return None if is_own(spec) else Path(spec.origin).parent


def is_own(spec: ModuleSpec) -> bool:
    """Return whether a package is aionode's or the distribution ``aionode-rclpy``'s."""
    read = getattr(spec.loader, "get_data", None)  # works for a wheel on the path, too
    return read is not None and b"aionode" in read(spec.origin)[:300]


def provide(name: str) -> None:
    """Replace a module that is being imported by aionode's module of that name.

    The message packages of the distribution ``aionode-rclpy`` consist of just this call.
    """
    if FINDER not in sys.meta_path:
        sys.meta_path[:] = [FINDER, *sys.meta_path, PARAMETER_FINDER]
        shared_errors_take_names()
    del sys.modules[name]
    import_module(name)


def shared_errors_take_names() -> None:
    """Give exceptions shared with rclpy the module names that they have there.

    For processes that run an rclpy program; elsewhere they are in `aionode.errors`.
    """
    from aionode import errors

    exceptions = import_module("rclpy.exceptions")
    shared = {**dict.fromkeys(exceptions.__all__, "rclpy.exceptions"), **SHARED_ELSEWHERE}
    for name, shown in shared.items():
        error = getattr(errors, name, None)
        if error is not None:
            error.__module__ = shown


class AionodeFinder(MetaPathFinder):
    """Finds the modules that aionode provides in place of ROS's."""

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None,
        target: ModuleType | None = None,  # noqa: ARG002  # the protocol of finders
    ) -> ModuleSpec | None:
        """Return the spec of a module; None if it is not one of these."""
        package, _, inside = fullname.partition(".")
        if package in SUPPLIED and not gives_way(package):
            return of_supplied(fullname, path)
        kind, _, module = inside.partition(".")
        if package == "aionode" or package in sys.stdlib_module_names or kind not in ("", *KINDS):
            return None
        if not inside:
            return of_package(package)
        if not has_interfaces(package, kind):
            return None
        if not module:
            return spec_from_loader(fullname, KindLoader(package, kind), is_package=True)
        for name in names_in(package):
            if module_name(*name.split("/")) == fullname:
                return spec_from_loader(fullname, InterfaceLoader(name))
        return None


class ParameterModuleFinder(MetaPathFinder):
    """Finds the modules that a build would generate of the parameters of a workspace's package.

    It is the last finder, so that what was built comes first.
    """

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None,  # noqa: ARG002  # the protocol of finders
        target: ModuleType | None = None,  # noqa: ARG002  # the protocol of finders
    ) -> ModuleSpec | None:
        """Return the spec of a module, or of its package; None if it is not one of these."""
        package, _, name = fullname.partition(".")
        if package in sys.stdlib_module_names:
            return None
        from aionode._packages import here, parameter_modules  # only for what is not found

        folder = here().sources().get(package)
        modules = {} if folder is None else parameter_modules(folder, package)
        if name in modules:
            return spec_from_loader(fullname, ParameterLoader(modules[name]))
        if name or not modules or folder is None:
            return None
        spec = spec_from_loader(fullname, EmptyLoader(), is_package=True)
        if spec is not None and spec.submodule_search_locations is not None:
            spec.submodule_search_locations.append(str(folder / package))  # without __init__.py
        return spec


class ParameterLoader(Loader):
    """Loads a module that generate_parameter_library would generate."""

    def __init__(self, definition: Any) -> None:
        self.definition = definition

    def exec_module(self, module: ModuleType) -> None:
        """Put the class of its parameters into the module."""
        from generate_parameter_library_py.parameters import classes_of

        vars(module).update(classes_of(self.definition.file, self.definition.validators))


def gives_way(package: str) -> bool:
    """Return whether a workspace or installed package takes precedence over aionode's."""
    if package not in YIELDING:
        return False
    spec = PathFinder.find_spec(package)
    if spec is not None and spec.origin is not None and not is_own(spec):
        return True
    from aionode._packages import here

    return here().module_root(package) is not None


class UncollectedLoader(SourceFileLoader):
    """Loads a module, and what that imports, without looking for garbage meanwhile."""

    def exec_module(self, module: ModuleType) -> None:
        """Run the module's code."""
        with uncollected():
            super().exec_module(module)


def of_supplied(fullname: str, path: Sequence[str] | None) -> ModuleSpec | None:
    """Return the spec of a module of a package in `FOLDER`."""
    spec = PathFinder.find_spec(fullname, [str(FOLDER)] if path is None else path)
    if spec is not None and type(spec.loader) is SourceFileLoader:
        spec.loader = UncollectedLoader(spec.loader.name, spec.loader.path)
    if spec is None and fullname.partition(".")[0] in A_MODULE_FOR_EACH_CLASS:
        return of_one_name(fullname)
    return spec


def of_package(package: str) -> ModuleSpec | None:
    """Return the spec of a package that has messages or is in the workspace.

    Python modules come first, installed ones or those on PYTHONPATH before the workspace's, as a
    package may have them beside its messages. A folder without Python does not count as a package:
    in a workspace, the folder around a Python package often has the same name.
    """
    if package not in shipped_packages():
        ordinary = PathFinder.find_spec(package)
        if ordinary is not None and ordinary.origin is not None:
            return None
        from aionode._packages import here  # only for packages not found otherwise

        root = here().module_root(package)
        if root is not None:
            return PathFinder.find_spec(package, [str(root)])
    is_found = has_interfaces(package)
    return spec_from_loader(package, EmptyLoader(), is_package=True) if is_found else None


def of_one_name(fullname: str) -> ModuleSpec | None:
    """Return the spec of a module such as ``launch.actions.execute_process``.

    ROS's launch has one module per class, from which programs may import.
    """
    parent, _, last = fullname.rpartition(".")
    if not exists(parent):
        return None
    package = import_module(parent)
    names = {name.replace("_", "").lower() for name in package.__all__}  # SetROSLogDir, set_ros_…
    named = (last, last.removesuffix("_action"), last.removesuffix("_impl"))
    if last not in FOR_SEVERAL and names.isdisjoint(name.replace("_", "") for name in named):
        return None
    return spec_from_loader(fullname, NamesLoader(package))


def exists(module: str) -> bool:
    """Return whether there is a module of this name."""
    try:
        return find_spec(module) is not None
    except ModuleNotFoundError:
        return False


class NamesLoader(Loader):
    """Loads a module with the names of its package."""

    def __init__(self, package: ModuleType) -> None:
        self.package = package

    def exec_module(self, module: ModuleType) -> None:
        """Give the module the names."""
        vars(module).update({name: getattr(self.package, name) for name in self.package.__all__})


class EmptyLoader(Loader):
    """Loads a package that has only modules."""

    def exec_module(self, module: ModuleType) -> None:
        """Make the package's modules importable on access, which a program need not import itself.

        In ROS they exist as soon as any message needs them, which programs rely on.
        """

        def find(kind: str) -> ModuleType:
            if kind not in KINDS or not has_interfaces(module.__name__, kind):
                raise AttributeError(f"module {module.__name__!r} has no attribute {kind!r}")
            return import_module(f"{module.__name__}.{kind}")

        vars(module).update(__getattr__=find)


class KindLoader(Loader):
    """Loads a module such as ``std_msgs.msg``, whose classes are created on access."""

    def __init__(self, package: str, kind: str) -> None:
        self.package = package
        self.kind = kind

    def exec_module(self, module: ModuleType) -> None:
        """Set the module's hook that finds its classes."""
        from rosidl_generator_py import classes_of  # which this finder finds

        package, kind = self.package, self.kind

        def names() -> list[str]:
            return [name for name in names_in(package) if name.split("/")[1] == kind]

        def parts() -> set[str]:
            return {part for name in names() for part in classes_of(name)}

        def find(name: str) -> Any:
            if name == "__all__":
                return sorted(parts())
            whole = f"{package}/{kind}/{name.partition('_')[0]}"
            classes = classes_of(whole) if whole in names() else {}
            if name not in classes:
                raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
            vars(module).update(classes)
            return classes[name]

        def listed() -> list[str]:
            return sorted(parts().union(vars(module)))

        vars(module).update(__getattr__=find, __dir__=listed)


class InterfaceLoader(Loader):
    """Loads a module such as ``std_msgs.msg._string``."""

    def __init__(self, name: str) -> None:
        self.name = name

    def exec_module(self, module: ModuleType) -> None:
        """Put the classes and their metaclasses into the module."""
        from rosidl_generator_py import classes_of

        for name, cls in classes_of(self.name).items():
            vars(module)[name] = cls
            vars(module)[type(cls).__name__] = type(cls)


FINDER: Final = AionodeFinder()
PARAMETER_FINDER: Final = ParameterModuleFinder()
