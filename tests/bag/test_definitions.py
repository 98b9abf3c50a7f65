"""Type definitions in recordings are read in every language and with any names."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from aionode import bag
from aionode.bag import TopicInfo
from aionode.clock import Time
from aionode.engine.wire import cdr
from aionode.engine.wire.typehash import description_message, type_hash
from aionode.errors import InterfaceNotFoundError
from aionode.idl import define
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import local_context, settle

LINE = "=" * 80
IDL = f"""// Copyright of somebody
{LINE}
IDL: ublox/msg/NavPVT
// generated from rosidl_adapter/resource/msg.idl.em

#include "ublox/msg/Part.idl"

module ublox {{
  module msg {{
    @verbatim (language="comment", text="One; two {{" "\\n" "#include")
    struct NavPVT {{
      unsigned long iTOW;
      ublox::msg::Part part;
    }};
  }};
}};

{LINE}
IDL: ublox/msg/Part
#include "x.idl"
module ublox {{ module msg {{ typedef double d[2]; struct Part {{ string from; d x; }}; }}; }};
"""
MSG = f"""# The receiver's time.
uint32 iTOW
Part part
{LINE}
MSG: ublox/Part
string from
float64[2] x
"""


def info(encoding: str, definition: str, typename: str = "ublox/msg/NavPVT") -> TopicInfo:
    """Return a topic with a definition."""
    return TopicInfo(name="/fix", type=typename, encoding=encoding, definition=definition)


@pytest.mark.parametrize(("encoding", "text"), [("ros2msg", MSG), ("ros2idl", IDL)])
def test_names_that_ros_does_not_allow_are_read(encoding: str, text: str) -> None:
    """ROS 1 packages have such names; a Python keyword gets an underscore, as in rosbags."""
    made = info(encoding, text).msg_type
    message = made(iTOW=7)
    message.part.from_ = "gps"
    again = cdr.decode(made, cdr.encode(message))
    assert (again.iTOW, again.part.from_, list(again.part.x)) == (7, "gps", [0.0, 0.0])
    (part,) = description_message(made).referenced_type_descriptions
    assert [field.name for field in part.fields] == ["from", "x"]


@pytest.mark.parametrize("typename", ["demo/msg/speed", "Demo/msg/Speed2D_v"])
def test_types_whose_names_ros_does_not_allow_are_read(typename: str) -> None:
    """The robot that recorded them knows no other name."""
    package = typename.partition("/")[0]
    made = info(
        "ros2msg",
        f"float64 value\nother more\n{LINE}\nMSG: {package}/other\nint32 x\n",
        typename,
    ).msg_type
    assert cdr.decode(made, cdr.encode(made(value=2.5))).value == 2.5


@pytest.mark.slow
async def test_one_definition_that_cannot_be_read_costs_its_own_topic(tmp_path: Path) -> None:
    """`bag play` says why it is not played, and plays everything else."""
    odd = {
        "/nested": "module a { module msg { struct B { sequence<sequence<long>> x; }; }; };",
        "/deep": "module a {" * 5000,
        "/none": "",
        "/wide": "\n".join(f"int32 x{number}" for number in range(200_000)),
    }
    with bag.BagWriter(tmp_path / "run") as out:
        for name, text in odd.items():
            kind = "ros2msg" if name == "/wide" else "ros2idl"
            topic = TopicInfo(name=name, type="a/msg/B", encoding=kind, definition=text)
            topic.type_hash = name
            out.write(out.add_topic(topic), 10**9, b"\0\1\0\0\0\0\0\0")
        out.write_message("/words", String(data="hi"), Time(seconds=1))
    heard: list[str] = []
    async with local_context() as context, Node("ear", context=context) as node:
        node.create_subscription(String, "/words", lambda msg: heard.append(msg.data), 10)
        async with bag.Player(tmp_path / "run", context=context) as player:
            await settle()
            await player.play()
            assert player.played == 1
        await settle()
    assert heard == ["hi"]
    for name in odd:
        with bag.open(tmp_path / "run") as run, pytest.raises(InterfaceNotFoundError):
            _ = run.topics[name].msg_type


def test_a_type_of_a_recording_has_the_hash_that_ros_gives_it() -> None:
    """Playing it then reaches nodes of the robot that recorded it."""
    made: Any = define("a/msg/B", "string from\n", recorded=True)
    plain: Any = define("a/msg/B", "string origin\n")
    assert description_message(made).type_description.fields[0].name == "from"
    assert type_hash(made) != type_hash(plain)
