"""A manager of nodes that knows only the wire format: Zenoh and its own CDR, without aionode.

It takes the nodes of `test_lifecycle` through every transition, error and refusal, and compares
their answers and messages with the tables of `rcl_lifecycle`. Two services of the test, also of the
type of `change_state`, tell the callbacks what to do, and check what was called. It prints each
step, and exits with an error if anything differs.
"""

from __future__ import annotations

import itertools
import os
import queue
import struct
import sys
import time  # noqa: TID251  # this program knows nothing of aionode
from typing import TYPE_CHECKING, Any

import zenoh  # noqa: TID251  # the same

if TYPE_CHECKING:
    from collections.abc import Iterable

DOMAIN = os.environ["ROS_DOMAIN_ID"]
PATIENCE_S = 100.0
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

REQUESTS = [one for one in TRANSITIONS if one[0] < 10]
"""The transitions that can be requested; the others are results of callbacks."""

LABELS = [
    *dict.fromkeys(one[1] for one in TRANSITIONS),
    *(STATES[number] for number in STATES),
    "fly",
    "Configure",
    " configure",
    "shutdown ",
    "1",
    "transition_callback_success",
    "konfigurieren für später",
]
"""All labels of transitions, and some that do not exist."""


def say(text: str) -> None:
    """Print a line at once."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


# CDR, little endian, aligned after its header of 4 bytes


class Reading:
    """Reads values in the order in which they are serialized."""

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
        """Return the next lifecycle_msgs/msg/State, whose label has to match."""
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
        self.events: queue.SimpleQueue[Any] = queue.SimpleQueue()
        topic = f"{DOMAIN}/*/transition_event/**"  # of all nodes
        self.subscriber = self.session.declare_subscriber(topic, self.events.put)
        time.sleep(0.5)  # Zenoh says nothing when a publisher has matched

    def tokens(self, node: str, *names: str) -> dict[str, list[str]]:
        """Wait for the tokens of a node's servers or publishers; return the chunks of each."""
        key = f"@ros2_lv/{DOMAIN}/*/*/*/*/*/*/{node}/**"
        wanted = {f"%{node}%{name}": name for name in names}
        ends = time.monotonic() + PATIENCE_S
        while time.monotonic() < ends:
            replies = [reply.ok for reply in self.session.liveliness().get(key, timeout=1.0)]
            tokens = [str(reply.key_expr).split("/") for reply in replies if reply is not None]
            found = {wanted[one[9]]: one for one in tokens if one[9:] and one[9] in wanted}
            if len(found) == len(names):
                return found
            time.sleep(0.01)
        raise AssertionError(f"{node} has not all of {names}")

    def data_key(self, chunks: list[str]) -> str:
        """Return the key of a topic or service, with type and hash from its token."""
        return f"{DOMAIN}/{chunks[9].replace('%', '/').strip('/')}/{chunks[10]}/{chunks[11]}"

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


SERVICES = (
    "change_state",
    "get_state",
    "get_available_states",
    "get_available_transitions",
    "get_transition_graph",
)


class Managed:
    """One managed node, through its services and its topic."""

    def __init__(self, peer: Peer, name: str) -> None:
        self.peer = peer
        self.name = name
        tokens = peer.tokens(name, *SERVICES, "transition_event")
        event = tokens.pop("transition_event")
        assert event[5] == "MP"
        assert event[10] == "lifecycle_msgs::msg::dds_::TransitionEvent_"
        assert event[12] == "::,10:,:,:,,"
        assert all(token[5] == "SS" for token in tokens.values())
        assert tokens["change_state"][10] == "lifecycle_msgs::srv::dds_::ChangeState_"
        self.keys = {service: peer.data_key(token) for service, token in tokens.items()}

    def call(self, service: str, request: bytes = EMPTY) -> Reading:
        """Call a service and wait for its reply."""
        return self.peer.end(self.peer.begin(self.keys[service], request))

    def state(self) -> int:
        """Return the answer of `get_state`."""
        return self.call("get_state").state()

    def transitions(self, service: str) -> list[tuple[int, str, int, int]]:
        """Return the transitions that a service lists."""
        reply = self.call(service)
        return [(*reply.transition(), reply.state(), reply.state()) for _ in range(reply.take("I"))]

    def begin(self, label: str = "", number: int = 0) -> queue.SimpleQueue[Any]:
        """Request a transition."""
        return self.peer.begin(self.keys["change_state"], change_request(number, label))

    def change(self, label: str = "", number: int = 0) -> bool:
        """Request a transition, and return whether it succeeded."""
        return bool(self.peer.end(self.begin(label, number)).take("B"))

    def take_events(self, count: int) -> list[tuple[int, int]]:
        """Wait for a number of events; return start and goal of each."""
        found = []
        for _ in range(count):
            sample = self.peer.events.get(timeout=PATIENCE_S)
            assert str(sample.key_expr).split("/")[1] == self.name
            event = Reading(sample.payload.to_bytes())
            assert event.take("Q") == 0
            assert event.transition() == (0, "")
            found.append((event.state(), event.state()))
        return found

    def expect_events(self, start: int, *states: int) -> None:
        """Expect the events of these state changes, and no further event."""
        assert self.take_events(len(states)) == list(itertools.pairwise((start, *states)))
        assert self.peer.events.empty()

    def expect_state(self, state: int) -> None:
        """Expect the node's answers in this state."""
        assert self.state() == state
        available = [one for one in TRANSITIONS if one[2] == state]
        assert self.transitions("get_available_transitions") == available
        assert self.transitions("get_transition_graph") == TRANSITIONS

    def expect_refused(self, requests: Iterable[tuple[str, int]]) -> None:
        """Make many requests at a time; expect that each is refused and changes nothing."""
        state = self.state()
        waiting = list(requests)
        while waiting:
            answers = [(one, self.begin(*one)) for one in waiting[:32]]
            del waiting[:32]
            for one, answer in answers:
                assert not self.peer.end(answer).take("B"), (STATES[state], one)
        self.expect_state(state)
        assert self.peer.events.empty()


class Stage:
    """The nodes of the test: one at a time, and a new one after one was finalized."""

    def __init__(self, peer: Peer) -> None:
        self.peer = peer
        tokens = peer.tokens("stage", "prepare", "check_calls")
        self.key = peer.data_key(tokens["prepare"])
        self.calls_key = peer.data_key(tokens["check_calls"])
        self.count = 0
        self.node = self.new_node()

    def tell(self, key: str, text: str) -> bool:
        """Call a service of the test."""
        return bool(self.peer.end(self.peer.begin(key, change_request(0, text))).take("B"))

    def new_node(self) -> Managed:
        """Replace the node by a new, unconfigured one."""
        self.count += 1
        name = f"managed_{self.count}"
        assert self.tell(self.key, f"node={name}")
        return Managed(self.peer, name)

    def begin(self, start: int, **script: str) -> Managed:
        """Bring a node to a primary state, where its callbacks follow the script."""
        if self.node.state() == 4:
            self.node = self.new_node()
        assert self.tell(self.key, "")  # on the way all callbacks succeed
        while (state := self.node.state()) != start:
            up = {1: "configure", 2: "activate"}
            down = {3: "deactivate", 2: "cleanup"}
            assert self.node.change((up if state < start else down)[state])
            self.node.take_events(2)
        assert self.tell(self.key, " ".join(f"{name}={what}" for name, what in script.items()))
        assert self.peer.events.empty()
        return self.node

    def expect_calls(self, start: int, *names: str) -> None:
        """Expect that these callbacks were called, each with its start state."""
        calls = " ".join(f"{name}:{STATES[start]}" for name in names)
        assert self.tell(self.calls_key, calls), calls


def goal_of(state: int, result: str) -> int:
    """Return the state to which the result of a callback leads."""
    label = f"transition_{result.lower()}"
    return next(one[3] for one in TRANSITIONS if one[1:3] == (label, state))


RESULTS = {
    "SUCCESS": "SUCCESS",
    "FAILURE": "FAILURE",
    "ERROR": "ERROR",
    "RAISE": "ERROR",  # an exception
    "NONE": "ERROR",  # something that is not a result
    "LOSE": "ERROR",  # what it awaits is canceled
}
"""The ways in which a callback may end, and the result that each counts as."""

HANDLINGS = {"ERROR": list(RESULTS), "RAISE": ["SUCCESS", "FAILURE", "ERROR", "RAISE"]}
"""The way in which `on_error` ends after that; after all others it succeeds."""


def make_transitions(stage: Stage) -> None:
    """Make each transition from each state, with every result of callbacks and of `on_error`."""
    for number, label, start, running in REQUESTS:
        for does, result in RESULTS.items():
            for handles in HANDLINGS.get(does, ["SUCCESS"]):
                say(f"{STATES[start]}: {label} [{number}] {does} {handles}")
                states = [running, goal_of(running, result)]
                calls = [label]
                if states[-1] == 15:
                    states.append(goal_of(15, RESULTS[handles]))
                    calls.append("error")
                node = stage.begin(start, **{label: does, "error": handles})
                assert node.change(number=number) is (result == "SUCCESS")
                node.expect_events(start, *states)
                node.expect_state(states[-1])
                stage.expect_calls(start, *calls)


def name_transitions(stage: Stage) -> None:
    """A label is enough, and takes precedence over any id."""
    for number, label, start, running in REQUESTS:
        for misleading in (0, 200, number, number % 7 + 1):
            say(f"{STATES[start]}: {label!r} [{misleading}]")
            node = stage.begin(start)
            assert node.change(label, misleading)
            node.expect_events(start, running, goal_of(running, "SUCCESS"))


def refuse_in_primary_states(stage: Stage) -> None:
    """All unavailable ids and labels are refused, also a label with an available id."""
    for start in (1, 2, 3, 4):
        say(f"{STATES[start]}: refusals")
        node = stage.begin(start if start < 4 else 1)
        if start == 4:
            assert node.change("shutdown")
            node.expect_events(1, 12, 4)
        possible = {one[0]: one[1] for one in TRANSITIONS if one[2] == start}
        node.expect_state(start)
        node.expect_refused(("", number) for number in range(256) if number not in possible)
        node.expect_refused(
            (label, number)
            for label in LABELS
            if label not in possible.values()
            for number in (0, *possible)
        )
        # Serialized data that ends too early, or has a string without an end.
        for data in (b"", b"\0\1\0\0", change_request(1, "configure")[:-4]):
            answers = node.peer.begin(node.keys["change_state"], data)
            assert answers.get(timeout=PATIENCE_S).ok is None
        node.expect_state(start)
        assert stage.peer.events.empty()


def refuse_in_transition(node: Managed) -> None:
    """In a transition state, only a shutdown or the callback's result can be requested."""
    available = [one for one in TRANSITIONS if one[2] == node.state()]
    ends = [] if node.state() == 15 else available[1:]  # failure and error
    numbers = {5, 6, 7, *(one[0] for one in ends)}
    labels = {"shutdown", *(one[1] for one in ends)}
    node.expect_refused(("", number) for number in range(256) if number not in numbers)
    node.expect_refused(
        (label, number) for label in LABELS if label not in labels for number in (0, *numbers)
    )


def end_transitions(stage: Stage) -> None:
    """End each transition while its callback runs, in each possible way."""
    for number, label, start, running in REQUESTS:
        ends = [one for one in TRANSITIONS if one[2] == running][1:]
        requests = [request for end in ends for request in (("", end[0]), (end[1], 0))]
        for refuse, end in enumerate([*requests, ("shutdown", 0), *(("", n) for n in (5, 6, 7))]):
            say(f"{STATES[running]}: {end[0]!r} [{end[1]}]")
            node = stage.begin(start, **{label: "WAIT"})
            request = node.begin(number=number)
            node.expect_events(start, running)
            node.expect_state(running)
            if not refuse:
                refuse_in_transition(node)
            result = "ERROR" if end in requests[2:] else "FAILURE"
            shut_down = end not in requests and running != 12
            success = node.change(*end)
            assert success is (end in requests or shut_down)
            assert not node.peer.end(request).take("B")
            states = [running, goal_of(running, result)]
            calls = [label]
            if states[-1] == 15:
                states.append(1)
                calls.append("error")
            if shut_down:  # from the state to which a failure leads
                states += [12, 4]
                calls.append("shutdown")
            node.expect_events(*states)
            node.expect_state(states[-1])
            stage.expect_calls(start, *calls)


def end_error_processing(stage: Stage) -> None:
    """While `on_error` runs only a shutdown can be requested, which finalizes the node at once."""
    for number, label, start, running in REQUESTS:
        say(f"errorprocessing of {label} [{number}]")
        node = stage.begin(start, **{label: "ERROR", "error": "WAIT"})
        request = node.begin(number=number)
        node.expect_events(start, running, 15)
        node.expect_state(15)
        if number == 1:
            refuse_in_transition(node)
        shutdown = ("shutdown", 0) if number < 5 else ("", number)
        assert not node.change(*shutdown)  # a finalized node cannot be shut down
        assert not node.peer.end(request).take("B")
        node.expect_events(15, 4)
        stage.expect_calls(start, label, "error")


def resist(stage: Stage) -> None:
    """A callback that handles its cancellation determines how the transition ends."""
    for number, label, start, running in REQUESTS:
        for does, result in (("KEEP", "SUCCESS"), ("SPOIL", "ERROR")):
            say(f"{STATES[running]}: {does}")
            node = stage.begin(start, **{label: does})
            request = node.begin(number=number)
            node.expect_events(start, running)
            node.change("transition_failure")
            assert bool(node.peer.end(request).take("B")) is (result == "SUCCESS")
            states = [running, goal_of(running, result)]
            if states[-1] == 15:
                states.append(1)
            node.expect_events(*states)
            node.expect_state(states[-1])
            stage.expect_calls(start, label, *(["error"] if 15 in states else []))


def manage(stage: Stage) -> None:
    """Take nodes through all steps."""
    states = stage.node.call("get_available_states")
    assert [states.state() for _ in range(states.take("I"))] == list(STATES)
    for part in (
        make_transitions,
        name_transitions,
        refuse_in_primary_states,
        end_transitions,
        end_error_processing,
        resist,
    ):
        began = time.monotonic()
        part(stage)
        say(f"{part.__name__}: {time.monotonic() - began:.1f} s, {stage.count} nodes so far")


def hurry(node: Managed, count: int) -> None:
    """Make a number of transitions in a row, each with its two events."""
    began = time.monotonic()
    for number in range(count):
        assert node.change(("configure", "activate", "deactivate", "cleanup")[number % 4])
    took_s = time.monotonic() - began
    goals = [goal for _, goal in node.take_events(2 * count)]
    assert goals == [10, 2, 13, 3, 14, 2, 11, 1] * (count // 4)
    say(f"{count / took_s:.0f} transitions/s")


if __name__ == "__main__":
    one = Peer()
    try:
        if sys.argv[1] == "all":
            manage(Stage(one))
        else:
            hurry(Managed(one, "managed"), int(sys.argv[1]))
        say("done")
    finally:
        one.session.close()
