"""The program that passes topics from one domain to another."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

import pytest

from aionode import (
    Context,
    DurabilityPolicy,
    Duration,
    HistoryPolicy,
    Node,
    QoSProfile,
    ReliabilityPolicy,
)
from aionode.interfaces.std_msgs.msg import String
from aionode.programs._domain_bridge.domain_bridge import Bridge, bridges_for, configured, main
from aionode.programs._domain_bridge.routes import Route, RouteError
from aionode.testing import settle

CONFIG = """
name: my_bridge
from_domain: 2
to_domain: 3
topics:
  clock:
    type: rosgraph_msgs/msg/Clock
  chatter:
    type: std_msgs/msg/String
    remap: robot/chatter
    qos:
      reliability: best_effort
      durability: transient_local
      history: keep_all
      depth: 5
      deadline: -1
      lifespan: 1000
      liveliness: automatic
  chatter:
    type: std_msgs/msg/String
    to_domain: 4
  back:
    type: std_msgs/msg/String
    reversed: true
  both:
    type: std_msgs/msg/String
    bidirectional: true
"""


@pytest.fixture
def write(tmp_path: Path) -> Callable[[str], str]:
    """Write a configuration."""

    def make(text: str) -> str:
        path = tmp_path / "a.yaml"
        path.write_text(text)
        return str(path)

    return make


def ways(routes: list[Route]) -> list[tuple[str, int, int, str]]:
    """Return the topics and their domains."""
    return [(route.topic, route.source, route.target, route.renamed) for route in routes]


def test_topics_go_where_the_configuration_says(write: Callable[[str], str]) -> None:
    """A topic may occur several times, as in the example of the original."""
    name, routes = configured([write(CONFIG)])

    assert name == "my_bridge"
    assert ways(routes) == [
        ("/clock", 2, 3, "/clock"),
        ("/chatter", 2, 3, "/robot/chatter"),
        ("/chatter", 2, 4, "/chatter"),
        ("/back", 3, 2, "/back"),
        ("/both", 2, 3, "/both"),
        ("/both", 3, 2, "/both"),
    ]
    assert routes[1].qos == {
        "reliability": ReliabilityPolicy.BEST_EFFORT,
        "durability": DurabilityPolicy.TRANSIENT_LOCAL,
        "history": HistoryPolicy.KEEP_ALL,
        "depth": 5,
        "deadline": -1,
        "lifespan": 1000,
    }


def test_arguments_take_precedence(write: Callable[[str], str]) -> None:
    """They apply to topics that go back as well."""
    options = ["--from", "7", "--to", "8", "--wait-for-publisher", "false", "--auto-remove", "true"]
    _, routes = configured([*options, "--wait-for-subscription", "true", write(CONFIG)])

    assert {(route.source, route.target) for route in routes} == {(7, 8), (8, 7)}
    first = routes[0]
    assert (first.waits_for_publisher, first.waits_for_subscription) == (False, True)
    assert first.is_removed


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("    type: rosgraph_msgs/msg/Clock", "    a: b", "missing 'type' for topic 'clock'"),
        ("from_domain: 2", "", "'from_domain' of topic 'clock' is None; use a domain id from 0"),
        ("to_domain: 3", "to_domain: 500", "is 500; use a domain id from 0 to 232"),
        ("to_domain: 3", "to_domain: 2", "Cannot bridge topic '/clock' from domain 2 to domain 2"),
        ("best_effort", "fast", "unsupported reliability policy value 'fast'"),
        ("best_effort", "[fast]", r"unsupported reliability policy value \['fast'\]"),
        ("depth: 5", "depth: 0", "unsupported depth policy value 0"),
        ("deadline: -1", f"deadline: {2**63}", "unsupported deadline policy value 92233"),
        ("lifespan: 1000", "lifespan: soon", "unsupported lifespan policy value 'soon'"),
        ("lifespan: 1000", "colour: red", "unsupported colour policy value 'red'"),
        ("automatic", "manual_by_topic", "unsupported liveliness policy value 'manual_by_topic'"),
        (
            "name: my_bridge",
            "mode: compress",
            "mode 'compress' is not available here; use 'normal'",
        ),
        ("remap: robot/chatter", "remap: a//b", "a//b"),
        (CONFIG, "- a", "expected a map with 'topics'"),
        (CONFIG, "topics: []", "expected map value for 'topics'"),
        (CONFIG, "topics: {a: b}", "expected map value for each topic"),
        (CONFIG, "topics: {a: {type: b, from_domain: 1, to_domain: 2, qos: []}}", "for 'qos'"),
        (CONFIG, "? [a]\n: b", "there are no topics in the configuration"),
        (CONFIG, "a: [", "error parsing the file"),
        (CONFIG, "a: b", "there are no topics in the configuration"),
    ],
)
def test_a_configuration_that_cannot_be_used_says_why(
    write: Callable[[str], str], old: str, new: str, problem: str
) -> None:
    """Somebody wrote it by hand."""
    with pytest.raises(RouteError, match=problem):
        configured([write(CONFIG.replace(old, new))])


def test_the_program_ends_with_the_reason(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """As others do."""
    monkeypatch.setattr("sys.argv", ["domain_bridge", "/nowhere.yaml"])

    with pytest.raises(SystemExit, match="1"):
        main()

    assert "error parsing the file '/nowhere.yaml'" in capsys.readouterr().err


class Domains:
    """Two domains, with a node of the bridge and one of a robot in each."""

    def __init__(self, nodes: dict[int, Node], others: dict[int, Node]) -> None:
        self.nodes, self.others = nodes, others
        self.heard: list[tuple[int, str]] = []
        self.bridges: list[Bridge] = []

    def listen(self, domain: int, topic: str, qos: QoSProfile | int = 10) -> None:
        """Record what arrives in a domain."""
        self.others[domain].create_subscription(
            String, topic, lambda msg: self.heard.append((domain, msg.data)), qos
        )

    def publisher(self, domain: int, topic: str, qos: QoSProfile | int = 10) -> Any:
        """Create a publisher in a domain."""
        return self.others[domain].create_publisher(String, topic, qos)

    async def bridge(self, *routes: Route) -> None:
        """Create the bridges that are due."""
        self.bridges = bridges_for(routes, self.nodes)
        await self.check()

    async def check(self) -> None:
        """Look for publishers and subscriptions, as the timers of the program do."""
        for _ in range(5):
            for bridge in self.bridges:
                await bridge.check()
        await settle()


@pytest.fixture
async def domains() -> AsyncIterator[Domains]:
    """Open two domains."""
    async with (
        Context(domain_id=2, transport="local") as two,
        Context(domain_id=3, transport="local") as three,
        Node("bridge_2", context=two) as node_2,
        Node("bridge_3", context=three) as node_3,
        Node("robot", context=two) as robot_2,
        Node("robot", context=three) as robot_3,
    ):
        yield Domains({2: node_2, 3: node_3}, {2: robot_2, 3: robot_3})


def route(topic: str = "/chatter", renamed: str = "", **more: Any) -> Route:
    """Return the route of a topic from 2 to 3."""
    return Route(topic, "std_msgs/msg/String", 2, 3, renamed or topic, **more)


async def test_messages_reach_the_other_domain_under_their_other_name(domains: Domains) -> None:
    """Nothing goes back."""
    publisher = domains.publisher(2, "/chatter")
    domains.listen(3, "/robot/chatter")
    await domains.bridge(route(renamed="/robot/chatter"))

    publisher.publish(String(data="hello"))
    await settle()

    assert domains.heard == [(3, "hello")]


async def test_a_topic_of_both_directions_does_not_return_to_its_sender(domains: Domains) -> None:
    """It would circulate forever."""
    one, other = domains.publisher(2, "/chatter"), domains.publisher(3, "/chatter")
    for domain in (2, 3):
        domains.listen(domain, "/chatter")
    await domains.bridge(*route(is_bidirectional=True).ways())

    one.publish(String(data="hello"))
    await settle()
    other.publish(String(data="hi"))
    await settle()

    assert sorted(domains.heard) == [(2, "hello"), (2, "hi"), (3, "hello"), (3, "hi")]


async def test_the_bridge_waits_for_a_publisher(domains: Domains) -> None:
    """Its QoS is needed: the subscription here is incompatible with the default."""
    await domains.bridge(route())
    assert domains.bridges[0].output is None

    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    domains.publisher(2, "/chatter", latched).publish(String(data="map"))
    await domains.check()
    domains.listen(3, "/chatter", latched)
    await settle()

    assert domains.heard == [(3, "map")]


async def test_a_bridge_that_does_not_wait_is_there_at_once(domains: Domains) -> None:
    """With the usual QoS."""
    await domains.bridge(route(waits_for_publisher=False))

    assert domains.bridges[0].output is not None


async def test_a_bridge_may_end_with_what_it_waited_for(domains: Domains) -> None:
    """It comes back with it."""
    publisher = domains.publisher(2, "/chatter")
    await domains.bridge(route(is_removed=True))
    assert domains.nodes[3].count_publishers("/chatter") == 1
    publisher.destroy()
    await domains.check()
    assert domains.nodes[3].count_publishers("/chatter") == 0

    domains.publisher(2, "/chatter")
    await domains.check()

    assert domains.nodes[3].count_publishers("/chatter") == 1


async def test_a_bridge_may_wait_for_a_subscription(domains: Domains) -> None:
    """Nothing is sent that nobody wants."""
    domains.publisher(2, "/chatter")
    await domains.bridge(route(waits_for_subscription=True))
    assert domains.bridges[0].output is None

    domains.listen(3, "/chatter")
    await domains.check()

    assert domains.bridges[0].output is not None


async def test_publishers_of_several_kinds_get_what_fits_all(
    domains: Domains, caplog: pytest.LogCaptureFixture
) -> None:
    """Given policies take precedence."""
    domains.publisher(2, "/chatter", QoSProfile(depth=1, deadline=Duration(seconds=2)))
    domains.publisher(2, "/chatter", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
    await domains.bridge(route(qos={"depth": 3, "lifespan": 10**9, "deadline": -1}))
    output = domains.bridges[0].output
    assert output is not None

    assert output.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert output.qos_profile.depth == 3
    assert output.qos_profile.lifespan == Duration(seconds=1)
    assert "offer 'reliable' reliability. Falling back to 'best effort'" in caplog.text


async def test_a_type_that_nobody_knows_is_named_once(
    domains: Domains, caplog: pytest.LogCaptureFixture
) -> None:
    """It may come with a node that describes it."""
    unknown = Route("/a", "nowhere_msgs/msg/Thing", 2, 3, "/a", waits_for_publisher=False)
    await domains.bridge(unknown)
    await domains.check()

    assert domains.bridges[0].output is None
    assert caplog.text.count("nowhere_msgs/msg/Thing") == 1


async def test_a_type_that_nobody_knows_is_asked_for_once_a_second(
    domains: Domains, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every node that uses the type is asked, and the check runs ten times a second."""
    unknown = Route("/a", "nowhere_msgs/msg/Thing", 2, 3, "/a", waits_for_publisher=False)
    await domains.bridge(unknown)
    asked = []

    async def find_message(name: str) -> Any:
        asked.append(name)
        raise LookupError(name)

    monkeypatch.setattr(domains.bridges[0].source, "find_message", find_message)
    for _ in range(20):
        await domains.bridges[0].check()

    assert len(asked) == 2
