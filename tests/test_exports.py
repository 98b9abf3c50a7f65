"""Which names are public, that each is documented, and what importing them costs."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import aionode
from aionode import errors

if TYPE_CHECKING:
    from types import ModuleType

MODULES = sorted(
    module.name
    for module in pkgutil.walk_packages(aionode.__path__, "aionode.")
    if not module.name.startswith("aionode.interfaces.") and not module.name.endswith(".__main__")
)
PUBLIC = [name for name in MODULES if "._" not in name]
REFERENCE = Path(__file__).parent.parent / "docs/reference"
PROMISED = [
    "ActionClient",
    "ActionServer",
    "Client",
    "Clock",
    "Context",
    "Duration",
    "DurabilityPolicy",
    "HistoryPolicy",
    "LivelinessPolicy",
    "Node",
    "Parameter",
    "Publisher",
    "QoSProfile",
    "Rate",
    "ReliabilityPolicy",
    "Service",
    "Subscription",
    "Time",
    "Timer",
    "run",
]
PRESETS = [
    "qos_profile_action_status_default",
    "qos_profile_best_available",
    "qos_profile_default",
    "qos_profile_parameter_events",
    "qos_profile_parameters",
    "qos_profile_rosout_default",
    "qos_profile_sensor_data",
    "qos_profile_services_default",
    "qos_profile_system_default",
]
WITHIN = {
    "aionode.endpoints.client": {"Exchange"},  # what a client is made with
    "aionode.endpoints.publisher": {"make_lease"},  # for managed nodes
    # for tf's filters, and managed nodes
    "aionode.endpoints.subscription": {"reader_of", "silence_watch_of", "take_from"},
    "aionode.endpoints.timer": {"to_period_ns"},  # for nodes
    "aionode.node": {"direct_subscription", "parts_subscription"},  # for recorders and gateways
    "aionode.transport.link": {"Advertisement", "available", "can_link"},  # for Zenoh and contexts
}
"""Names that only aionode itself uses, although their module is public."""
FAMILIES = {"AionodeError", "ParameterException"}  # bases: caught, never raised


def test_aionode_has_the_promised_names() -> None:
    """Programs import these from aionode itself."""
    assert set(PROMISED) <= set(aionode.__all__)
    assert [name for name in PROMISED if not hasattr(aionode, name)] == []


def test_qos_has_the_presets_of_rclpy() -> None:
    """Programs import these from aionode.qos, as they do from rclpy.qos."""
    for name in PRESETS:
        assert isinstance(getattr(aionode.qos, name), aionode.QoSProfile), name


@pytest.mark.filterwarnings("ignore:importing 'qos_event' is deprecated:UserWarning")
def test_a_module_says_what_it_exports() -> None:
    """`__all__` is there, without duplicates, and every name in it exists."""
    for name in MODULES:
        module = importlib.import_module(name)
        exported = list(exported_by(module))

        assert len(exported) == len(set(exported)), name
        assert [each for each in exported if not hasattr(module, each)] == [], name


@pytest.mark.filterwarnings("ignore:importing 'qos_event' is deprecated:UserWarning")
def test_what_is_public_is_documented() -> None:
    """Every public class, function and method has a docstring."""
    for name in ["aionode", *MODULES]:
        assert list(undocumented(importlib.import_module(name))) == [], name


# The modules of aionode.rclpy have rclpy's names, and rclpy's documentation describes them.
# What users may rely on of the engine has names above it; of rooms that end in a dot here, in their
# package, and their modules without an underscore are for other rooms of aionode.
ELSEWHERE = (
    "aionode.bag.",
    "aionode.cli",
    "aionode.clock.",
    "aionode.endpoints.actions.",
    "aionode.endpoints.core",
    "aionode.engine",
    "aionode.examples",
    "aionode.gateway.",
    "aionode.idl.",
    "aionode.launch.",
    "aionode.learn.",
    "aionode.message.",
    "aionode.parameter.",
    "aionode.rclpy",
    "aionode.system.",
    "aionode.tf.",
)


def test_what_is_public_has_a_place_in_the_reference() -> None:
    """Names that users may rely on are on a page; the others are in private modules."""
    pages = "\n".join(page.read_text(encoding="utf-8") for page in REFERENCE.glob("*.md"))
    modules = set(re.findall(r"automodule:: (\S+)\n(?!\s+:no-members:)", pages))
    names = {path.split(".")[-1] for path in re.findall(r"auto\w+:: ([\w.]+)", pages)}
    unlisted = {
        f"{module}.{name}"
        for module in set(PUBLIC) - modules
        if not module.startswith(ELSEWHERE)
        for name in exported_by(importlib.import_module(module))
        if name not in names | set(errors.__all__) | WITHIN.get(module, set())
    }

    assert unlisted == set()


def exported_by(module: ModuleType) -> list[str]:
    """Return `__all__`; a package that is only a folder of modules needs none."""
    if hasattr(module, "__path__"):
        return getattr(module, "__all__", [])
    exported: list[str] = module.__all__
    return exported


def undocumented(module: ModuleType) -> list[str]:
    """Return the public names of a module that have no docstring."""
    silent = [] if module.__doc__ else [module.__name__]
    for name in exported_by(module):
        member = getattr(module, name)
        is_ours = (getattr(member, "__module__", None) or "").startswith("aionode")
        if is_ours and (inspect.isroutine(member) or inspect.isclass(member)):
            silent += [] if inspect.getdoc(member) else [name]
        if is_ours and inspect.isclass(member):
            silent += [f"{name}.{each}" for each in silent_methods(member)]
    return silent


def silent_methods(owner: type) -> list[str]:
    """Return the public methods and properties of a class without a docstring."""
    return [
        name
        for name, member in vars(owner).items()
        if name[0].islower()  # not of a protocol that describes nested classes as functions
        and (
            inspect.isfunction(member) or isinstance(member, property | classmethod | staticmethod)
        )
        and not inspect.getdoc(getattr(owner, name))
    ]


def test_an_error_is_ours_and_a_builtin() -> None:
    """Both `except AionodeError` and `except ValueError` work."""
    for name in set(errors.__all__) - FAMILIES:
        error = getattr(errors, name)
        builtins = [base for base in error.__mro__ if base.__module__ == "builtins"]

        assert issubclass(error, errors.AionodeError), name
        assert builtins[0] is not Exception, name


def test_importing_aionode_leaves_out_what_is_large() -> None:
    """`import aionode` is quick: large packages are imported when they are used."""
    code = (
        "import aionode, sys; print({'numpy', 'zenoh', 'click', 'rich', 'yaml'} & {*sys.modules})"
    )

    assert subprocess.check_output([sys.executable, "-c", code], text=True) == "set()\n"
