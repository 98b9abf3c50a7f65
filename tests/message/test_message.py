"""How message, service and action classes are written, described, compared and copied."""

from __future__ import annotations

import copy
import pickle
import runpy
import subprocess
import sys
from pathlib import Path
from types import new_class
from typing import Any, ClassVar, Literal

import numpy as np
import pytest

from aionode.errors import MessageError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import Image, Imu, JointState
from aionode.interfaces.std_msgs.msg import ByteMultiArray, String
from aionode.message import (
    DEFAULT,
    ActionType,
    Array,
    Bounded,
    Constant,
    Field,
    FieldType,
    Message,
    Sequence,
    ServiceType,
    byte,
    constants,
    fields,
    float32,
    float64,
    int32,
    type_name,
    uint8,
)


class Inner(Message, typename="tutorial/msg/Inner"):
    """A message to nest."""

    number: int32 = 0


class Words(Message, typename="tutorial/msg/Words"):
    """Fields of many kinds, one after the other."""

    LIMIT: ClassVar[uint8] = 7

    text: str
    short: Bounded[str, 3] = "abc"
    flag: bool = True
    level: byte = b"\x02"
    inner: Inner = DEFAULT
    matrix: Array[float64, 4] = DEFAULT
    start: Array[float32, 2] = (1, 2)
    scores: Sequence[float32] = DEFAULT
    some: Sequence[Inner, 2] = DEFAULT
    data: Sequence[uint8] = DEFAULT


make_words: Any = Words  # to type checkers, a field without a default has to be given


def test_every_field_has_a_default_without_being_told() -> None:
    """ROS gives each field a zero; a class may specify another value."""
    words = make_words()

    assert (words.text, words.short, words.flag, words.level) == ("", "abc", True, b"\x02")
    assert words.inner == Inner(number=0)
    assert words.matrix.tolist() == [0.0] * 4
    assert words.start.tolist() == [1.0, 2.0]
    assert (words.scores.dtype, len(words.scores)) == (np.float32, 0)
    assert (words.some, words.data) == ([], b"")


def test_defaults_are_not_shared_between_messages() -> None:
    """Changing one message leaves the next one as it is."""
    make_words().matrix[0] = 5
    make_words().some.append(Inner())
    make_words().inner.number = 3

    assert make_words() == make_words()
    assert make_words().matrix[0] == 0


def test_fields_describe_type_and_default_in_order() -> None:
    """The codec, the hash and the CLI use this description."""
    described = {field.name: field for field in fields(Words)}

    assert list(described)[:3] == ["text", "short", "flag"]
    assert described["short"] == Field("short", FieldType("string", None, 3), "abc")
    assert described["start"] == Field(
        "start", FieldType("float32", None, None, "array", 2), (1, 2)
    )
    assert described["some"].type == FieldType("message", Inner, None, "bounded", 2)
    assert described["data"].type == FieldType("uint8", None, None, "unbounded")


def test_a_default_that_is_the_zero_is_none() -> None:
    """`x: float64 = 0.0` then equals a definition without a default."""
    assert all(field.default is None for field in fields(Vector3))
    assert [field.default for field in fields(Quaternion)] == [None, None, None, 1.0]


def test_constants_are_no_fields() -> None:
    """They belong to the class."""
    assert Words.LIMIT == 7
    assert constants(Words) == (Constant("LIMIT", FieldType("uint8"), 7),)


def test_type_names_of_halves_are_those_of_rosidl() -> None:
    """Requests and responses have their own names in type descriptions."""
    assert type_name(String) == "std_msgs/msg/String"
    assert type_name(AddTwoInts) == "example_interfaces/srv/AddTwoInts"
    assert type_name(AddTwoInts.Request) == "example_interfaces/srv/AddTwoInts_Request"
    assert type_name(AddTwoInts.Event) == "example_interfaces/srv/AddTwoInts_Event"
    assert type_name(Fibonacci.Goal) == "example_interfaces/action/Fibonacci_Goal"


def test_an_action_has_the_hidden_types_of_rclpy() -> None:
    """The action protocol consists of them; they are made on first use."""
    impl = Fibonacci.Impl

    assert impl is Fibonacci.Impl
    assert type_name(impl.SendGoalService) == "example_interfaces/action/Fibonacci_SendGoal"
    request = impl.SendGoalService.Request(goal=Fibonacci.Goal(order=3))
    assert type_name(type(request)) == "example_interfaces/action/Fibonacci_SendGoal_Request"
    assert [f.name for f in fields(impl.GetResultService.Response)] == ["status", "result"]
    assert [f.name for f in fields(impl.FeedbackMessage)] == ["goal_id", "feedback"]
    assert type_name(impl.CancelGoalService) == "action_msgs/srv/CancelGoal"
    assert type_name(impl.GoalStatusMessage) == "action_msgs/msg/GoalStatusArray"


def test_an_event_has_info_and_at_most_one_of_each_half() -> None:
    """As ROS's service introspection sends it."""
    info, request, response = fields(AddTwoInts.Event)

    assert type_name(info.type.nested) == "service_msgs/msg/ServiceEventInfo"
    assert request.type == FieldType("message", AddTwoInts.Request, None, "bounded", 1)
    assert response.type.nested is AddTwoInts.Response


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (String(data="hi"), "std_msgs.msg.String(data='hi')"),
        (AddTwoInts.Request(a=42, b=58), "example_interfaces.srv.AddTwoInts_Request(a=42, b=58)"),
        (
            Twist(linear=Vector3(x=1.5)),
            (
                "geometry_msgs.msg.Twist(linear=geometry_msgs.msg.Vector3(x=1.5, y=0.0, z=0.0), "
                "angular=geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.0))"
            ),
        ),
        (
            Fibonacci.Feedback(sequence=[0, 1]),
            "example_interfaces.action.Fibonacci_Feedback(sequence=[0, 1])",
        ),
    ],
)
def test_a_repr_is_that_of_rclpy(message: Message, text: str) -> None:
    """Logs and the CLI print messages like this."""
    assert repr(message) == text


def test_a_repr_shows_arrays_as_numpy_and_sequences_as_lists() -> None:
    """As in rclpy; a long sequence is shortened, so that an image fits on a line."""
    assert "covariance=array([0., 0., 0., 0., 0., 0., 0., 0., 0.])" in repr(Imu())
    assert "position=[1.0, 2.0]" in repr(JointState(position=np.array([1.0, 2.0])))
    assert "data=[1, 2]" in repr(Image(data=b"\x01\x02"))
    assert "data=[b'\\x01']" in repr(ByteMultiArray(data=b"\x01"))
    assert "data=[1, 1, 1, ..., 1, 1, 1]" in repr(Image(data=b"\x01" * 5000))


def test_equality_compares_values_arrays_included() -> None:
    """Both == and != return a bool, in whatever form an array is stored."""
    one, other = Imu(orientation_covariance=[1] * 9), Imu(orientation_covariance=np.ones(9))

    assert (one == other, one != other) == (True, False)
    other.orientation_covariance[3] = 2
    assert (one == other, one != other) == (False, True)
    for data in (memoryview(b"ab"), [97, 98], np.frombuffer(b"ab", np.uint8)):
        assert Image(data=b"ab") == Image(data=data)
        assert Image(data=data) == Image(data=b"ab")
        assert Image(data=data) != Image(data=b"aa")
    assert JointState(name=["a"]) != JointState(name=["a", "b"])
    assert JointState(position=np.zeros(2)) != JointState(position=np.zeros(3))


def test_messages_of_different_classes_are_never_equal() -> None:
    """Even if their fields have the same names and values."""
    assert Point() != Vector3()
    assert Point() != 0
    assert not Point() == Vector3()  # noqa: SIM201 (the other operator)


def test_messages_have_no_hash() -> None:
    """A mutable object cannot be a key."""
    with pytest.raises(TypeError, match="unhashable"):
        hash(String())


def test_deepcopy_shares_nothing_that_can_change() -> None:
    """Arrays and nested messages are copied, views become bytes."""
    data = bytearray(b"abc")
    image = Image(data=memoryview(data))
    words = make_words(inner=Inner(number=1), matrix=np.ones(4))

    copied, deep = copy.deepcopy(words), copy.deepcopy(image)
    words.inner.number, words.matrix[0], data[0] = 2, 0, 0

    assert (copied.inner.number, copied.matrix[0]) == (1, 1.0)
    assert bytes(deep.data) == b"abc"


def test_copy_is_shallow() -> None:
    """As `copy.copy` promises."""
    pose = Pose()

    assert copy.copy(pose).position is pose.position


@pytest.mark.parametrize(
    "message",
    [
        String(data="é"),
        AddTwoInts.Request(a=1),
        AddTwoInts.Event(request=[AddTwoInts.Request(a=1)]),
        Fibonacci.Impl.SendGoalService.Request(goal=Fibonacci.Goal(order=4)),
        Image(data=memoryview(b"ab")),
        Imu(orientation_covariance=range(9)),
    ],
)
def test_messages_can_be_pickled(message: Message) -> None:
    """Process pools send them this way."""
    assert pickle.loads(pickle.dumps(message)) == message  # noqa: S301 (made one line above)


def test_a_wrong_field_name_is_a_type_error() -> None:
    """At construction; when it is set, it is an AttributeError."""
    with pytest.raises(TypeError, match="dat"):
        String(dat="hi")  # type: ignore[call-arg] # the point of the test
    with pytest.raises(AttributeError):
        String().dat = "hi"  # type: ignore[attr-defined] # the point of the test


def test_construction_does_not_validate() -> None:
    """Values are checked by `publish`, so that a loop that fills fields stays fast."""
    wrong: Any = 5

    assert String(data=wrong).data == wrong


def test_fields_may_have_the_names_of_functions() -> None:
    """Message classes reserve no names."""

    class Odd(Message, typename="tutorial/msg/Odd"):
        type_hash: str = "a"
        name: str = "b"
        fields: int32 = 3
        encode: bool = True
        str_: ClassVar[int32] = 0

    assert [field.name for field in fields(Odd)] == ["type_hash", "name", "fields", "encode"]
    assert Odd(fields=4) != Odd()


def message(field: str) -> type:
    """Return a message class with one field."""
    body = {"__annotations__": {field: int32}}
    return new_class(
        "Odd", (Message,), {"typename": "tutorial/msg/Odd"}, lambda ns: ns.update(body)
    )


@pytest.mark.parametrize("name", ["_x", "Upper", "a__b", "end_", "from"])
def test_a_field_name_that_ros_refuses_is_refused(name: str) -> None:
    """No definition could be printed, and generated code contains these names."""
    with pytest.raises(TypeError, match=f"tutorial/msg/Odd.{name}: not a valid ROS field name"):
        message(name)


@pytest.mark.parametrize("name", ["Words", "tutorial/Words", "tutorial/msg/words", "A/msg/B"])
def test_a_type_name_has_to_be_one(name: str) -> None:
    """Keys, tokens and hashes contain it."""
    with pytest.raises(TypeError, match="not a valid ROS type name"):

        class Bad(Message, typename=name):
            pass


def test_an_annotation_without_a_width_says_what_fits() -> None:
    """`int` alone has no width on the wire, and a service is not a value."""
    with pytest.raises(TypeError, match="AddTwoInts: not a field type"):
        Array[AddTwoInts, 3]
    with pytest.raises(TypeError, match="use int32 or int64"):

        class Bad(Message, typename="tutorial/msg/Bad"):
            number: int = 0


def test_a_default_that_does_not_fit_is_refused_at_once() -> None:
    """With the same error as a wrong value."""
    with pytest.raises(MessageError, match=r"tutorial/msg/Bad\.number: 300, uint8 holds 0 to 255"):

        class Bad(Message, typename="tutorial/msg/Bad"):
            number: uint8 = 300


def test_arrays_of_arrays_are_refused() -> None:
    """ROS has no such type."""
    with pytest.raises(TypeError, match="no arrays of arrays"):
        Array[Sequence[int32], 3]


@pytest.mark.parametrize("size", [0, -1, "3"])
def test_a_size_is_a_positive_int(size: object) -> None:
    """A size of zero is a mistake."""
    with pytest.raises(TypeError, match="at least 1"):
        Array[int32, size]


def test_an_array_needs_a_size_and_only_strings_have_a_bound() -> None:
    """The error shows how it is written."""
    make: Any = Array
    bound: Any = Bounded

    with pytest.raises(TypeError, match=r"as in Array\[float64, 9\]"):
        make[int32]
    with pytest.raises(TypeError, match="only strings have a bound, not int32"):
        bound[int32, 3]
    with pytest.raises(TypeError, match="size or bound 0 given"):
        bound[str, 0]


def test_a_size_may_be_a_literal_type() -> None:
    """Some type checkers require it."""
    assert Array[int32, Literal[3]] == Array[int32, 3]


def test_bytes_are_a_default_for_bytes() -> None:
    """The shortest form; the description contains numbers, as a definition would."""

    class Blob(Message, typename="tutorial/msg/Blob"):
        data: Sequence[uint8] = b"ab"
        fixed: Array[byte, 2] = DEFAULT

    assert Blob() == Blob(data=[97, 98], fixed=b"\0\0")
    assert [field.default for field in fields(Blob)] == [(97, 98), None]


@pytest.mark.parametrize(
    ("annotation", "default", "problem"),
    [
        (Inner, Inner(), "a nested message cannot have a default here; write DEFAULT"),
        (Sequence[int32], 5, r"5 \(int\), needs a list or tuple"),
        (Array[int32, 2], (1,), "1 elements, needs 2"),
        (Sequence[int32], (1, "b"), r"'b' \(str\), needs an int"),
    ],
)
def test_other_defaults_that_do_not_fit(annotation: object, default: object, problem: str) -> None:
    """All of them are found when the class is defined."""
    body = {"__annotations__": {"field": annotation}, "field": default}

    with pytest.raises(MessageError, match=problem):
        new_class("Bad", (Message,), {"typename": "tutorial/msg/Bad"}, lambda ns: ns.update(body))


def test_a_service_needs_both_halves() -> None:
    """A half without fields is written as a class without fields."""
    with pytest.raises(TypeError, match=r"needs a nested class Response\(Message\)"):

        class Bad(ServiceType, typename="tutorial/srv/Bad"):
            class Request(Message):
                pass


def test_an_action_is_written_as_a_class() -> None:
    """It has three nested messages, which get their ROS names from it."""

    class Walk(ActionType, typename="tutorial/action/Walk"):
        class Goal(Message):
            distance: float64 = 0.0

        class Result(Message):
            pass

        class Feedback(Message):
            done: float64 = 0.0

    assert type_name(Walk.Feedback) == "tutorial/action/Walk_Feedback"
    assert type_name(Walk.Impl.FeedbackMessage) == "tutorial/action/Walk_FeedbackMessage"


def test_a_message_without_a_name_says_how_to_name_it() -> None:
    """A request outside of a service, or a forgotten argument."""

    class Nameless(Message):
        pass

    with pytest.raises(TypeError, match="give it typename="):
        type_name(Nameless)


def test_fields_of_something_else_is_a_type_error() -> None:
    """A service is not a message, and the error names its parts that are."""
    with pytest.raises(TypeError, match=r"such as \.Request"):
        fields(AddTwoInts)  # type: ignore[arg-type] # the point of the test
    with pytest.raises(TypeError, match="not a message"):
        type_name(int)


def test_a_subclass_keeps_the_fields_of_its_base() -> None:
    """It has a name of its own if one is given."""

    class More(Inner, typename="tutorial/msg/More"):
        extra: str = ""

    assert [field.name for field in fields(More)] == ["number", "extra"]
    assert (type_name(Inner), type_name(More)) == ("tutorial/msg/Inner", "tutorial/msg/More")


def test_numpy_is_not_imported_before_an_array_is_made() -> None:
    """A node that sends strings does not pay for it."""
    program = (
        "import sys\n"
        "from aionode.interfaces.rcl_interfaces.srv import SetParameters\n"
        "from aionode.interfaces.sensor_msgs.msg import Image\n"
        "from aionode.interfaces.std_msgs.msg import String\n"
        "from aionode.message import snapshot\n"
        "snapshot(String(data='hi')), snapshot(Image(data=b'abc'))\n"
        "assert 'numpy' not in sys.modules\n"
        "assert 'yaml' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


def test_a_type_that_is_imported_for_type_checkers_only_is_refused(tmp_path: Path) -> None:
    """The error names class, field and remedy; Python's NameError names none of them."""
    module = tmp_path / "unseen.py"
    module.write_text(
        "from __future__ import annotations\n"
        "from typing import TYPE_CHECKING\n"
        "from aionode.message import DEFAULT, Message\n"
        "if TYPE_CHECKING:\n"
        "    from aionode.interfaces.geometry_msgs.msg import Point\n"
        "class Spot(Message, typename='tutorial/msg/Spot'):\n"
        "    where: Point = DEFAULT\n"
    )

    with pytest.raises(
        TypeError,
        match=r"tutorial/msg/Spot\.where: Point: 'Point' is not known while the class is made; .*"
        r"import it outside of `if TYPE_CHECKING:`",
    ):
        runpy.run_path(str(module))
