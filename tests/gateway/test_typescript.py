"""TypeScript types of messages."""

from __future__ import annotations

from aionode.gateway import typescript
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.sensor_msgs.msg import Image, LaserScan
from aionode.interfaces.std_msgs.msg import String
from aionode.message import Message


def test_a_message_is_an_interface_with_those_nested_in_it() -> None:
    """A program that needs the types of one message needs no second command."""
    text = typescript([Twist])

    assert "export namespace geometry_msgs.msg {" in text
    assert "    linear: geometry_msgs.msg.Vector3;" in text
    assert "  interface Vector3 {\n    x: Real;" in text


def test_the_types_are_those_of_the_json_that_the_gateway_writes() -> None:
    """Bytes are Base64 there, and null stands for NaN."""
    image, scan = typescript([Image]), typescript([LaserScan])

    assert "    data: Base64;" in image
    assert "    ranges: Real[];" in scan
    assert "export type Real = number | null;" in scan


def test_a_message_to_send_has_no_null() -> None:
    """The gateway refuses it in place of a number."""
    assert "export type Outgoing<T> = T extends null\n  ? never\n" in typescript([Twist])


def test_a_service_and_an_action_are_maps_of_their_parts() -> None:
    """A program uses the robot's name for the type."""
    text = typescript(
        [AddTwoInts, Fibonacci, String],
        topics={"/chatter": "std_msgs/msg/String", "/unknown": "other_msgs/msg/Unknown"},
        services={"/add": "example_interfaces/srv/AddTwoInts"},
    )

    assert (
        '  "/add": { request: example_interfaces.srv.AddTwoInts_Request; '
        "response: example_interfaces.srv.AddTwoInts_Response };"
    ) in text
    assert "goal: example_interfaces.action.Fibonacci_Goal" in text
    assert 'export interface Topics {\n  "/chatter": std_msgs.msg.String;\n}' in text


def test_constants_are_told_as_numbers() -> None:
    """A declaration has no values, so they are in the comment."""
    assert "   * byte ERROR = 2" in typescript([DiagnosticStatus])


def test_a_description_cannot_end_its_comment() -> None:
    """A node describes its own types: its text must not become code."""

    class Evil(Message, typename="evil_msgs/msg/Evil", by_name=False):
        """Nothing. */ export const stolen = 1; /*."""

        text: str = ""

    assert "*/ export" not in typescript([Evil])


def test_a_name_cannot_end_its_text() -> None:
    """A peer may announce any name."""
    text = typescript([String], topics={'/a": never; "b': "std_msgs/msg/String"})

    assert r'"/a\": never; \"b": std_msgs.msg.String;' in text
