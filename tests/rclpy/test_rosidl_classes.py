"""Message classes like those of rosidl: how programs use them, and the texts of their errors."""

from __future__ import annotations

import array
import copy
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from aionode.errors import InterfaceNotFoundError
from aionode.interfaces.std_msgs.msg import String as OwnString
from rosidl_generator_py import (
    action_class,
    aionode_class,
    from_aionode,
    interface_class,
    message_class,
    ros_type_name,
    service_class,
)
from rosidl_parser.definition import BasicType, NamespacedType, UnboundedSequence

String = message_class("std_msgs/msg/String")
Header = message_class("std_msgs/msg/Header")
LaserScan = message_class("sensor_msgs/msg/LaserScan")
Imu = message_class("sensor_msgs/msg/Imu")
Strings = message_class("test_msgs/msg/Strings")
Sequences = message_class("test_msgs/msg/UnboundedSequences")
Bounded = message_class("test_msgs/msg/BoundedSequences")
BasicTypes = message_class("test_msgs/msg/BasicTypes")
Fibonacci = action_class("example_interfaces/action/Fibonacci")


def test_a_class_has_the_names_that_rosidl_gives_it() -> None:
    """Programs print them, and rosbridge takes the ROS name from the module's name."""
    assert str(String) == "<class 'std_msgs.msg._string.String'>"
    assert type(String).__name__ == "Metaclass_String"
    assert String.__slots__ == ["_data", "_check_fields"]
    assert LaserScan.get_fields_and_field_types()["ranges"] == "sequence<float>"
    assert LaserScan.SLOT_TYPES[0] == NamespacedType(["std_msgs", "msg"], "Header")
    assert LaserScan.SLOT_TYPES[-1] == UnboundedSequence(BasicType("float"))


def test_a_type_has_one_class() -> None:
    """Classes created twice, or in two threads, would not be equal to themselves."""
    found: list[Any] = []
    wait = threading.Barrier(4)

    def ask() -> None:
        wait.wait()
        found.append(message_class("visualization_msgs/msg/MarkerArray"))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    assert len(set(found)) == 1


def test_the_own_type_of_a_header_is_the_class_of_its_name() -> None:
    """A nested message is of the same class as one made by the program."""
    assert type(LaserScan().header) is Header


def test_services_and_actions_have_their_parts() -> None:
    """Programs find requests, results and the hidden services of an action as attributes."""
    service = service_class("std_srvs/srv/SetBool")

    assert service.Request(data=True).data is True
    assert str(service.Event) == "<class 'std_srvs.srv._set_bool.SetBool_Event'>"
    assert type(Fibonacci.Result().sequence) is array.array
    request = Fibonacci.Impl.SendGoalService.Request()
    assert type(request.goal) is Fibonacci.Goal
    assert Fibonacci.Impl.CancelGoalService is service_class("action_msgs/srv/CancelGoal")
    with pytest.raises(NotImplementedError, match="Action classes can not be instantiated"):
        Fibonacci()


def test_a_program_can_ask_for_the_type_support() -> None:
    """It is checked before rclpy creates an endpoint."""
    metaclass = type(message_class("std_msgs/msg/Int8"))
    assert metaclass._TYPE_SUPPORT is None  # type: ignore[attr-defined]

    metaclass.__import_type_support__()  # type: ignore[attr-defined]

    assert metaclass._TYPE_SUPPORT is not None  # type: ignore[attr-defined]


def test_sequences_of_numbers_are_python_arrays() -> None:
    """Programs append to them, test them for truth, and join them."""
    scan = LaserScan(ranges=[1.0])
    scan.ranges.append(2.5)
    scan.ranges.extend([3.0])

    assert scan.ranges == array.array("f", [1.0, 2.5, 3.0])
    assert type(scan.ranges[0]) is float
    assert not LaserScan().ranges


def test_arrays_of_numbers_are_numpy_arrays() -> None:
    """Programs calculate with covariances, and write into them."""
    imu = Imu()
    imu.orientation_covariance[4] = 2.0

    assert imu.orientation_covariance.dtype == np.float64
    assert imu == copy.deepcopy(imu)
    assert imu != Imu()


def test_a_message_shows_itself_as_in_ros() -> None:
    """Logs of programs stay the same."""
    scan = LaserScan(ranges=[1.0, 2.0])

    assert str(String(data="hi")) == "std_msgs.msg.String(data='hi')"
    assert "ranges=[1.0, 2.0], intensities=[]" in str(scan)


@pytest.mark.parametrize(
    ("module", "text"), [("__main__", "Greeting(data='hi')"), ("a.b", "a.Greeting(data='hi')")]
)
def test_a_class_derived_from_a_message_is_shown_without_its_module(module: str, text: str) -> None:
    """The classes of ROS are in private modules, which rosidl leaves out."""
    greeting = type("Greeting", (message_class("std_msgs/msg/String"),), {"__module__": module})

    assert repr(greeting(data="hi")) == text


def test_constants_can_be_read_and_not_set() -> None:
    """They belong to the metaclass, as in rosidl, and instances have them, too."""
    transition = message_class("lifecycle_msgs/msg/Transition")

    assert transition.TRANSITION_ON_ERROR_ERROR == 62
    assert transition().TRANSITION_CONFIGURE == 1
    assert message_class("rcl_interfaces/msg/LoggerLevel").LOG_LEVEL_FATAL == 50
    with pytest.raises(AttributeError, match=r"TRANSITION_CONFIGURE|property"):
        transition.TRANSITION_CONFIGURE = 5


def test_defaults_are_new_for_each_message() -> None:
    """Changing a list in one message must not affect the next one."""
    first = message_class("test_msgs/msg/UnboundedSequences")()
    first.bool_values_default.append(True)

    second = message_class("test_msgs/msg/UnboundedSequences")()

    assert second.bool_values_default == [False, True, False]


def test_nothing_is_checked_by_default() -> None:
    """Kilted switched the checks off; programs rely on it by accident."""
    assert String(data=5).data == 5
    assert String(wrong=5).data == ""


@pytest.mark.parametrize(
    ("assign", "text"),
    [
        (lambda: String(data=5, check_fields=True), "The 'data' field must be of type 'str'"),
        (
            lambda: BasicTypes(int8_value=300, check_fields=True),
            "The 'int8_value' field must be an integer in [-128, 127]",
        ),
        (
            lambda: BasicTypes(uint8_value=-1, check_fields=True),
            "The 'uint8_value' field must be an unsigned integer in [0, 255]",
        ),
        (
            lambda: BasicTypes(float32_value=1e300, check_fields=True),
            "The 'float32_value' field must be a float in [-3.402823466e+38, 3.402823466e+38]",
        ),
        (
            lambda: BasicTypes(byte_value=1, check_fields=True),
            "The 'byte_value' field must be of type 'bytes' or 'ByteString' with length 1",
        ),
        (
            lambda: Strings(bounded_string_value="x" * 23, check_fields=True),
            "The 'bounded_string_value' field must be string value not longer than 22",
        ),
        (
            lambda: Header(stamp=5, check_fields=True),
            "The 'stamp' field must be a sub message of type 'Time'",
        ),
        (
            lambda: Sequences(bool_values=[1], check_fields=True),
            "The 'bool_values' field must be a set or sequence and each value of type 'bool'",
        ),
        (
            lambda: Bounded(int8_values=[1, 2, 3, 4], check_fields=True),
            "The 'int8_values' array.array() must have a size <= 3",
        ),
        (
            lambda: Imu(orientation_covariance=np.zeros(3), check_fields=True),
            "The 'orientation_covariance' numpy.ndarray() must have a size of 9",
        ),
        (
            lambda: Imu(orientation_covariance=np.zeros(9, np.float32), check_fields=True),
            "The 'orientation_covariance' numpy.ndarray() must have the dtype of 'numpy.float64'",
        ),
        (
            lambda: String(wrong=1, other=2, check_fields=True),
            "Invalid arguments passed to constructor: other, wrong",
        ),
    ],
)
def test_checks_have_the_texts_of_rosidl(assign: Callable[[], Any], text: str) -> None:
    """Tests of users' programs match them."""
    with pytest.raises(AssertionError) as caught:
        assign()

    assert str(caught.value) == text


def test_names_lead_to_classes_and_back() -> None:
    """Messages of rclpy itself, such as those of parameters, are found by name."""
    assert interface_class("std_msgs/String") is String
    assert ros_type_name(String) == "std_msgs/msg/String"
    assert ros_type_name(Fibonacci.Impl.FeedbackMessage).endswith("Fibonacci_FeedbackMessage")
    assert aionode_class(String) is OwnString
    assert aionode_class(OwnString) is OwnString
    assert from_aionode(OwnString(data="x")) == String(data="x")


def test_what_is_no_type_is_refused() -> None:
    """The error shows what was given, or similar names."""
    with pytest.raises(TypeError, match="<class 'int'>: not a message, service or action class"):
        ros_type_name(int)
    with pytest.raises(InterfaceNotFoundError, match="did you mean std_msgs/msg/String"):
        message_class("std_msgs/msg/Strin")
    with pytest.raises(TypeError, match="std_srvs/srv/SetBool: not a message type"):
        message_class("std_srvs/srv/SetBool")
