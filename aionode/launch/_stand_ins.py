"""Stand-ins for missing Python modules; actions that launch files create from them are skipped."""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any, Final, TypeVar

from aionode._packages import stand_in
from launch.stand_in import StandIn, package_of

__all__ = ["forget_stand_ins", "missing_module", "with_stand_ins"]

T = TypeVar("T")

MAX_MODULES: Final = 50
"""Number of modules of one process that may have stand-ins."""


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
            assert package is not None  # noqa: S101  # it is wanted
            FINDER.packages.add(package)
            if FINDER not in sys.meta_path:
                sys.meta_path.append(FINDER)
