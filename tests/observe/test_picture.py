"""Pictures of the graph: what is in them, what does not match, and how they are drawn."""

from __future__ import annotations

from itertools import pairwise
from typing import Any
from xml.etree import ElementTree as ET

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import Node, ServerGoalHandle
from aionode.cli._nouns.graph import draw
from aionode.cli._support.output import Output
from aionode.errors import CommandError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.observe import (
    Edge,
    Picture,
    Vertex,
    difference,
    picture_of,
    to_dot,
    to_mermaid,
    to_svg,
    to_text,
)
from aionode.observe._drawing import layered, placed
from aionode.qos import QoSProfile, ReliabilityPolicy
from aionode.testing import local_context, settle


def execute(handle: ServerGoalHandle[Any, Any, Any]) -> Fibonacci.Result:
    """Execute a goal; none is sent here."""
    handle.succeed()
    return Fibonacci.Result()


@pytest.fixture
async def robot() -> Any:
    """A node that has one of each, and a subscription whose QoS does not fit."""
    async with Node("robot", context=local_context()) as node:
        unreliable = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        node.create_publisher(Int32, "numbers", unreliable)
        node.create_subscription(Int32, "numbers", lambda _: None, 1)
        node.create_service(Trigger, "reset", lambda _: Trigger.Response())
        node.create_action_server(Fibonacci, "count", execute)
        node.create_publisher(String, "words", 1)
        yield node


def test_a_picture_has_what_the_user_has_written(robot: Node) -> None:
    """An action is one thing, and neither the log nor parameter services are there."""
    picture = picture_of(robot.graph)

    assert [(vertex.kind, vertex.name) for vertex in picture.vertices] == [
        ("action", "/count"),
        ("node", "/robot"),
        ("service", "/reset"),
        ("topic", "/numbers"),
        ("topic", "/words"),
    ]
    assert "/rosout" in {
        vertex.name for vertex in picture_of(robot.graph, everything=True).vertices
    }


def test_what_does_not_match_has_its_reason(robot: Node) -> None:
    """It is drawn on the way to the node that does not receive."""
    (bad,) = [edge for edge in picture_of(robot.graph).edges if edge.mismatch]

    assert (bad.source, bad.target) == (("topic", "/numbers"), ("node", "/robot"))
    assert "reliability" in bad.mismatch.lower()
    assert "DOES NOT MATCH" in to_text(picture_of(robot.graph))


def test_names_choose_a_part(robot: Node) -> None:
    """With what it is connected with."""
    picture = picture_of(robot.graph, names=["words"])

    assert {vertex.name for vertex in picture.vertices} == {"/words", "/robot"}


def test_two_moments_are_compared(robot: Node) -> None:
    """New and missing parts are marked, and drawn in their colour."""
    before = picture_of(robot.graph, names=["/words"])
    after = picture_of(robot.graph, names=["/reset"])

    both = difference(before, after)

    changes = {vertex.name: vertex.change for vertex in both.vertices}
    assert changes == {"/robot": "", "/words": "gone", "/reset": "new"}
    assert difference(after, after) == after


async def test_the_command_draws_measures_and_saves(
    robot: Node, tmp_path: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its status says whether everything matches."""
    output, saved = Output(), tmp_path / "graph.json"

    status = await draw(robot, output=output, measure=True, duration=0.01, save=saved)
    await settle()
    assert status == 1
    assert "publishes /words [std_msgs/msg/String]  0 Hz" in capsys.readouterr().out
    assert await draw(robot, ["/words"], output=output, form="svg") == 0
    await draw(robot, output=output, since=saved)
    assert "+" not in capsys.readouterr().out.split("</svg>")[1]
    with pytest.raises(CommandError, match="nothing is named"):
        await draw(robot, ["/none"], output=output)
    saved.write_text("{}")
    with pytest.raises(CommandError, match="not a graph written by --save"):
        await draw(robot, output=output, since=saved)


NAMES = st.text(min_size=1, max_size=12)


@st.composite
def pictures(draw: st.DrawFn) -> Picture:
    """Draw any graph, circles included."""
    nodes = draw(st.lists(NAMES, unique=True, max_size=6))
    topics = draw(st.lists(NAMES, unique=True, max_size=6))
    pairs = [(("node", node), ("topic", topic)) for node in nodes for topic in topics]
    edges = (
        draw(st.lists(st.sampled_from([*pairs, *[pair[::-1] for pair in pairs]]), unique=True))
        if pairs
        else []
    )
    return msgspec.convert(
        {
            "vertices": [{"kind": "node", "name": name} for name in nodes]
            + [{"kind": "topic", "name": name, "types": ["a"]} for name in topics],
            "edges": [
                {
                    "source": source,
                    "target": target,
                    "mismatch": draw(st.sampled_from(["", "<&\x1b"])),
                }
                for source, target in edges
            ],
        },
        Picture,
    )


@given(pictures())
def test_any_graph_can_be_drawn(picture: Picture) -> None:
    """Whatever names others choose: the files can be read, and no two boxes lie on each other."""
    root = ET.fromstring(to_svg(picture))  # noqa: S314  # made one line above
    assert len(root.findall("{*}rect")) == len(picture.vertices) + 1
    assert to_dot(picture).count("->") >= len(picture.edges)
    assert len(to_mermaid(picture).splitlines()) >= 1 + len(picture.vertices) + len(picture.edges)
    to_text(picture)
    layers, chains = layered(picture)
    places = placed(layers)
    for layer in layers:
        for one, other in pairwise(layer):
            assert places[other][1] - places[one][1] >= 26
    assert all(len(chain) >= 2 for chain in chains)


def test_a_line_without_circles_goes_from_left_to_right() -> None:
    """As messages do."""
    picture = Picture(
        (Vertex("node", "/a"), Vertex("node", "/b"), Vertex("topic", "/t")),
        (Edge(("node", "/a"), ("topic", "/t")), Edge(("topic", "/t"), ("node", "/b"))),
    )

    places = placed(layered(picture)[0])

    assert places["node", "/a"][0] < places["topic", "/t"][0] < places["node", "/b"][0]
