"""The attacks: by whom, how, and against which processes."""

from __future__ import annotations

from typing import Any

import msgspec

from tests.attacks.harness import AccessControl, Attack
from tests.faults.roles import Hear, Publish, Role

__all__ = ["all_attacks"]


def pair(link: str = "off", env: dict[str, str] | None = None, **talker: Any) -> tuple[Role, ...]:
    """Return two nodes with legitimate messages in both directions, 100 per second.

    Args:
        link: Whether they are linked, or communicate over Zenoh.
        env: Their environment variables, in place of the one for that.
        talker: What else the first node does.
    """
    env = {"AIONODE_LINK": link} if env is None else env
    publish = (Publish("/chatter", period_s=0.01), *talker.pop("publish", ()))
    return (
        Role("talker", publish=publish, hear=(Hear("/back", depth=100),), env=env, **talker),
        Role(
            "listener",
            publish=(Publish("/back", period_s=0.01),),
            hear=(Hear("/chatter", depth=100),),
            env=env,
        ),
    )


def clouds(**options: Any) -> tuple[Publish, ...]:
    """Return a publisher of messages of 10 kB that no legitimate node receives."""
    return (Publish("/clouds", period_s=0.02, size=10_000, readers=0, **options),)


def kept() -> tuple[Publish, ...]:
    """Return a publisher that keeps 10 MB for late readers; no legitimate node is one."""
    return (Publish("/kept", depth=200, transient=True, period_s=0.01, size=50_000, readers=0),)


SMALL_QUEUES = {"AIONODE_LINK": "off", "AIONODE_QUEUE_BYTES": str(4 << 20)}
LISTS = (("node", "list"), ("topic", "list", "-t"), ("topic", "info", "-v", "/chatter"))


def all_attacks() -> list[Attack]:
    """Return all attacks, each with the environment that it needs."""
    rules = AccessControl()
    return [
        Attack("none: the baseline", "nobody", "wait", pair()),
        *attacks_on_gateway(),
        Attack("random bytes to their ports", "outsider", "send_garbage", pair(), short=True),
        Attack("silent connections to their ports", "outsider", "keep_connections", pair()),
        Attack(
            "takes all connect slots, and announces 200 false sessions",
            "other user",
            "pretend_sessions",
            pair(),
            commands=(("node", "list"),),
        ),
        Attack(
            "DATA in the talker's name, by a visitor that may publish /scan",
            "visitor",
            "forge_data",
            pair(env=rules.robot),
            around=rules,
            env=rules.visitor,
            short=True,
        ),
        Attack(
            "a batch in the talker's name, as if from its link",
            "member",
            "post_batch",
            pair("on"),
            replaced="talker",
        ),
        Attack("HEARTBEAT up to 2^62", "member", "heartbeat", pair()),
        Attack("GAP up to 2^62", "member", "gap", pair()),
        Attack("ACKNACK of any numbers", "member", "send_absurd_submessages", pair()),
        Attack("malformed messages", "member", "send_damaged", pair(), short=True),
        Attack(
            "a parameter of 100 kB, requested 40 000 times at once",
            "member",
            "ask_for_one_name",
            pair(parameter_size=100_000),
        ),
        Attack(
            "every built-in service, with requests as large as possible",
            "member",
            "ask_everything",
            pair(parameter_size=100),
        ),
        Attack("malformed requests", "member", "send_damaged_requests", pair(parameter_size=10)),
        Attack(
            "20 requests of 1 MB a second, whose answers it does not read (queues of 4 MiB)",
            "member",
            "ask_largely",
            pair(env=SMALL_QUEUES, parameter_size=100_000),
            6.0,
        ),
        Attack(
            "asks for the messages kept for late readers, and reads nothing (queues of 4 MiB)",
            "member",
            "ask_and_read_nothing",
            pair(env=SMALL_QUEUES, publish=kept()),
            10.0,
        ),
        Attack(
            "40 messages of 500 kB a second to a busy loop (depth 10 000, queues of 4 MiB)",
            "member",
            "flood_topic",
            (
                *pair(env=SMALL_QUEUES)[:1],
                worker(pair(env=SMALL_QUEUES)[1]),
            ),
        ),
        Attack(
            "a KEEP_ALL reader that never acknowledges (queues of 4 MiB)",
            "member",
            "never_acknowledge",
            pair(env=SMALL_QUEUES, publish=clouds(keep_all=True)),
        ),
        Attack(
            "a type of 30 levels of two fields",
            "member",
            "describe_deep",
            pair(curious=True),
            commands=(("topic", "echo", "--once", "--timeout", "1", "/words"),),
            longer_s=6.0,
            seconds=8.0,
        ),
        Attack(
            "a type with an array of 2^37 elements",
            "member",
            "describe_large",
            pair(curious=True),
        ),
        Attack(
            "terminal escapes in names",
            "member",
            "announce_escapes",
            pair(),
            8.0,
            LISTS,
            3.0,
            short=True,
        ),
        Attack("2000 subscriptions with incompatible QoS", "member", "subscribe_oddly", pair()),
        Attack(
            "5000 subscriptions of one topic",
            "member",
            "subscribe_often",
            pair(),
            bare=True,
        ),
        Attack(
            "10 000 publishers of 10 000 topics",
            "member",
            "flood_graph",
            pair(),
            bare=True,
        ),
    ]


def attacks_on_gateway() -> list[Attack]:
    """Return the attacks of clients on a gateway in the process of the first node."""
    tries = {
        "guess_tokens": ("tries tokens at a gateway, as fast as it checks them", "outsider"),
        "keep_waiting": ("500 connections to a gateway that send a byte at a time", "outsider"),
        "send_tiny_parts": ("pings, empty frames, parts and chunks to a gateway", "client"),
        "send_bombs": ("1 MB of JSON that is expensive to parse, to a gateway", "client"),
        "drive_twice": ("two programs of one identity drive through a gateway at once", "client"),
        "drive_late": ("commands that wait at a gateway behind what it refuses", "client"),
        "take_all_places": ("a viewer that takes all connections of a gateway", "client"),
        "load_images": ("a page of another origin with images that have wrong tokens", "outsider"),
        "read_hidden": ("asks parameter services of a gateway for what its policy hides", "client"),
        "read_nothing": ("20 clients of a gateway that request much and read nothing", "client"),
    }
    return [
        *(
            Attack(name, who, program, pair(gateway=True, parameter_size=10), 8.0)
            for program, (name, who) in tries.items()
        ),
        Attack(
            "commands to a gateway that freezes for 0.8 s repeatedly",
            "client",
            "drive_frozen",
            pair(gateway=True),
            8.0,
            hurt=("talker",),
        ),
    ]


def worker(role: Role) -> Role:
    """Return a role with an additional callback that keeps its loop busy most of the time."""
    hear = (*role.hear, Hear("/work", depth=10_000, block_s=0.1))
    return msgspec.structs.replace(role, hear=hear)
