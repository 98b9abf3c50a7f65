"""Every public name in a module or class of rclpy 9.1.2 exists here, except those listed.

``names.json`` has the names; `list_names.py` prints them, and ``imports.txt`` has those that its
modules import only for themselves. With the path of an interpreter that has
rclpy in ``RCLPY_PYTHON`` it is asked again, as in test_differential.py.
"""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rosidl_generator_py import message_class

HERE = Path(__file__).parent
EXPECTED: dict[str, dict[str, list[str]]] = json.loads(
    (HERE / "names.json").read_text(encoding="utf-8")
)
INTERPRETER = "RCLPY_PYTHON"

FILTERS = "filters of log lines are inside of aionode.logging, which log() calls"
ANNOTATIONS = """
rclpy.action.client.ClientGoalHandleDict
rclpy.action.client.SendGoalKWargs
rclpy.action.client.SendGoalServiceResponse
rclpy.action.server.GetResultServiceRequest
rclpy.action.server.SendGoalServiceRequest
rclpy.action.server.ServerGoalHandleDict
rclpy.clock.JumpHandlePreCallbackType
rclpy.clock.TimeJumpDictionary
rclpy.event_handler.EventHandlerData
rclpy.executors.YieldedCallback
rclpy.lifecycle.node.CallbackNames
rclpy.lifecycle.node.CreateLifecyclePublisherArgs
rclpy.lifecycle.node.LifecycleNodeArgs
rclpy.qos_event.EventHandlerData
rclpy.qos_overriding_options.QoSProfileAttributes
rclpy.qos_overriding_options.QosCallbackType
rclpy.topic_endpoint_info.TypeHashDictionary
rclpy.type_hash.TypeHashDictionary
rclpy.type_support.CommonMsgSrvMetaClass
rclpy.type_support.EventMessage
rclpy.type_support.GetResultService
rclpy.type_support.GetResultServiceRequest
rclpy.type_support.MsgMetaClass
rclpy.type_support.ProtocolType
rclpy.type_support.PyCapsule
rclpy.type_support.SendGoalService
rclpy.type_support.SendGoalServiceRequest
rclpy.type_support.SendGoalServiceResponse
"""
"""Names for annotations that no public program was seen to import."""


def imports() -> Iterator[str]:
    """Yield the names that modules of rclpy only import, and no program was seen to take there."""
    module = ""
    for word in (HERE / "imports.txt").read_text(encoding="utf-8").split():
        if word.endswith(":"):
            module = word[:-1]
        else:
            yield f"{module}.{word}"


LACKS = {
    **dict.fromkeys((*ANNOTATIONS.split(), *imports()), "no program was seen to import it"),
    "rclpy.context.g_logging_configure_lock": "aionode configures logging without a lock",
    "rclpy.context.g_logging_ref_count": "aionode does not count contexts that log",
    "rclpy.impl.implementation_singleton.import_c_library": "there is no compiled library",
    "rclpy.impl.implementation_singleton.package": "there is no compiled library",
    **dict.fromkeys(
        (
            f"rclpy.impl.rcutils_logger.{name}"
            for name in (
                "CallerId",
                "LoggingArgs",
                "LoggingFilter",
                "LoggingFilterArgs",
                "LoggingFilterParams",
                "Once",
                "OnceContext",
                "RcutilsLoggerContext",
                "SkipFirst",
                "SkipFirstContext",
                "SupportedFiltersKeys",
                "Throttle",
                "ThrottleContext",
                "get_filters_from_kwargs",
                "supported_filters",
            )
        ),
        FILTERS,
    ),
    "rclpy.action.server.ActionServer.notify_goal_done": "the server itself calls its like",
    "rclpy.exceptions.InvalidParameterTypeException.Parameter": "an import inside of the class",
    "rclpy.qos.LivelinessPolicy.RMW_QOS_POLICY_DURABILITY_UNKNOWN": "a slip: LIVELINESS is meant",
    "rclpy.qos.QoSLivelinessPolicy.RMW_QOS_POLICY_DURABILITY_UNKNOWN": "the same class",
}
"""The names that do not exist here, with the reason."""

SHARED = {
    "aionode.clock": "one class for both APIs",
    "aionode.endpoints": "one class for both APIs",
    "aionode.engine": "one class for both APIs",
    "aionode.errors": "one class for both APIs; programs of rclpy see its name in rclpy",
    "aionode.lifecycle": "one class for both APIs",
    "aionode.logging": "one class for both APIs",
    "aionode.parameter": "one class for both APIs",
    "aionode.qos": "one class for both APIs",
    "typing": "a name for annotations",
}
"""The modules whose classes keep their `__module__`, with the reason."""

SEEN = {
    "ament_index_python.packages": "get_resource os pathlib",
    "rclpy.action.client": "CancelGoal",
    "rclpy.client": "SrvType SrvTypeRequest SrvTypeResponse",
    "rclpy.executors": "Future time",
    "rclpy.node": "Any Callable Context List MsgType Optional ParameterDescriptor "
    "ParameterNotDeclaredException ParameterType ParameterValue SetParametersResult SrvType "
    "SrvTypeRequest SrvTypeResponse Union",
    "rclpy.parameter": "ParameterMsg ParameterType ParameterValue",
    "rclpy.publisher": "MsgType",
    "rclpy.qos": "Duration",
    "rclpy.service": "SrvType SrvTypeRequest SrvTypeResponse",
    "rclpy.subscription": "MsgType",
    "rclpy.timer": "Clock",
    "rclpy.type_support": "FeedbackMessage GetResultServiceResponse",
    "tf2_geometry_msgs": "Point PointStamped Pose PoseStamped PoseWithCovarianceStamped "
    "TransformStamped Vector3Stamped",
    "tf2_geometry_msgs.tf2_geometry_msgs": "PoseStamped",
    "tf2_ros": "Duration PointStamped PoseStamped TFMessage Time TransformStamped",
    "tf2_ros.buffer_interface": "TransformStamped",
}
"""Names that public programs take from modules that only import them; docs/decisions/rclpy.md says
where they were seen."""


def imported(module: str) -> Any:
    """Return an imported module, ignoring its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return importlib.import_module(module)


def lacking(owner: Any, path: str, names: list[str]) -> Iterator[str]:
    """Yield the names that a module or class lacks."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield from (f"{path}.{name}" for name in names if not hasattr(owner, name))


@pytest.mark.usefixtures("installed")
def test_modules_have_the_names_of_rclpy() -> None:
    """Programs use some names where rclpy imports them, not where it defines them."""
    found = {
        name
        for module, names in EXPECTED["modules"].items()
        for name in lacking(imported(module), module, names)
    }

    assert found - set(LACKS) == set()


@pytest.mark.usefixtures("installed")
def test_classes_have_the_names_of_rclpy() -> None:
    """Methods, properties, and constants."""
    found: set[str] = set()
    for path, names in EXPECTED["classes"].items():
        module, _, name = path.rpartition(".")
        if path not in LACKS:
            found.update(lacking(getattr(imported(module), name), path, names))

    assert found - set(LACKS) == set()


@pytest.mark.usefixtures("installed")
def test_classes_say_the_module_of_rclpy() -> None:
    """Tracebacks, `repr` and pickles show it, and programs compare it."""
    wrong = {
        path: cls.__module__
        for path in set(EXPECTED["classes"]) - set(LACKS)
        for module, _, name in [path.rpartition(".")]
        for cls in [getattr(imported(module), name)]
        if cls.__module__ != module
    }

    assert {path: at for path, at in wrong.items() if not at.startswith(tuple(SHARED))} == {}


@pytest.mark.usefixtures("installed")
def test_a_name_is_lacking_as_long_as_it_is_listed() -> None:
    """An exception that is no longer needed is taken off the list."""
    known = {
        f"{path}.{name}"
        for kind in EXPECTED.values()
        for path, names in kind.items()
        for name in names
    }

    assert set(LACKS) - known == set()
    for path in LACKS:
        owner, _, name = path.rpartition(".")
        module, _, cls = owner.rpartition(".")
        there = imported(owner) if owner in EXPECTED["modules"] else getattr(imported(module), cls)
        assert not hasattr(there, name), path


@pytest.mark.usefixtures("installed")
def test_a_name_from_elsewhere_is_the_same_object() -> None:
    """A parameter described by the other of two equally named classes would be refused."""
    node, client = imported("rclpy.node"), imported("rclpy.client")

    assert node.ParameterDescriptor is message_class("rcl_interfaces/msg/ParameterDescriptor")
    assert imported("rclpy.parameter").ParameterMsg is message_class("rcl_interfaces/msg/Parameter")
    assert node.Context is imported("rclpy.context").Context
    assert client.SrvTypeRequest is node.SrvTypeRequest
    assert imported("rclpy.parameter").ParameterType.PARAMETER_STRING_ARRAY == 9
    assert "ParameterDescriptor" in dir(node)


@pytest.mark.usefixtures("installed")
def test_an_unknown_name_is_no_name_of_a_module() -> None:
    """The error names the module as the program does."""
    with pytest.raises(AttributeError, match=r"module 'rclpy\.node' has no attribute 'Nodes'"):
        _ = imported("rclpy.node").Nodes


@pytest.mark.usefixtures("installed")
def test_types_of_actions_have_parameters() -> None:
    """The navigator of nav2 of Kilted writes them into its annotations when it is imported."""
    support = imported("rclpy.type_support")

    for name in ("GetResultServiceResponse", "FeedbackMessage"):
        assert getattr(support, name)[int] is not None


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize(
    ("policy", "name"),
    [
        ("History", "KEEP_LAST"),
        ("Reliability", "BEST_EFFORT"),
        ("Durability", "TRANSIENT_LOCAL"),
        ("Liveliness", "MANUAL_BY_TOPIC"),
    ],
)
def test_a_former_name_of_a_policy_warns_as_in_rclpy(policy: str, name: str) -> None:
    """Programs from the time of Dashing have them."""
    found = getattr(imported("rclpy.qos"), f"QoS{policy}Policy")
    former = f"RMW_QOS_POLICY_{policy.upper()}_{name}"

    with pytest.warns(
        UserWarning, match=f"^{policy}Policy.{former} is deprecated. Use {policy}Policy.{name} inst"
    ):
        value = getattr(found, former)

    assert value is found[name]
    assert former.lower() not in found.short_keys()


@pytest.mark.usefixtures("installed")
def test_the_former_module_of_events_warns_as_in_rclpy() -> None:
    """It has the names of `rclpy.event_handler`."""
    sys.modules.pop("rclpy.qos_event", None)

    with pytest.warns(UserWarning, match="importing 'qos_event' is deprecated"):
        module = importlib.import_module("rclpy.qos_event")

    assert module.QoSEventHandler is imported("rclpy.event_handler").QoSEventHandler


@pytest.mark.timeout(120)
@pytest.mark.skipif(
    INTERPRETER not in os.environ,
    reason=f"{INTERPRETER} is not set: no interpreter that has rclpy to compare with",
)
def test_the_names_are_those_of_rclpy() -> None:
    """The comparison is with what rclpy has, not with what was once written down."""
    done = subprocess.run(
        [os.environ[INTERPRETER], str(HERE / "list_names.py")],
        capture_output=True,
        text=True,
        check=True,
    )

    assert json.loads(done.stdout) == EXPECTED


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.parametrize("first", ["from rclpy.action import ActionClient", "import rclpy.time"])
def test_a_module_of_rclpy_is_an_attribute_whatever_was_imported_first(first: str) -> None:
    """In ROS most modules import most others; drivers' examples say ``rclpy.node.Node``."""
    program = (
        f"import aionode.rclpy; aionode.rclpy.install(); import rclpy; {first}; "
        "print(rclpy.node.Node.__name__, rclpy.executors.__name__, hasattr(rclpy, 'nodes'))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )

    assert (done.stdout, done.stderr) == ("Node rclpy.executors False\n", "")


@pytest.mark.usefixtures("installed")
@pytest.mark.parametrize("module", SEEN)
def test_names_are_found_where_programs_take_them_from(module: str) -> None:
    """Editor completion inserts the module that an example happened to import."""
    found = imported(module)

    assert [name for name in SEEN[module].split() if not hasattr(found, name)] == []
    assert not hasattr(found, "no_such_name")
