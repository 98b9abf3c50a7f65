"""A program that manages nodes and knows only the wire format: Zenoh and its own CDR, no aionode.

It drives the nodes that `test_lifecycle` runs through every transition, error and refusal, and
compares what they answer and publish with the tables of `rcl_lifecycle`. It prints each step, and
ends with an error if anything is different.
"""

from __future__ import annotations

import os
import queue
import struct
import sys
import time  # noqa: TID251  # this program knows nothing of aionode
from typing import Any

import zenoh  # noqa: TID251  # the same

DOMAIN = os.environ["ROS_DOMAIN_ID"]
PATIENCE_S = 20.0
GID = bytes(range(16))

STATES = {
    0: "unknown",
    1: "unconfigured",
    2: "inactive",
    3: "active",
    4: "finalized",
    10: "configuring",
    11: "cleaningup",
    12: "shuttingdown",
    13: "activating",
    14: "deactivating",
    15: "errorprocessing",
}
OUTCOMES = ("transition_success", "transition_failure", "transition_error")


def outcomes(first: int, state: int, *goals: int) -> list[tuple[int, str, int, int]]:
    """Return the three results of a callback: number, label, start and goal."""
    return [(first + n, OUTCOMES[n], state, goal) for n, goal in enumerate(goals)]


TRANSITIONS = [
    (1, "configure", 1, 10),
    *outcomes(10, 10, 2, 1, 15),
    (2, "cleanup", 2, 11),
    *outcomes(20, 11, 1, 2, 15),
    (3, "activate", 2, 13),
    *outcomes(30, 13, 3, 2, 15),
    (4, "deactivate", 3, 14),
    *outcomes(40, 14, 2, 3, 15),
    (5, "shutdown", 1, 12),
    (6, "shutdown", 2, 12),
    (7, "shutdown", 3, 12),
    *outcomes(50, 12, 4, 4, 15),
    *outcomes(60, 15, 1, 4, 4),
]
"""Number, label, start and goal; in this order."""


def say(text: str) -> None:
    """Print a line at once."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


# CDR, little endian, aligned after its header of 4 bytes


class Reading:
    """Values in the order in which they are serialized."""

    def __init__(self, data: bytes) -> None:
        assert data[:4] == b"\0\1\0\0", data[:4]
        self.data = data[4:]
        self.at = 0

    def take(self, code: str) -> int:
        """Return the next number."""
        size = struct.calcsize("<" + code)
        self.at += -self.at % size
        (value,) = struct.unpack_from("<" + code, self.data, self.at)
        self.at += size
        return int(value)

    def text(self) -> str:
        """Return the next string."""
        size = self.take("I")
        self.at += size
        return self.data[self.at - size : self.at - 1].decode()

    def state(self) -> int:
        """Return the next lifecycle_msgs/msg/State, whose label has to fit."""
        number, label = self.take("B"), self.text()
        assert STATES[number] == label, (number, label)
        return number

    def transition(self) -> tuple[int, str]:
        """Return the next lifecycle_msgs/msg/Transition."""
        return self.take("B"), self.text()


def change_request(number: int, label: str) -> bytes:
    """Return a lifecycle_msgs/srv/ChangeState_Request."""
    text = label.encode() + b"\0"
    return b"\0\1\0\0" + struct.pack("<B3xI", number, len(text)) + text


EMPTY = b"\0\1\0\0\0"


class Peer:
    """A Zenoh session that calls services as rmw_zenoh_cpp does."""

    def __init__(self) -> None:
        config = zenoh.Config()
        ports = os.environ["AIONODE_MEETING_PORTS"].split(",")
        config.insert_json5("connect/endpoints", str([f"tcp/127.0.0.1:{port}" for port in ports]))
        config.insert_json5("connect/exit_on_failure", "false")
        config.insert_json5("connect/timeout_ms", "-1")
        config.insert_json5("listen/endpoints", '["tcp/127.0.0.1:0"]')
        config.insert_json5("scouting/multicast/enabled", "false")
        self.session = zenoh.open(config)
        self.sequence = 0

    def token(self, kind: str, name: str) -> list[str]:
        """Wait for a server's or publisher's token; return its chunks."""
        key = f"@ros2_lv/{DOMAIN}/*/*/*/{kind}/*/*/*/{name.replace('/', '%')}/**"
        ends = time.monotonic() + PATIENCE_S
        while time.monotonic() < ends:
            for reply in self.session.liveliness().get(key, timeout=1.0):
                if reply.ok is not None:
                    return str(reply.ok.key_expr).split("/")
            time.sleep(0.05)
        raise AssertionError(f"no {kind} token of {name}")

    def data_key(self, kind: str, name: str) -> str:
        """Return the key of a topic or service, whose type and hash the token tells."""
        chunks = self.token(kind, name)
        return f"{DOMAIN}/{name.strip('/')}/{chunks[10]}/{chunks[11]}"

    def begin(self, key: str, request: bytes) -> queue.SimpleQueue[Any]:
        """Send a request; the queue gets its reply."""
        self.sequence += 1
        extra = struct.pack("<qqB16s", self.sequence, time.time_ns(), 16, GID)
        answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self.session.get(
            key,
            answers.put,
            payload=request,
            attachment=extra,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=PATIENCE_S,
        )
        return answers

    def end(self, answers: queue.SimpleQueue[Any]) -> Reading:
        """Wait for a reply."""
        reply = answers.get(timeout=PATIENCE_S)
        assert reply.ok is not None, reply.err.payload.to_string()
        assert reply.ok.attachment.to_bytes()[17:] == GID
        return Reading(reply.ok.payload.to_bytes())


class Managed:
    """One managed node, by its services and its topic."""

    def __init__(self, peer: Peer, name: str) -> None:
        self.peer = peer
        self.name = name
        self.keys = {
            service: peer.data_key("SS", f"/{name}/{service}")
            for service in (
                "change_state",
                "get_state",
                "get_available_states",
                "get_available_transitions",
                "get_transition_graph",
            )
        }
        assert "lifecycle_msgs::srv::dds_::ChangeState_" in self.keys["change_state"]
        assert peer.token("MP", f"/{name}/transition_event")[12] == "::,10:,:,:,,"
        self.events: queue.SimpleQueue[Any] = queue.SimpleQueue()
        topic = peer.data_key("MP", f"/{name}/transition_event")
        assert "lifecycle_msgs::msg::dds_::TransitionEvent_" in topic
        self.subscriber = peer.session.declare_subscriber(topic, self.events.put)
        time.sleep(0.5)  # Zenoh says nothing when a publisher has matched

    def call(self, service: str, request: bytes = EMPTY) -> Reading:
        """Call a service and wait for its reply."""
        return self.peer.end(self.peer.begin(self.keys[service], request))

    def state(self) -> int:
        """Return what `get_state` answers."""
        return self.call("get_state").state()

    def transitions(self, service: str) -> list[tuple[int, str, int, int]]:
        """Return the transitions that a service lists."""
        reply = self.call(service)
        return [(*reply.transition(), reply.state(), reply.state()) for _ in range(reply.take("I"))]

    def begin(self, label: str = "", number: int = 0) -> queue.SimpleQueue[Any]:
        """Ask for a transition."""
        return self.peer.begin(self.keys["change_state"], change_request(number, label))

    def change(self, label: str = "", number: int = 0) -> bool:
        """Ask for a transition, and return whether that succeeded."""
        return bool(self.peer.end(self.begin(label, number)).take("B"))

    def take_events(self, count: int) -> list[tuple[int, int]]:
        """Wait for so many events; return start and goal of each."""
        found = []
        for _ in range(count):
            event = Reading(self.events.get(timeout=PATIENCE_S).payload.to_bytes())
            assert event.take("Q") == 0
            assert event.transition() == (0, "")
            found.append((event.state(), event.state()))
        return found

    def expect(self, label: str, success: bool, *states: int, number: int = 0) -> None:
        """Ask for a transition; expect its success, its states, and what is available then."""
        say(f"{self.name}: {label or number}")
        start = self.state()
        assert self.change(label, number) is success
        assert self.take_events(len(states)) == list(zip((start, *states), states, strict=False))
        end = states[-1] if states else start
        assert self.state() == end
        available = [one for one in TRANSITIONS if one[2] == end]
        assert self.transitions("get_available_transitions") == available
        assert self.events.empty()


def manage(node: Managed) -> None:
    """Take one node through everything; what its callbacks return is in `test_lifecycle`."""
    states = node.call("get_available_states")
    assert [states.state() for _ in range(states.take("I"))] == list(STATES)
    assert node.transitions("get_transition_graph") == TRANSITIONS

    # Refused: not available in this state, unknown, or by the number of another state.
    for label, number in (("activate", 0), ("fly", 0), ("", 3), ("", 6), ("", 200), ("", 10)):
        node.expect(label, False, number=number)
    # The label is looked at first, whatever the number says; without one the number counts.
    node.expect("configure", False, 10, 1, number=3)  # FAILURE
    node.expect("", False, 10, 15, 1, number=1)  # ERROR, and on_error returns SUCCESS
    node.expect("configure", False, 10, 15, 1)  # an exception

    # During a transition: states and transitions are told, requests refused, results requested.
    running = node.begin("configure")
    assert node.take_events(1) == [(1, 10)]
    assert node.state() == 10
    assert node.transitions("get_available_transitions") == TRANSITIONS[1:4]
    assert not node.change("activate")
    assert not node.change("transition_success")
    assert node.change("transition_failure")
    assert not node.peer.end(running).take("B")
    assert node.take_events(1) == [(10, 1)]

    node.expect("configure", True, 10, 2)
    node.expect("activate", False, 13, 2)  # FAILURE
    node.expect("activate", True, 13, 3)
    node.expect("deactivate", False, 14, 3)  # FAILURE
    node.expect("cleanup", False)
    node.expect("deactivate", True, 14, 2)
    node.expect("cleanup", False, 11, 2)  # FAILURE
    node.expect("cleanup", True, 11, 1)
    node.expect("configure", True, 10, 2)
    node.expect("activate", True, 13, 3)
    node.expect("deactivate", False, 14, 15, 4)  # ERROR, and on_error returns FAILURE
    for label in ("configure", "activate", "deactivate", "cleanup", "shutdown"):
        node.expect(label, False)  # nothing is available when finalized


def shut_down(peer: Peer) -> None:
    """Shut a node down from each state, with each result."""
    node = Managed(peer, "from_unconfigured")
    node.expect("", True, 12, 4, number=5)
    node = Managed(peer, "from_inactive")
    node.expect("configure", True, 10, 2)
    node.expect("", False, 12, 4, number=6)  # FAILURE leads to finalized, too
    node = Managed(peer, "from_active")
    node.expect("configure", True, 10, 2)
    node.expect("activate", True, 13, 3)
    node.expect("", False, 12, 15, 1, number=7)  # ERROR, and on_error returns SUCCESS
    node.expect("shutdown", True, 12, 4)


def hurry(node: Managed, count: int) -> None:
    """Make so many transitions one after the other, each with its two events."""
    began = time.monotonic()
    for number in range(count):
        assert node.change(("configure", "activate", "deactivate", "cleanup")[number % 4])
    took_s = time.monotonic() - began
    goals = [goal for _, goal in node.take_events(2 * count)]
    assert goals == [10, 2, 13, 3, 14, 2, 11, 1] * (count // 4)
    say(f"{count / took_s:.0f} transitions/s")


if __name__ == "__main__":
    one = Peer()
    if sys.argv[1] == "all":
        manage(Managed(one, "managed"))
        shut_down(one)
    else:
        hurry(Managed(one, "managed"), int(sys.argv[1]))
    say("done")
    one.session.close()
