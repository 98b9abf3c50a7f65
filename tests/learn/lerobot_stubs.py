"""Compares the stubs of LeRobot that CI has with the LeRobot that is installed: ``make lerobot``.

Run with the Python of an environment that has LeRobot. Whatever the stubs have must be in LeRobot
with the same parameters, and whatever LeRobot leaves to its plugins must be in the stubs.
"""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import json
import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

__all__ = ["described", "differences"]

NAMES = {
    "lerobot.robots": ("Robot", "RobotConfig", "make_robot_from_config"),
    "lerobot.teleoperators": (
        "Teleoperator",
        "TeleoperatorConfig",
        "make_teleoperator_from_config",
    ),
    "lerobot.utils.errors": ("DeviceAlreadyConnectedError", "DeviceNotConnectedError"),
}
"""The modules that a plugin imports, or that create it."""

SPECIAL = ("__del__", "__enter__", "__exit__", "__init__", "__str__")


def described() -> dict[str, Any]:
    """Return what there is of LeRobot in this process, as JSON has it."""
    return {
        f"{module}.{name}": of_object(getattr(importlib.import_module(module), name, None))
        for module, names in NAMES.items()
        for name in names
    }


def of_object(found: Any) -> Any:
    """Return what a class or a function is like; None if it is not there."""
    if not inspect.isclass(found):
        return found and {"parameters": parameters(found)}
    members = {}
    for cls in reversed([each for each in found.__mro__ if not is_built_in(each)]):
        for name, value in vars(cls).items():
            if not name.startswith("_") or name in SPECIAL:
                members[name] = of_member(value)
    bases = [cls.__name__ for cls in found.__mro__ if is_built_in(cls)]
    return {
        "bases": bases,
        "members": {name: member for name, member in members.items() if member},
        "fields": {
            field.name: {"keyword": field.kw_only, "needed": is_needed(field)}
            for field in (dataclasses.fields(found) if dataclasses.is_dataclass(found) else ())
        },
    }


def of_member(value: Any) -> Any:
    """Return what a method or a property is like; None for another attribute."""
    is_abstract = getattr(value, "__isabstractmethod__", False)
    if isinstance(value, property):
        return {"property": True, "abstract": is_abstract}
    function = value.__func__ if isinstance(value, classmethod) else value
    if not inspect.isfunction(function):
        return None
    return {"parameters": parameters(function), "abstract": is_abstract}


def parameters(function: Any) -> dict[str, Any]:
    """Return the parameters of a function: each with its kind, and whether it has a default."""
    return {
        name: [each.kind.name, each.default is not inspect.Parameter.empty]
        for name, each in inspect.signature(function).parameters.items()
    }


def is_built_in(cls: type) -> bool:
    """Return whether a class is Python's."""
    return cls.__module__ in {"builtins", "abc", "typing"}


def is_needed(field: dataclasses.Field[Any]) -> bool:
    """Return whether a field has no default."""
    return field.default is field.default_factory is dataclasses.MISSING


def differences(stubs: dict[str, Any], real: dict[str, Any]) -> list[str]:
    """Return where stubs say something else than LeRobot."""
    found = []
    for name, stub in stubs.items():
        there = real[name]
        if there is None or stub is None:
            found.append(f"{name}: not in {'LeRobot' if there is None else 'the stubs'}")
        elif "members" not in stub or "members" not in there:
            found += of_call(name, stub, there)
        else:
            found += of_class(name, stub, there)
    return found


def of_class(name: str, stub: dict[str, Any], there: dict[str, Any]) -> list[str]:
    """Return where a class of the stubs differs."""
    found = []
    for kind in ("members", "fields"):
        mine, theirs = stub[kind], there[kind]
        wanted = {key for key, each in theirs.items() if each.get("abstract") or each.get("needed")}
        found += [f"{name}.{key}: not in LeRobot" for key in sorted(set(mine) - set(theirs))]
        found += [f"{name}.{key}: not in the stubs" for key in sorted(wanted - set(mine))]
        for key in sorted(set(mine) & set(theirs)):
            found += of_call(f"{name}.{key}", mine[key], theirs[key])
    found += [f"{name}: no {base}" for base in stub["bases"] if base not in there["bases"]]
    return found


def of_call(name: str, stub: dict[str, Any], there: dict[str, Any]) -> list[str]:
    """Return where a function differs: LeRobot's may have more parameters that have defaults."""
    if {**stub, "parameters": 0} != {**there, "parameters": 0}:
        return [f"{name}: {stub}, but {there} in LeRobot"]
    mine, theirs = stub.get("parameters", {}), there.get("parameters", {})
    shared = {key: each for key, each in theirs.items() if key in mine or not each[1]}
    return [] if list(mine.items()) == list(shared.items()) else [f"{name}: {mine}, not {theirs}"]


def main() -> int:
    """Compare both, and print what differs; the result is the exit status."""
    if sys.argv[1:] == ["--describe"]:
        print(json.dumps(described()))  # noqa: T201
        return 0
    stubs = Path(__file__).with_name("stubs")
    told = subprocess.run(
        [sys.executable, __file__, "--describe"],
        env=os.environ | {"PYTHONPATH": str(stubs)},
        capture_output=True,
        check=True,
        text=True,
    )
    of_stubs = json.loads(told.stdout)
    found = differences(of_stubs, json.loads(json.dumps(described())))
    members = sum(len(each.get("members", "1")) for each in of_stubs.values())
    print(  # noqa: T201
        "\n".join(found)
        or f"the stubs agree with LeRobot {version('lerobot')}: {len(of_stubs)} names, "
        f"{members} methods and properties"
    )
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
