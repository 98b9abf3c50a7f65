"""The attackers' programs; each function runs for some seconds and returns its attempts.

``python -m tests.attacks.programs NAME SECONDS PID…`` runs one in a process of its own against the
processes with these ids. It prints ``begun`` when it has a session, and ``tries N`` at its end.
"""

from __future__ import annotations

import os
import random
import socket
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress

import psutil
import zenoh  # plays another participant, without aionode
from msgspec.structs import replace

from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.link._continuation import STOPS, seal
from aionode.engine.transport.reliability import submessage as acknack
from aionode.engine.transport.reliability.submessage import SubmessageKind
from aionode.engine.transport.zenoh.session.local_sessions import announce
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.graph import EndpointInfo, EndpointKind
from aionode.interfaces.rcl_interfaces.msg import Parameter, ParameterValue
from aionode.interfaces.rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.type_description_interfaces.srv import GetTypeDescription
from aionode.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile
from tests.attacks.gateway_clients import GATEWAY_PROGRAMS
from tests.attacks.liar import Liar, lying, pace
from tests.attacks.lies import LIES, describe, nested_type
from tests.support.peers import raw_session

__all__ = ["FORGED", "PROGRAMS"]

FORGED = "forged"
"""Marks messages that pretend to be from another node."""

FAR = 2**62

FILLED_S = 4.0
"""The seconds after which a publisher keeps as much for late readers as it can."""

LIES_PER_S = 100
"""How many lies of a fuzzer there are in each second."""

SIGNS = "\x1b\x9b\x07\r\x00\u202e"
"""Characters that a terminal or a reader of a log would take for something other than text."""

Program = Callable[[float, Sequence[int]], int]


def member(lie: Callable[[Liar, float], int]) -> Program:
    """Return the program of an attacker with a session."""

    def run(seconds: float, _: Sequence[int]) -> int:
        with lying() as liar:
            tries = lie(liar, seconds)
            liar.drop()
        return tries

    return run


def begun() -> None:
    """Tell that the attack begins."""
    print("begun", flush=True)  # noqa: T201 - a program


def ends(liar: Liar) -> tuple[EndpointInfo, EndpointInfo]:
    """Return the talker and the listener of the legitimate messages."""
    (talker,) = liar.endpoints(EndpointKind.PUBLISHER, "/chatter")
    (listener,) = liar.endpoints(EndpointKind.SUBSCRIPTION, "/chatter")
    return talker, listener


def forged_text(number: int) -> str:
    """Return the text of a forged message, in the form of the legitimate ones."""
    return f"{FORGED} 0 {number} {time.monotonic()} "


# Nobody, or another user of the host


def wait(seconds: float, _: Sequence[int]) -> int:
    """Do nothing."""
    begun()
    time.sleep(seconds)
    return 0


def send_garbage(seconds: float, pids: Sequence[int]) -> int:
    """Send random bytes to each port on which the nodes listen."""
    listening = [
        each.laddr
        for pid in pids
        for each in psutil.Process(pid).net_connections(kind="tcp")
        if each.status == psutil.CONN_LISTEN
    ]
    begun()
    for number in pace(seconds, 200):
        with suppress(OSError), socket.create_connection(listening[number % len(listening)]) as one:
            one.sendall(os.urandom(random.choice((1, 30, 3000, 60_000))))
    return number + 1


def keep_connections(seconds: float, pids: Sequence[int]) -> int:
    """Connect to each port on which the nodes listen, and send nothing."""
    listening = [
        each.laddr
        for pid in pids
        for each in psutil.Process(pid).net_connections(kind="tcp")
        if each.status == psutil.CONN_LISTEN
    ]
    begun()
    with ExitStack() as held:
        for number in pace(seconds, 50):
            with suppress(OSError):
                held.enter_context(socket.create_connection(listening[number % len(listening)]))
    return number + 1


def pretend_sessions(seconds: float, _: Sequence[int]) -> int:
    """As another user, occupy all connect slots, and register 200 false sessions on the machine."""
    os.setgid(65534)
    os.setuid(65534)
    ports = [int(port) for port in os.environ["AIONODE_MEETING_PORTS"].split(",")]
    begun()
    with ExitStack() as held:
        for port in ports:
            turn = held.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            with suppress(OSError):
                turn.bind(("127.0.0.1", port))
        for number in range(200):
            held.enter_context(announce(ports[0], 20_000 + number))
        time.sleep(seconds)
    return 200 + len(ports)


# Members: messages in the name of others


def forge_data(liar: Liar, seconds: float) -> int:
    """Send DATA and plain messages in the talker's name, on keys of both topics."""
    talker, listener = ends(liar)
    own_key = liar.submessage_key(SubmessageKind.DATA, replace(talker, name="/scan"), listener)
    begun()
    # Whatever number the listener expects next is among them.
    for number in pace(seconds, 2000):
        payload = cdr.encode(String(data=forged_text(number)))
        fields = number + 1, time.time_ns(), payload
        liar.submessage(SubmessageKind.DATA, talker, listener, *fields)
        data = acknack.pack(SubmessageKind.DATA, talker.gid, listener.gid, *fields)
        liar.put(own_key, data)
        liar.publish("/chatter", String(data=forged_text(number)), number + 1, talker.gid)
    return 3 * (number + 1)


def post_batch(liar: Liar, seconds: float) -> int:
    """Send messages in the talker's name as if its link had failed to deliver them."""
    talker, listener = ends(liar)
    begun()
    for number in pace(seconds, 100):
        payload = cdr.encode(String(data=forged_text(number)))
        for kind, batch in ((protocol.Kind.DATA, number + 1), (protocol.Kind.STOP, STOPS)):
            frame = protocol.pack(kind, number + 100_000, time.time_ns(), talker.gid, payload)
            done = protocol.RetransmitDone().pack() if batch else b""
            liar.post(listener, seal(os.urandom(protocol.SECRET_SIZE), batch, frame + done))
    return number + 1


def move_reader(kind: SubmessageKind) -> Callable[[Liar, float], int]:
    """Return an attack that tells a reader that messages up to 2^62 were or will not be sent."""

    def lie(liar: Liar, seconds: float) -> int:
        talker, listener = ends(liar)
        begun()
        rest = talker.node.participant.encode() if kind is SubmessageKind.HEARTBEAT else b""
        for _ in pace(seconds, 1):
            # Those before `first` are not for this reader, or those up to `last` are not sent.
            first = FAR if kind is SubmessageKind.HEARTBEAT else 1
            liar.submessage(kind, talker, listener, first, FAR, rest)
        return int(seconds)

    return lie


def send_absurd_submessages(liar: Liar, seconds: float) -> int:
    """Send many ACKNACKs in the listener's name, and data that is not a submessage."""
    talker, listener = ends(liar)
    begun()
    chance = random.Random(1)
    tries = 0
    for _ in pace(seconds, 1000):
        tries += 2
        first = chance.choice((-FAR, -1, 0, 1, FAR, 2**63 - 1))
        rest = chance.randbytes(chance.choice((0, 7, 16, 160, 1600)))
        liar.submessage(SubmessageKind.ACKNACK, talker, listener, first, 0, rest)
        liar.put(
            liar.submessage_key(SubmessageKind.ACKNACK, talker, listener), chance.randbytes(64)
        )
    return tries


def send_damaged(liar: Liar, seconds: float) -> int:
    """Publish invalid messages with attachments of others, of nobody, and in no valid form."""
    ends(liar)
    begun()
    chance = random.Random(1)
    for number in pace(seconds, 2000):
        gid = chance.choice((chance.randbytes(16), bytes(16)))
        extra = chance.choice((None, chance.randbytes(33), attachment.pack(number, 0, gid)))
        size = chance.choice((0, 3, 4, 40, 4000))
        liar.put(liar.key("/chatter", String), b"\x00\x01\x00\x00" + chance.randbytes(size), extra)
    return number + 1


# Members: what is asked of a node


def ask_for_one_name(liar: Liar, seconds: float) -> int:
    """Request a parameter of 100 kB 40 000 times in one request, repeatedly."""
    liar.endpoints(EndpointKind.SERVER, "/talker/get_parameters")
    names = ["large"] * 40_000
    begun()
    for _ in pace(seconds, 2):
        liar.ask("/talker/get_parameters", GetParameters, GetParameters.Request(names=names))
        liar.ask(
            "/talker/describe_parameters",
            DescribeParameters,
            DescribeParameters.Request(names=names),
        )
    return 4 * int(seconds)


def send_damaged_requests(liar: Liar, seconds: float) -> int:
    """Send invalid requests."""
    liar.endpoints(EndpointKind.SERVER, "/talker/get_parameters")
    begun()
    chance = random.Random(1)
    for number in pace(seconds, 200):
        request = b"\x00\x01\x00\x00" + chance.randbytes(chance.choice((0, 3, 40, 4000)))
        liar.ask("/talker/get_parameters", GetParameters, request)
        if number % 100 == 99:
            liar.drop()
    return number + 1


def ask_and_read_nothing(liar: Liar, seconds: float) -> int:
    """Query the 10 MB that a publisher keeps for late readers four times, and read no answer."""
    liar.endpoints(EndpointKind.PUBLISHER, "/kept")
    time.sleep(FILLED_S)
    begun()
    ends_s = time.monotonic() + seconds

    def read_nothing(_: zenoh.Reply) -> None:
        time.sleep(max(0.0, ends_s - time.monotonic()))  # in the thread that reads

    with ExitStack() as sessions:
        for number in range(4):
            session = sessions.enter_context(raw_session())
            time.sleep(0.2)  # until it is connected
            unread = zenoh.handlers.Callback(read_nothing, indirect=False)
            session.get(f"{liar.key('/kept', String)}/@adv/**?_anyke", unread, timeout=60.0)
            if number == 3:
                time.sleep(max(0.0, ends_s - time.monotonic()))
    return 4


def ask_everything(liar: Liar, seconds: float) -> int:
    """Request as much as fits into a request from every built-in service."""
    liar.endpoints(EndpointKind.SERVER, "/talker/get_parameters")
    names = ["large"] * 1_000
    values = [ParameterValue(type=4, string_value=str(number)) for number in range(2_000)]
    some = [Parameter(name="large", value=value) for value in values]
    whole = GetTypeDescription.Request(type_name="std_msgs/msg/String", include_type_sources=True)
    requests = (
        ("get_parameters", GetParameters, GetParameters.Request(names=names)),
        ("get_parameter_types", GetParameterTypes, GetParameterTypes.Request(names=names)),
        ("describe_parameters", DescribeParameters, DescribeParameters.Request(names=names)),
        ("list_parameters", ListParameters, ListParameters.Request(prefixes=names)),
        ("set_parameters", SetParameters, SetParameters.Request(parameters=some)),
        (
            "set_parameters_atomically",
            SetParametersAtomically,
            SetParametersAtomically.Request(parameters=some),
        ),
        ("get_type_description", GetTypeDescription, whole),
    )
    begun()
    for number in pace(seconds, 10):
        service, interface, request = requests[number % len(requests)]
        liar.ask(f"/talker/{service}", interface, request)
    return number + 1


def ask_largely(liar: Liar, seconds: float) -> int:
    """Send 20 requests of 1 MB a second, and read none of the answers."""
    liar.endpoints(EndpointKind.SERVER, "/talker/get_parameters")
    key = liar.key("/talker/get_parameters", GetParameters)
    payload = cdr.encode(GetParameters.Request(names=["large", "x" * 1_000_000]))
    begun()
    ends_s = time.monotonic() + seconds

    def read_nothing(_: zenoh.Reply) -> None:
        time.sleep(max(0.0, ends_s - time.monotonic()))  # in the thread that reads

    unread = zenoh.handlers.Callback(read_nothing, indirect=False)
    for number in pace(seconds, 20):
        extra = attachment.pack(number + 1, time.time_ns(), os.urandom(16))
        liar.session.get(key, unread, payload=payload, attachment=extra, timeout=60.0)
    return number + 1


# Members: what is announced


def subscribe_oddly(liar: Liar, seconds: float) -> int:
    """Subscribe 2000 times to a topic with a QoS profile that does not fit."""
    liar.be_node()
    begun()
    odd = QoSProfile(
        depth=10,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
    )
    return subscribe(liar, seconds, 2000, odd)


def subscribe_often(liar: Liar, seconds: float) -> int:
    """Subscribe 5000 times to a topic."""
    liar.be_node()
    begun()
    return subscribe(liar, seconds, 5000, QoSProfile(depth=10))


def subscribe(liar: Liar, seconds: float, most: int, qos: QoSProfile) -> int:
    """Subscribe to the true messages, evenly over the time."""
    for number in pace(seconds, most / (seconds - 1)):
        if number == most:
            break
        liar.announce(EndpointKind.SUBSCRIPTION, "/chatter", String, qos)
    return number


def flood_graph(liar: Liar, seconds: float) -> int:
    """Announce 10 000 publishers of as many topics, and withdraw them."""
    liar.be_node()
    begun()
    for number in pace(seconds, 10_000 / (seconds - 1)):
        if number == 10_000:
            break
        liar.announce(EndpointKind.PUBLISHER, f"/topic_{number}", String)
    return number


def announce_escapes(liar: Liar, seconds: float) -> int:
    """Announce nodes, topics and types with terminal escape sequences in their names."""
    begun()
    for number in range(200):
        text = f"{SIGNS[number % len(SIGNS)]}]0;owned\n{number}"
        liar.node = replace(liar.node, node_id=number)
        for announce_one in (
            lambda text=text: liar.be_node(f"node{text}"),
            lambda text=text: liar.announce(EndpointKind.PUBLISHER, f"/chatter{text}", String),
            lambda text=text: liar.hold(
                liar.token(EndpointKind.PUBLISHER, "/chatter", f"p/msg/T{text}", hash_text="RIHS")
            ),
        ):
            with suppress(zenoh.ZError):  # some signs Zenoh refuses itself
                announce_one()
    time.sleep(seconds)
    return 600


def never_acknowledge(liar: Liar, seconds: float) -> int:
    """Subscribe with KEEP_ALL as an acknowledging context, and never acknowledge anything."""
    liar.be_node()
    begun()
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    liar.announce(EndpointKind.SUBSCRIPTION, "/clouds", String, keep_all)
    time.sleep(seconds)
    return 1


def flood_topic(liar: Liar, seconds: float) -> int:
    """Publish messages of 500 kB on a topic whose callback takes long."""
    liar.be_node()
    gid = liar.announce(EndpointKind.PUBLISHER, "/work", String)
    begun()
    filler = "x" * 500_000
    for number in pace(seconds, 40):
        liar.publish("/work", String(data=f"{forged_text(number)}{filler}"), number + 1, gid)
    return number + 1


# Members: types


def describe_absurdly(levels: int, fields: int, capacity: int) -> Callable[[Liar, float], int]:
    """Return an attack that gives an absurd description of a topic's type."""

    def lie(liar: Liar, seconds: float) -> int:
        liar.be_node()
        describe(liar, "/words", nested_type(levels, fields, capacity))
        begun()
        time.sleep(seconds)
        return 1

    return lie


def lie_randomly(liar: Liar, seconds: float) -> int:
    """Send well-formed lies with absurd values, of the kinds that the environment names."""
    ends(liar)
    liar.be_node()
    seed, *kinds = os.environ["AIONODE_LIES"].split()
    chance = random.Random(int(seed))
    begun()
    lies = [LIES[chance.choice(kinds)](liar, chance) for _ in pace(seconds, LIES_PER_S)]
    return len(lies)


PROGRAMS: dict[str, Program] = {
    **GATEWAY_PROGRAMS,
    "wait": wait,
    "send_garbage": send_garbage,
    "keep_connections": keep_connections,
    "pretend_sessions": pretend_sessions,
    "heartbeat": member(move_reader(SubmessageKind.HEARTBEAT)),
    "gap": member(move_reader(SubmessageKind.GAP)),
    "describe_deep": member(describe_absurdly(30, 2, 0)),
    "describe_large": member(describe_absurdly(1, 1, 2**37)),
    **{
        each.__name__: member(each)
        for each in (
            forge_data,
            post_batch,
            send_absurd_submessages,
            send_damaged,
            ask_for_one_name,
            send_damaged_requests,
            ask_and_read_nothing,
            ask_largely,
            subscribe_oddly,
            subscribe_often,
            flood_graph,
            announce_escapes,
            never_acknowledge,
            flood_topic,
            ask_everything,
            lie_randomly,
        )
    },
}


def main() -> None:
    """Run as a program."""
    name, seconds, *pids = sys.argv[1:]
    tries = PROGRAMS[name](float(seconds), [int(pid) for pid in pids])
    print(f"tries {tries}", flush=True)  # noqa: T201 - a program
    os._exit(0)


if __name__ == "__main__":
    main()
