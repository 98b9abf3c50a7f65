"""What a visitor may do by the rules of the how-to: each verb on each kind of key, at a router.

The robot and the visitor are plain Zenoh sessions, so that only the router can refuse.
"""

from __future__ import annotations

import queue
from collections.abc import Iterator
from contextlib import ExitStack, closing, suppress
from pathlib import Path
from typing import Any

import pytest
import trustme
import zenoh  # noqa: TID251  # plays all participants, without aionode

from aionode.engine.transport.zenoh.connections.handlers import direct
from aionode.engine.transport.zenoh.delivery.acknowledgements import submessage_key
from aionode.engine.wire._key_expression import Side, side_key
from tests.end_to_end.test_security import CONFIGS, router, write
from tests.support.peers import free_ports

WAIT_S = 20.0
"""How long a test waits for what is allowed."""

AGAIN_S = 0.5
"""The interval at which it is said again."""

TYPE = "std_msgs::msg::dds_::String_/RIHS01_0"
SCAN, MAP, CHATTER = (f"7/{name}/{TYPE}" for name in ("scan", "map", "chatter"))
DOCK, OTHER = f"7/dock/{TYPE}", f"7/talker/get_parameters/{TYPE}"
DESCRIBE = f"7/talker/get_type_description/{TYPE}"
TALKER = "ab1"  # a context of the robot's
GID = bytes(16)


def data(key: str) -> str:
    """Return the key of HEARTBEAT, GAP and DATA of a topic."""
    return submessage_key(key, Side.PUBLISHERS, TALKER)


def acks(key: str) -> str:
    """Return the key of ACKNACK of a topic."""
    return submessage_key(key, Side.SUBSCRIPTIONS, TALKER)


def alive(key: str) -> str:
    """Return the key of assertions of liveliness of a topic."""
    return side_key(key, Side.PUBLISHERS, "alive")


def token(kind: str, node: str, name: str) -> str:
    """Return the token of an endpoint."""
    return f"@ros2_lv/7/{TALKER}/0/1/{kind}/%/%/{node}/{name}/{TYPE}/::,:,:,:,,"


def cancel(name: str) -> str:
    """Return the key of cancelled requests."""
    return f"@aionode/7/{TALKER}/cancel/{name}"


class Network:
    """A router, the robot, and the visitor.

    Subscribers are called in the reading thread, so that what was sent before a fence has arrived.

    Attributes:
        robot: The session of the robot, which may do everything.
        visitor: The session of the visitor.
    """

    def __init__(self, robot: zenoh.Session, visitor: zenoh.Session) -> None:
        self.robot = robot
        self.visitor = visitor
        self._to_robot: queue.Queue[Any] = queue.Queue()
        self._to_visitor: queue.Queue[Any] = queue.Queue()
        self._number = 0
        self._fences = [
            robot.declare_subscriber(SCAN, direct(self._to_robot.put)),
            visitor.declare_subscriber(MAP, direct(self._to_visitor.put)),
        ]

    def robot_has_heard(self) -> None:
        """Wait until the robot has everything from the visitor that the router has passed."""
        self._pass(self.visitor, SCAN, self._to_robot)

    def visitor_has_heard(self) -> None:
        """Wait until the visitor has everything from the robot that the router has passed."""
        self._pass(self.robot, MAP, self._to_visitor)

    def _pass(self, session: zenoh.Session, key: str, heard: queue.Queue[Any]) -> None:
        self._number += 1
        fence = f"fence {self._number}"
        for _ in range(round(WAIT_S / AGAIN_S)):
            session.put(key, fence)  # the first goes nowhere if the router knows no subscription
            with suppress(queue.Empty):
                while heard.get(timeout=AGAIN_S).payload.to_string() != fence:
                    pass
                return
        raise AssertionError(f"{fence} has not passed {key}")

    def settle(self) -> None:
        """Wait until the router knows what both have declared."""
        for _ in range(2):
            self.robot_has_heard()
            self.visitor_has_heard()


def opened(config: Path) -> zenoh.Session:
    """Return a session; connecting on a busy machine may take longer than Zenoh tries."""
    for _ in range(3):
        with suppress(zenoh.ZError):
            return zenoh.open(zenoh.Config.from_file(str(config)))
    return zenoh.open(zenoh.Config.from_file(str(config)))


@pytest.fixture(scope="module")
def network(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Network]:
    """A router with the rules of the how-to, and two sessions."""
    folder: Path = tmp_path_factory.mktemp("certs")
    authority = trustme.CA()
    authority.cert_pem.write_to_path(folder / "ca.pem")
    (port,) = free_ports(1)
    text = (CONFIGS / "session.json5").read_text(encoding="utf-8")
    text = text.replace("router.local:7448", f"localhost:{port}")
    configs = {}
    for name in ("router", "robot", "visitor"):
        write(folder, name, authority, common_name=name)
        configs[name] = folder / f"{name}.json5"
        own = text.replace("certs/robot", f"certs/{name}").replace("certs/", f"{folder}/")
        configs[name].write_text(own, encoding="utf-8")
    with ExitStack() as stack:
        stack.enter_context(router(folder, port))
        robot, visitor = (
            stack.enter_context(closing(opened(configs[name]))) for name in ("robot", "visitor")
        )
        network = Network(robot, visitor)
        network.settle()
        yield network


class Seen:
    """The keys of tokens that a session sees."""

    def __init__(self) -> None:
        self.keys: list[str] = []

    def note(self, sample: zenoh.Sample) -> None:
        """Take a token."""
        self.keys.append(str(sample.key_expr))


ALLOWED, REFUSED = True, False

PUTS = {
    "a message of its topic": (SCAN, ALLOWED),
    "HEARTBEAT, GAP and DATA of its topic": (data(SCAN), ALLOWED),
    "an assertion of its topic": (alive(SCAN), ALLOWED),
    "ACKNACK of a topic that it may hear": (acks(MAP), ALLOWED),
    "the end of its own request": (cancel("%dock"), ALLOWED),
    "a message of a topic that it may hear": (MAP, REFUSED),
    "a message of another topic": (CHATTER, REFUSED),
    "a message below its topic": (f"7/scan/raw/{TYPE}", REFUSED),
    "HEARTBEAT, GAP and DATA of another topic": (data(CHATTER), REFUSED),
    "HEARTBEAT, GAP and DATA of a topic that it may hear": (data(MAP), REFUSED),
    "ACKNACK of another topic": (acks(CHATTER), REFUSED),
    "ACKNACK of its topic": (acks(SCAN), REFUSED),
    "an assertion of another topic": (alive(CHATTER), REFUSED),
    "an assertion of a topic that it may hear": (alive(MAP), REFUSED),
    "the end of another's request": (cancel("%talker%get_parameters"), REFUSED),
    "what continues a link": (f"@aionode/7/{TALKER}/post", REFUSED),
    "an acknowledgement of version 1": (f"@aionode/7/{TALKER}/reliable/1", REFUSED),
    "a message of all topics": ("7/**", REFUSED),
}


@pytest.mark.parametrize("verb", ["put", "delete"])
@pytest.mark.parametrize("what", PUTS)
def test_a_visitor_says_only_what_its_rules_allow(network: Network, what: str, verb: str) -> None:
    """It may not delete anything either: no ROS message is a deletion."""
    key, is_allowed = PUTS[what]
    heard: list[zenoh.Sample] = []
    names = (key, "**", "**/@aionode/**", "@aionode/**") if "*" in key else (key,)
    subscribers = [network.robot.declare_subscriber(name, direct(heard.append)) for name in names]
    network.settle()
    heard.clear()
    if verb == "put":
        network.visitor.put(key, "lie")
    else:
        network.visitor.delete(key)
    network.robot_has_heard()
    for subscriber in subscribers:
        subscriber.undeclare()

    lies = [each for each in heard if each.payload.to_string() == ("lie" if verb == "put" else "")]
    assert bool(lies) is (is_allowed and verb == "put")


SUBSCRIBERS = {
    "a topic that it may hear": (MAP, ALLOWED),
    "HEARTBEAT, GAP and DATA of it": (data(MAP), ALLOWED),
    "ACKNACK of its topic": (acks(SCAN), ALLOWED),
    "another topic": (CHATTER, REFUSED),
    "its own topic": (SCAN, REFUSED),
    "HEARTBEAT, GAP and DATA of another topic": (data(CHATTER), REFUSED),
    "ACKNACK of another topic": (acks(CHATTER), REFUSED),
    "what continues a link": (f"@aionode/7/{TALKER}/post", REFUSED),
    "requests that were given up": (cancel("%dock"), REFUSED),
}


@pytest.mark.parametrize("what", SUBSCRIBERS)
def test_a_visitor_hears_only_what_its_rules_allow(network: Network, what: str) -> None:
    """Including retransmissions, which are messages as well."""
    key, is_allowed = SUBSCRIBERS[what]
    heard: list[zenoh.Sample] = []
    subscriber = network.visitor.declare_subscriber(key, direct(heard.append))
    network.settle()
    network.robot.put(key, "secret")
    network.visitor_has_heard()
    subscriber.undeclare()

    assert any(each.payload.to_string() == "secret" for each in heard) is is_allowed


def test_a_visitor_hears_nothing_by_a_wildcard(network: Network) -> None:
    """A rule for one topic refuses a subscriber for all of them."""
    heard: list[zenoh.Sample] = []
    names = ("**", "7/**", "@aionode/**", "**/@aionode/**", "*/*/*/*")
    subscribers = [network.visitor.declare_subscriber(name, direct(heard.append)) for name in names]
    network.settle()
    heard.clear()
    for key in (CHATTER, data(CHATTER), acks(CHATTER), f"@aionode/7/{TALKER}/post"):
        network.robot.put(key, "secret")
    network.visitor_has_heard()
    for subscriber in subscribers:
        subscriber.undeclare()

    assert not [each for each in heard if each.payload.to_string() == "secret"]


QUERIES = {
    "a service that it may call": (DOCK, ALLOWED),
    "the history of a topic that it may hear": (f"{MAP}/@adv/pub/ab1/1/_", ALLOWED),
    "parameters of another node": (OTHER, REFUSED),
    "the history of another topic": (f"{CHATTER}/@adv/pub/ab1/1/_", REFUSED),
    "which links there are": (f"@aionode/7/{TALKER}/links", REFUSED),
}


@pytest.mark.parametrize("what", QUERIES)
def test_a_visitor_asks_only_what_its_rules_allow(network: Network, what: str) -> None:
    """The robot does not even see the request."""
    key, is_allowed = QUERIES[what]
    asked: list[str] = []

    def answer(query: zenoh.Query) -> None:
        asked.append(str(query.key_expr))
        with query:
            query.reply(key, "answer")

    queryable = network.robot.declare_queryable(key, answer)
    network.settle()
    replies = [each.ok for each in network.visitor.get(key, timeout=0.3 if not is_allowed else 5)]
    network.robot_has_heard()
    queryable.undeclare()

    assert bool(asked) is is_allowed
    assert bool(replies and replies[0]) is is_allowed


ANSWERS = {
    "parameters of another node": OTHER,
    "the description of a type, for another node": DESCRIBE,
    "a service that it may call": DOCK,
    "the history of another topic": f"{CHATTER}/@adv/pub/ab1/1/_",
}


@pytest.mark.parametrize("what", ANSWERS)
def test_a_visitor_answers_for_no_other_node(network: Network, what: str) -> None:
    """It may declare the queryable, but gets no queries."""
    key = ANSWERS[what]

    def answer(query: zenoh.Query) -> None:
        with query:
            query.reply(key, "lie")

    queryable = network.visitor.declare_queryable(key, answer)
    network.settle()
    replies = list(network.robot.get(key, timeout=1))
    queryable.undeclare()

    assert not replies


TOKENS = {
    "its node": (f"@ros2_lv/7/{TALKER}/0/0/NN/%/%/visitor", ALLOWED),
    "a publisher of its topic": (token("MP", "visitor", "%scan"), ALLOWED),
    "a subscription that it may have": (token("MS", "visitor", "%map"), ALLOWED),
    "a client that it may have": (token("SC", "visitor", "%dock"), ALLOWED),
    "another node": (f"@ros2_lv/7/{TALKER}/0/0/NN/%/%/talker", REFUSED),
    "a publisher of another topic": (token("MP", "visitor", "%chatter"), REFUSED),
    "a publisher of another node": (token("MP", "talker", "%scan"), REFUSED),
    "another subscription": (token("MS", "visitor", "%chatter"), REFUSED),
    "a server": (token("SS", "visitor", "%dock"), REFUSED),
    "that a context acknowledges": (f"@aionode/7/{TALKER}/reliable/3", REFUSED),
    "a context that can be linked": (f"@aionode/7/{TALKER}/link/3/a/0", REFUSED),
    "that there are unannounced peers": (f"@aionode/7/{TALKER}/strangers", REFUSED),
}


@pytest.mark.parametrize("what", TOKENS)
def test_a_visitor_announces_only_what_its_rules_allow(network: Network, what: str) -> None:
    """Its own node, and the endpoints that this node may have."""
    key, is_allowed = TOKENS[what]
    seen = Seen()
    liveliness = network.robot.liveliness()
    subscribers = [
        liveliness.declare_subscriber(name, direct(seen.note))
        for name in ("@ros2_lv/**", "@aionode/**")
    ]
    network.settle()
    declared = network.visitor.liveliness().declare_token(key)
    network.settle()
    declared.undeclare()
    for subscriber in subscribers:
        subscriber.undeclare()

    assert (key in seen.keys) is is_allowed


def test_a_visitor_sees_the_graph(network: Network) -> None:
    """It has to find its peers, and names are not secret."""
    key = token("MS", "talker", "%scan")
    liveliness = network.visitor.liveliness()
    seen = Seen()
    subscriber = liveliness.declare_subscriber("@ros2_lv/**", direct(seen.note))
    network.settle()
    declared = network.robot.liveliness().declare_token(key)
    network.settle()
    found = [str(each.ok.key_expr) for each in liveliness.get("@ros2_lv/**") if each.ok]
    declared.undeclare()
    subscriber.undeclare()

    assert key in seen.keys
    assert key in found
