"""Stand-ins for missing Python modules; actions that launch files create from them are skipped."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any, Final, NoReturn, TypeVar

from aionode._packages import stand_in
from aionode.errors import PackageNotFoundError
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity

__all__ = ["StandIn", "forget_stand_ins", "missing_module", "with_stand_ins"]

T = TypeVar("T")

MAX_MODULES: Final = 50
"""Number of modules of one process that may have stand-ins."""


class StandIn(LaunchDescriptionEntity):
    """An object that a launch file takes from a missing module, or creates with it.

    It has every attribute and can be called, and is not a number, list or text; as text it is a
    path that does not exist, so that code that cannot do without it names the missing module.
    """

    def __init__(self, name: str) -> None:
        self.__name = name
        frame = sys._getframe(1)  # where the launch file imported it
        while frame.f_back is not None and frame.f_code.co_filename == __file__:
            frame = frame.f_back
        self._LaunchDescriptionEntity__where = f"{frame.f_code.co_filename}:{frame.f_lineno}"

    def visit(self, context: LaunchContext) -> NoReturn:  # noqa: ARG002  # as of other entities
        """Refuse to be executed.

        Raises:
            PackageNotFoundError: Always.
        """
        raise PackageNotFoundError(package_of(self.__name), (), ())

    def describe(self) -> str:
        """Return the name that the launch file used."""
        return self.__name

    def __getattr__(self, name: str) -> StandIn:
        if name.startswith("__") and name.endswith("__"):
            raise AttributeError(name)  # a protocol that it does not implement
        return StandIn(f"{self.__name}.{name}")

    def __call__(self, *_: Any, **__: Any) -> StandIn:
        return StandIn(f"{self.__name}()".replace("()()", "()"))

    def __getitem__(self, key: Any) -> StandIn:
        return self

    def __iter__(self) -> Iterator[StandIn]:
        return iter(())

    def __mro_entries__(self, bases: tuple[Any, ...]) -> tuple[type, ...]:
        name = self.__name

        class Base(StandIn):
            def __init__(self, *_: Any, **__: Any) -> None:
                super().__init__(name)

        return (Base,)

    def __repr__(self) -> str:
        return f"{stand_in(package_of(self.__name))}/{self.__name}"

    __str__ = __fspath__ = __repr__

    def __add__(self, other: Any) -> str:
        return f"{self}{other}"

    def __radd__(self, other: Any) -> str:
        return f"{other}{self}"


class StandInModule(ModuleType):
    """A module that has every name."""

    def __getattr__(self, name: str) -> StandIn:
        if name.startswith("__") and name.endswith("__"):
            raise AttributeError(name)
        return StandIn(f"{self.__name__}.{name}")


class StandInFinder(MetaPathFinder, Loader):
    """Finds modules that are otherwise missing, and that were requested."""

    def __init__(self) -> None:
        self.packages: set[str] = set()

    def find_spec(self, fullname: str, *_: Any) -> ModuleSpec | None:
        """Return the spec of a stand-in; None for any other module."""
        if package_of(fullname) not in self.packages:
            return None
        return ModuleSpec(fullname, self, is_package=True)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return a stand-in."""
        return StandInModule(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing: the module already has every name."""


FINDER: Final = StandInFinder()


def forget_stand_ins() -> None:
    """Make the modules with stand-ins missing again."""
    FINDER.packages.clear()
    for name in [name for name, module in sys.modules.items() if isinstance(module, StandInModule)]:
        del sys.modules[name]


def package_of(name: str) -> str:
    """Return the first part of the name of a module, or of an object in it."""
    return name.partition(".")[0]


def missing_module(error: BaseException) -> str | None:
    """Return the package whose module was not found, if it may have a stand-in.

    A missing module of a package that exists is a mistake.
    """
    if not isinstance(error, ModuleNotFoundError) or error.name is None:
        return None
    package = package_of(error.name)
    return None if package in sys.modules or package in sys.stdlib_module_names else package


def with_stand_ins(run: Callable[[], T]) -> T:
    """Return the result of a function; a module that it does not find gets a stand-in, if wanted.

    The function is then called again, since it might have been able to do without the module.
    """
    while True:
        try:
            return run()
        except ModuleNotFoundError as error:
            package = missing_module(error)
            is_wanted = package is not None and stand_in(package) is not None
            if not is_wanted or len(FINDER.packages) >= MAX_MODULES or package in FINDER.packages:
                raise
            assert package is not None  # noqa: S101  # as it is wanted
            FINDER.packages.add(package)
            if FINDER not in sys.meta_path:
                sys.meta_path.append(FINDER)
