"""``aionode topic echo``."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode import Context, Node, QoSProfile, ReliabilityPolicy
from aionode.cli._nouns.topic.echo import echo
from aionode.cli._support.session import make_node
from aionode.engine.transport.local import LocalTransport
from aionode.errors import CommandError
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import JointState
from aionode.interfaces.std_msgs.msg import (
    ByteMultiArray,
    Header,
    Int32MultiArray,
    String,
    UInt8MultiArray,
)
from aionode.interfaces.trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from aionode.testing import FaultyTransport, settle


async def echoed(
    running: Any, tool: Node, screen: Any, talker: Node, *messages: Any, **options: Any
) -> str:
    """Return what echo prints of some messages."""
    topic = "/topic"
    publisher = talker.create_publisher(type(messages[0]), topic, 10)
    options.setdefault("output", screen.output)
    async with running(echo(tool, topic, **options)) as task:
        for message in messages:
            publisher.publish(message)
            await settle()
        if task.done():
            task.result()
    text: str = screen.text
    return text


@pytest.fixture
async def talker(node_factory: Callable[..., Node]) -> Node:
    """A node that publishes."""
    return node_factory("talker")


async def test_each_message_is_yaml_and_three_dashes(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """The tutorial's output, which other tools read as a stream of YAML documents."""
    text = await echoed(
        running, tool, screen, talker, String(data="Hello 46"), String(data="Hello 47")
    )

    assert text == "data: Hello 46\n---\ndata: Hello 47\n---\n"


async def test_nested_messages_are_indented(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """Block style, fields in the order of their definition."""
    text = await echoed(running, tool, screen, talker, Twist(linear=Vector3(x=1.5)))

    assert text == (
        "linear:\n  x: 1.5\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: 0.0\n---\n"
    )


async def test_once_ends_after_one_message(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """Scripts read one message this way."""
    publisher = talker.create_publisher(String, "/topic", 10)
    async with running(echo(tool, "/topic", once=True, output=screen.output)) as task:
        publisher.publish(String(data="first"))
        publisher.publish(String(data="second"))
        await settle()
        assert task.result() == 0

    assert screen.text == "data: first\n---\n"


async def test_csv_is_one_line_of_values(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """For plotting."""
    state = JointState(name=["a", "b"], position=[1.0, 2.0])

    text = await echoed(running, tool, screen, talker, state, csv=True)

    assert text == "0,0,,a,b,1.0,2.0,,\n"


async def test_json_is_one_line_in_full(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """A program needs everything; --field selects a part."""
    message = String(data="x" * 200)

    await echoed(running, tool, screen, talker, message, output=screen.json_output)

    assert screen.records == [{"data": "x" * 200}]


async def test_several_fields_are_printed_in_order(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """A plot of one against the other needs both of the same message."""
    state = JointState(name=["a", "b"], position=[1.0, 2.0])

    text = await echoed(running, tool, screen, talker, state, fields=("position", "name"))

    assert text == "[1.0, 2.0]\n['a', 'b']\n---\n"


async def test_long_arrays_and_strings_are_cut(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """A point cloud would otherwise fill the terminal for minutes."""
    message = JointState(name=["abcdef"], position=[1.0, 2.0, 3.0])

    text = await echoed(running, tool, screen, talker, message, truncate_length=2, flow_style=True)

    assert "name: [ab...]" in text
    assert "position: [1.0, 2.0, '...']" in text


async def test_bytes_are_numbers(running: Any, tool: Node, talker: Node, screen: Any) -> None:
    """uint8[] is data, not text."""
    message = UInt8MultiArray(data=b"\x01\x02\x03")

    text = await echoed(running, tool, screen, talker, message, truncate_length=2, flow_style=True)

    assert "data: [1, 2, '...']" in text


async def test_no_arr_and_no_str_describe_what_they_leave_out(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """The length is still shown."""
    message = JointState(name=["a"], position=[1.0, 2.0], header=Header(frame_id="map"))

    text = await echoed(running, tool, screen, talker, message, no_arr=True, no_str=True)

    assert "position: '<sequence type: double, length: 2>'" in text
    assert "frame_id: '<string length: <3>>'" in text


@pytest.mark.parametrize(
    ("options", "shown"),
    [
        ({}, 'data:\n- "\\x01"\n- a\n- ÿ\n---\n'),
        ({"flow_style": True}, 'data: ["\\x01", a, ÿ]\n---\n'),
        ({"truncate_length": 1, "flow_style": True}, "data: [\"\\x01\", '...']\n---\n"),
        ({"no_arr": True}, "data: '<sequence type: octet, length: 3>'\n---\n"),
        ({"csv": True}, "b'\\x01',b'a',b'\\xff'\n"),
        ({"fields": ("data",)}, "[b'\\x01', b'a', b'\\xff']\n---\n"),
    ],
)
async def test_bytes_are_characters(
    options: dict[str, Any], shown: str, running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """ros2 prints a `byte` this way, and a CSV row uses Python's notation."""
    message = ByteMultiArray(data=b"\x01a\xff")

    text = await echoed(running, tool, screen, talker, message, **options)

    assert text.endswith(shown)


async def test_flow_style_is_that_of_arrays(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """ros2 keeps one line per field; only messages within arrays are in braces."""
    message = JointTrajectory(
        joint_names=["a", "b"], points=[JointTrajectoryPoint(positions=[1.0, 2.0])]
    )

    text = await echoed(running, tool, screen, talker, message, flow_style=True)

    assert text == (
        "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: ''\n"
        "joint_names: [a, b]\n"
        "points: [{positions: [1.0, 2.0], velocities: [], accelerations: [], effort: [], "
        "time_from_start: {sec: 0, nanosec: 0}}]\n---\n"
    )


@pytest.mark.parametrize(
    ("path", "shown"),
    [
        ("linear", "x: 1.5\ny: 0.0\nz: 0.0\n---\n"),
        ("linear.x", "1.5\n---\n"),
        (".linear.x", "1.5\n---\n"),
    ],
)
async def test_field_prints_a_part(
    path: str, shown: str, running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """A part that is a message is printed as one."""
    message = Twist(linear=Vector3(x=1.5))

    text = await echoed(running, tool, screen, talker, message, fields=(path,))

    assert text == shown


async def test_field_takes_an_index(running: Any, tool: Node, talker: Node, screen: Any) -> None:
    """``names[0]`` is what one would write in Python."""
    message = Int32MultiArray(data=[4, 5])

    text = await echoed(running, tool, screen, talker, message, fields=("data[1]",))

    assert text == "5\n---\n"


@pytest.mark.parametrize(
    ("path", "says"),
    [
        ("liner", "no 'liner' in it; geometry_msgs/msg/Twist has linear, angular"),
        ("linear.x.y", "a single value has no fields"),
        ("linear[0]", r"nothing at \[0\] of linear"),
        (".", "expected a path such as pose.position"),
    ],
)
async def test_a_wrong_field_says_which_there_are(
    path: str, says: str, running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """ros2 shows a Python error here."""
    with pytest.raises((CommandError, ExceptionGroup)) as raised:
        await echoed(running, tool, screen, talker, Twist(), fields=(path,))

    assert raised.group_contains(CommandError, match=says) or raised.match(says)


async def test_filter_lets_through_what_fits(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """``m`` is the message, or the field if there is one."""
    messages = [Twist(linear=Vector3(x=x)) for x in (1.0, 2.0, 3.0)]

    text = await echoed(
        running, tool, screen, talker, *messages, fields=("linear.x",), filter_text="m > 1.5"
    )

    assert text == "2.0\n---\n3.0\n---\n"


@pytest.mark.parametrize(
    ("expression", "says"),
    [("m.x >", "not a Python expression"), ("m.nope", "AttributeError")],
)
async def test_a_filter_that_fails_is_an_error_of_the_user(
    expression: str, says: str, running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """An error in the user's expression shows no traceback of aionode."""
    with pytest.raises((CommandError, ExceptionGroup)) as raised:
        await echoed(running, tool, screen, talker, Twist(), filter_text=expression)

    assert raised.group_contains(CommandError, match=says) or raised.match(says)


async def test_message_info_stands_in_front(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """Times and numbers of the message, as in ros2."""
    text = await echoed(running, tool, screen, talker, String(data="a"), with_info=True)

    head, body, _ = text.split("---\n")
    assert [line.partition(":")[0] for line in head.splitlines()] == [
        "source_timestamp",
        "received_timestamp",
        "publication_sequence_number",
        "reception_sequence_number",
    ]
    assert body == "data: a\n"


async def test_raw_prints_the_bytes(running: Any, tool: Node, talker: Node, screen: Any) -> None:
    """CDR as sent: a header of four bytes, then the length of the string."""
    text = await echoed(running, tool, screen, talker, String(data="a"), raw=True)

    assert text == "b'\\x00\\x01\\x00\\x00\\x02\\x00\\x00\\x00a\\x00'\n---\n"


async def test_a_topic_without_endpoints_is_an_error(tool: Node, talker: Node, screen: Any) -> None:
    """Without a type there is nothing to subscribe to; the error says how to give one."""
    talker.create_publisher(String, "/chatter", 1)

    with pytest.raises(CommandError, match="Did you mean '/chatter'") as raised:
        await echo(tool, "/chater", once=True, output=screen.output)

    assert str(raised.value).startswith("Could not determine the type for the passed topic")
    assert "aionode topic echo /chater std_msgs/msg/String" in str(raised.value)


async def test_with_a_type_it_waits_for_the_topic(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """Terminals are often opened before the node starts."""
    options = {"once": True, "output": screen.output}
    async with running(echo(tool, "/topic", "std_msgs/msg/String", **options)) as task:
        assert screen.errors == ("WARNING: topic [/topic] does not appear to be published yet\n")
        talker.create_publisher(String, "/topic", 10).publish(String(data="late"))
        await settle()
        assert task.done()

    assert screen.text == "data: late\n---\n"


async def test_a_timeout_without_a_message_is_reported(
    tool: Node, talker: Node, screen: Any
) -> None:
    """Otherwise a script could not tell silence from success."""
    talker.create_publisher(String, "/topic", 10)

    status = await echo(tool, "/topic", timeout=0.001, output=screen.output)

    assert status == 1
    assert screen.errors == "No message on '/topic' within 0.001 s; publishers: 1\n"


async def test_mixed_publishers_are_read_with_what_all_offer(
    running: Any, tool: Node, talker: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Requesting more than a publisher offers would exclude that publisher."""
    weak = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    other = node_factory("other").create_publisher(String, "/topic", weak)

    publisher = talker.create_publisher(String, "/topic", 10)
    async with running(echo(tool, "/topic", output=screen.output)):
        publisher.publish(String(data="reliable"))
        other.publish(String(data="best effort"))
        await settle()

    assert screen.text == "data: reliable\n---\ndata: best effort\n---\n"
    assert "Some, but not all, publishers are offering ReliabilityPolicy.RELIABLE" in screen.errors


async def test_two_types_need_a_choice(
    tool: Node, talker: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Otherwise messages of one would be decoded as the other."""
    talker.create_publisher(String, "/topic", 1)
    node_factory("other").create_publisher(Twist, "/topic", 1)

    with pytest.raises(CommandError, match="more than one type: geometry_msgs/msg/Twist, std_msgs"):
        await echo(tool, "/topic", output=screen.output)


async def test_lost_messages_are_reported(running: Any, screen: Any) -> None:
    """On stderr, since they are not data; the count is the total so far."""
    faulty = FaultyTransport(LocalTransport(), drop=0.5, seed=2)
    async with (
        Context(transport=faulty) as context,
        Node("talker", context=context) as talker,
        make_node(context) as tool,
    ):
        publisher = talker.create_publisher(String, "/topic", 100)
        async with running(echo(tool, "/topic", output=screen.output)):
            for number in range(20):
                publisher.publish(String(data=str(number)))
            await settle()

    arrived = [int(line.split("'")[1]) for line in screen.text.splitlines() if "data" in line]
    lost = arrived[-1] + 1 - len(arrived)
    assert lost > 0
    assert screen.errors.endswith(f"\n\ttotal count: {lost}---\n")
    assert screen.errors.startswith("A message was lost!!!\n\ttotal count change:")


async def test_a_content_filter_keeps_messages_away(
    running: Any, tool: Node, talker: Node, screen: Any
) -> None:
    """In the language of DDS; publishers in other processes do not even send the others."""
    text = await echoed(
        running,
        tool,
        screen,
        talker,
        *(String(data=word) for word in ("apple", "pear", "apricot")),
        content_filter="data LIKE 'ap%'",
    )

    assert text == "data: apple\n---\ndata: apricot\n---\n"


async def test_a_content_filter_that_does_not_fit_is_an_error(
    tool: Node, talker: Node, screen: Any
) -> None:
    """With what is wrong, and where."""
    talker.create_publisher(String, "/topic", 10)

    with pytest.raises(CommandError, match=r"--content-filter: .*has no field 'date'"):
        await echo(tool, "/topic", content_filter="date = 1", output=screen.output)
