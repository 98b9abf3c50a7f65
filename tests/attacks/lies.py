"""Well-formed lies, one at a time: syntactically valid, with absurd values.

Each takes its values from a `random.Random`, so that a seed reproduces them.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import zenoh  # plays another participant, without aionode

from aionode._distribution import NO_TYPE_HASH
from aionode.engine.transport.reliability.submessage import SubmessageKind, pack_ranges
from aionode.graph import EndpointKind
from aionode.interfaces.rcl_interfaces.msg import Parameter, ParameterValue
from aionode.interfaces.rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.type_description_interfaces.msg import (
    Field,
    FieldType,
    IndividualTypeDescription,
    TypeDescription,
)
from aionode.interfaces.type_description_interfaces.srv import GetTypeDescription
from tests.attacks.liar import Liar

__all__ = ["LIES", "describe", "nested_type"]

NUMBERS = (-(2**63), -1, 0, 1, 2, 10, 1000, 2**31, 2**32, 2**62, 2**63 - 1)

SIZES = (0, 1, 10, 100, 3000)

MAX_HELD = 2000
"""How many tokens it holds at once."""


def lie_in_token(liar: Liar, chance: random.Random) -> None:
    """Announce an endpoint, with numbers of a QoS profile and names of any length."""
    if len(liar.held) > MAX_HELD:
        liar.drop()
        liar.be_node()
    kind = chance.choice(list(EndpointKind))
    name = chance.choice(("/chatter", "/back", "/talker/get_parameters", "/x"))
    name += chance.choice(("", "", "/x" * chance.choice(SIZES)))
    named = chance.choice(("std_msgs/msg/String", "std_msgs/srv/None", f"a/msg/{'B' * 200}"))
    *parts, _ = liar.token(kind, name, named, hash_text=NO_TYPE_HASH).split("/")
    numbers = [str(chance.choice(("", *NUMBERS))) for _ in range(11)]
    qos = "{}:{}:{},{}:{},{}:{},{}:{},{},{}".format(*numbers)
    with suppress(zenoh.ZError):
        liar.hold("/".join((*parts, qos)))


def lie_in_message(liar: Liar, chance: random.Random) -> None:
    """Publish with any sequence number, and a gid that nobody has."""
    data = f"liar 0 {chance.randrange(10**9)} 0.0 {'x' * chance.choice(SIZES)}"
    sequence, gid = chance.choice(NUMBERS), chance.randbytes(16)
    liar.publish("/chatter", String(data=data), sequence, gid)


def lie_in_request(liar: Liar, chance: random.Random) -> None:
    """Get and set parameters with any names and values."""
    names = [chance.choice(("large", "", "x" * 3000, "\x1b[2J"))] * chance.choice((0, 1, 1000))
    value = ParameterValue(type=chance.choice((0, 1, 4, 9, 255)), string_value="x" * 3000)
    parameters = [Parameter(name=name, value=value) for name in names]
    service, interface, request = chance.choice(
        (
            ("get_parameters", GetParameters, GetParameters.Request(names=names)),
            ("describe_parameters", DescribeParameters, DescribeParameters.Request(names=names)),
            (
                "list_parameters",
                ListParameters,
                ListParameters.Request(prefixes=names, depth=chance.choice((0, 1, 2**64 - 1))),
            ),
            ("set_parameters", SetParameters, SetParameters.Request(parameters=parameters)),
            (
                "set_parameters_atomically",
                SetParametersAtomically,
                SetParametersAtomically.Request(parameters=parameters),
            ),
        )
    )
    liar.ask(f"/talker/{service}", interface, request)


def lie_in_acknack(liar: Liar, chance: random.Random) -> None:
    """Acknowledge and request any messages in the listener's name."""
    (talker,) = liar.known(EndpointKind.PUBLISHER, "/chatter")
    (listener,) = liar.known(EndpointKind.SUBSCRIPTION, "/chatter")
    ranges = [(chance.choice(NUMBERS), chance.choice(NUMBERS)) for _ in range(64)]
    first, rest = chance.choice((-(2**63), -1, 0, 1)), pack_ranges(ranges)
    liar.submessage(SubmessageKind.ACKNACK, talker, listener, first, 0, rest)


def lie_in_submessage(liar: Liar, chance: random.Random) -> None:
    """Announce any messages to the listener in the talker's name.

    DATA is left out: whoever may publish on the topic may send it, like any message.
    """
    (talker,) = liar.known(EndpointKind.PUBLISHER, "/chatter")
    (listener,) = liar.known(EndpointKind.SUBSCRIPTION, "/chatter")
    kind = chance.choice((SubmessageKind.HEARTBEAT, SubmessageKind.GAP))
    rest = talker.node.participant.encode() if kind is SubmessageKind.HEARTBEAT else b""
    numbers = chance.choice(NUMBERS), chance.choice(NUMBERS)
    liar.submessage(kind, talker, listener, *numbers, rest)


def lie_in_description(liar: Liar, chance: random.Random) -> None:
    """Describe a type of any size."""
    levels, fields = chance.choice(((1, 1), (30, 2), (40, 3), (300, 1), (2, 3000), (49, 49)))
    capacity = chance.choice((0, 0, 0, 1, 2**16, 2**37, 2**64 - 1))
    number = str(chance.randrange(10**6))
    describe(liar, f"/words_{number}", nested_type(levels, fields, capacity, number))


def nested_type(levels: int, fields: int, capacity: int = 0, tag: str = "") -> TypeDescription:
    """Return a type with fields of a type with fields of a type, and so on.

    Args:
        levels: The number of types.
        fields: The number of fields of each.
        capacity: The size of the fields' arrays; 0 for single values.
        tag: Part of the types' names, besides a number.
    """
    name = f"liar_msgs/msg/T{tag}x{{}}".format
    container = 48 if capacity else 0

    def type_of(level: int) -> FieldType:
        if level == levels:
            return FieldType(type_id=9 + container, capacity=capacity)
        return FieldType(type_id=1 + container, capacity=capacity, nested_type_name=name(level + 1))

    types = [
        IndividualTypeDescription(
            type_name=name(level),
            fields=[Field(name=f"f{n}", type=type_of(level)) for n in range(fields)],
        )
        for level in range(1, levels + 1)
    ]
    return TypeDescription(type_description=types[0], referenced_type_descriptions=types[1:])


def describe(liar: Liar, topic: str, description: TypeDescription) -> None:
    """Announce a publisher of a type, and return this description of it to all who ask."""
    name = description.type_description.type_name
    if not liar.descriptions:

        def answer(request: Any) -> Any:
            found = liar.descriptions[request.type_name]
            return GetTypeDescription.Response(successful=True, type_description=found)

        liar.serve(f"/{liar.node.name}/get_type_description", GetTypeDescription, answer)
    liar.descriptions[name] = description
    liar.hold(liar.token(EndpointKind.PUBLISHER, topic, name, hash_text=NO_TYPE_HASH))


LIES: dict[str, Callable[[Liar, random.Random], None]] = {
    "tokens": lie_in_token,
    "messages": lie_in_message,
    "requests": lie_in_request,
    "acknacks": lie_in_acknack,
    "descriptions": lie_in_description,
    "submessages": lie_in_submessage,
}
