"""Lazy import of a package's public names, as few programs need all of them."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

__all__ = ["imported_on_first_use"]


def imported_on_first_use(
    package: str, places: Mapping[str, str], extra: str = "all"
) -> Callable[[str], Any]:
    """Create the ``__getattr__`` of a package, which imports a public name and caches it.

    It raises AttributeError for an unknown name, and a ModuleNotFoundError that says what to
    install if a library is missing.

    Args:
        package: The name of the package.
        places: The module of each public name, within the package.
        extra: The extra of aionode that installs what these modules need, if they need anything.
    """

    def find(name: str) -> Any:
        if name not in places:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        try:
            value = getattr(import_module(f"{package}.{places[name]}"), name)
        except ModuleNotFoundError as error:
            if (error.name or "").startswith("aionode"):
                raise
            missing = (error.name or "a module").partition(".")[0]
            raise ModuleNotFoundError(
                f"{package}: {missing} is not installed; pip install 'aionode[{extra}]'",
                name=error.name,
            ) from error
        setattr(sys.modules[package], name, value)
        return value

    return find
