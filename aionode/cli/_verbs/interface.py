"""The verbs of ``aionode interface``."""

from __future__ import annotations

from typing import Any, Literal

from aionode.cli._support.output import Output

__all__ = ["KINDS", "list_interfaces", "package", "packages", "proto", "show"]

KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}

# Verbs


def list_interfaces(*, output: Output, kinds: tuple[str, ...] = tuple(KINDS)) -> None:
    """Print the names of all types."""
    from aionode.interfaces import interface_names

    names = interface_names()
    for kind in kinds:
        output.text(f"{KINDS[kind]}:")
        for name in of_kinds(names, (kind,)):
            output.item(f"    {name}", {"name": name, "kind": kind})


def package(package_name: str, *, output: Output, kinds: tuple[str, ...] = tuple(KINDS)) -> None:
    """Print the names of the types in one package."""
    from aionode.interfaces import interface_names

    names = interface_names(package_name)
    if not names:
        from aionode.cli._support.lookup import unknown

        raise unknown("Unknown package", package_name, all_packages(), "interface packages")
    for name in of_kinds(names, kinds):
        output.item(name, {"name": name, "kind": name.split("/")[1]})


def packages(*, output: Output, kinds: tuple[str, ...] = tuple(KINDS)) -> None:
    """Print the names of the packages with types of these kinds."""
    from aionode.interfaces import interface_names

    for name in all_packages():
        if of_kinds(interface_names(name), kinds):
            output.item(name, {"name": name})


def all_packages() -> list[str]:
    """Return the names of all packages."""
    from aionode.interfaces import known_packages

    return sorted(known_packages())


def of_kinds(names: tuple[str, ...], kinds: tuple[str, ...]) -> list[str]:
    """Return the names of types of some kinds."""
    return [name for name in names if name.split("/")[1] in kinds]


def show(
    cls: Any,
    *,
    output: Output,
    comments: Literal["none", "outer", "all"] = "outer",
) -> None:
    """Print the definition of a type, with the definitions of nested types indented.

    Args:
        cls: The class of the type.
        output: Where to print.
        comments: Whether to print what fields mean: never, for the type itself, or for nested ones
            as well. The comments are those of the sourced ROS 2, or else aionode's own.
    """
    from aionode.idl import definition_text

    if output.json:
        output.item("", {"name": cls.__ros_type__, "definition": definition_text(cls)})
    else:
        output.raw(definition_text(cls, nested=True, comments=comments))


def proto(cls: Any, *, output: Output, quotes: bool = True) -> None:
    """Print the default values of a type in YAML, as a template for ``pub`` and ``call``."""
    from aionode.message import ActionType, ServiceType, to_builtins, to_yaml

    part = cls.Goal if issubclass(cls, ActionType) else cls
    part = cls.Request if issubclass(cls, ServiceType) else part
    text = to_yaml(part())
    output.item(f'"{text}"' if quotes else text, to_builtins(part()))
