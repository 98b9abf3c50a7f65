"""The cases of motion with ROS 2: what aionode's side can stop, and what it cannot."""

from __future__ import annotations

import contextlib
import itertools
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from typing import Any, Literal

import msgspec

from tests.faults.harness import Skipped
from tests.faults.motion.case import Motion, Place
from tests.faults.motion.goings import Strike, frozen, killed, run_into, signalled
from tests.faults.motion.words import Mover, Wheel
from tests.faults.roles import Role

__all__ = ["ros_motions"]

TTL_S = 0.3
SILENCE_S = 0.3
LOST_S = 3.0
DDS_LEASE_S = 20.0
"""Time after which Fast DDS considers a participant gone, in seconds."""

ROS_LEASE_S = 60.0
"""The same for rmw_zenoh. Its sessions lose those of aionode after 10 s: a frozen node that
continues later may have to reconnect, and is gone for a moment.
"""

PYTHON_VARIABLE = "AIONODE_FAULTS_ROS_PYTHON"
"""The interpreter of an environment that has rclpy, and aionode with its extra ``ros``."""

ROUTER = Role("router", router="tcp/127.0.0.1:{AIONODE_ROUTER_PORT}")
TABLE = "Beside ROS 2"
HOST = "On one host"

TOPIC = Wheel("")
WATCHFUL = Wheel("", silence_sec=SILENCE_S)
SERVER = Wheel("", action=True, lost_sec=LOST_S)


class RosPython(contextlib.AbstractContextManager[None]):
    """Nothing to set up, but rclpy must be installed."""

    path = os.environ.get(PYTHON_VARIABLE, sys.executable)

    def __enter__(self) -> None:
        command = [self.path, "-c", "import rclpy, geometry_msgs, test_msgs, msgspec"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise Skipped(f"no rclpy; {PYTHON_VARIABLE} names a Python that has it")

    def __exit__(self, *_: object) -> None:
        pass


domains = itertools.cycle(set(range(1, 101)) - {42})


def over_dds(wheels: Literal["aionode", "rclpy"]) -> Place:
    """Return a place where everything communicates over DDS, in a domain of its own."""
    env = {
        "AIONODE_TRANSPORT": "rcl",
        "ROS_DOMAIN_ID": str(next(domains)),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    }

    def within(role: Role) -> Role:
        return msgspec.structs.replace(role, python=RosPython.path, env={**env, **role.env})

    name = "DDS" if wheels == "aionode" else "DDS, wheels of rclpy"
    return Place(name, TABLE, "DDS", within, around=RosPython(), wheels=wheels)


def over_zenoh(wheels: Literal["aionode", "ros"]) -> Place:
    """Return a place with stand-ins for ROS 2 nodes on rmw_zenoh, and their router."""
    name = "rmw_zenoh" if wheels == "aionode" else "rmw_zenoh, wheels of ROS 2"
    return Place(name, TABLE, "rmw_zenoh", roles=(ROUTER,), wheels=wheels)


def layer(way: Literal["link", "Zenoh"]) -> Place:
    """Return a place for programs of aionode's rclpy."""
    env = {"AIONODE_LINK": "on" if way == "link" else "off"}

    def within(role: Role) -> Role:
        return msgspec.structs.replace(role, env={**env, **role.env})

    return Place(f"rclpy over {way}", HOST, way, within)


ENDS: tuple[tuple[str, Strike, float], ...] = (
    ("is killed", killed, 0.0),
    ("gets SIGINT", signalled(signal.SIGINT), 0.0),
    ("fails", run_into("fail"), 0.0),
    ("blocks its executor in time.sleep for 5 s", run_into("sleep", 5.0), 5.0),
)


def freezes(*seconds: int) -> Iterator[tuple[str, Strike, float]]:
    """Yield the ways of freezing a process."""
    for each in seconds:
        yield f"is frozen {each} s", frozen(each), each


def publishers(place: Place, who: str, mover: Role, *ways: Any) -> Iterator[Motion]:
    """Yield the cases of ``on_silence`` with a plain publisher of ROS 2."""
    for goes, strike, lasts_s in ways:
        yield Motion(
            place,
            who,
            goes,
            "on_silence at the wheels",
            mover,
            WATCHFUL,
            strike,
            ("silence",),
            SILENCE_S,
            returns=True,
            lasts_s=lasts_s,
            ends=not lasts_s,
        )


def clients(place: Place, who: str, mover: Role, lease_s: float, *ways: Any) -> Iterator[Motion]:
    """Yield what ``on_client_lost`` does against a client of ROS 2, which gives no sign of life.

    Args:
        place: Where.
        who: For the table.
        mover: The process of the client.
        lease_s: Time after which its middleware considers it gone; shorter faults go unnoticed.
        ways: The ways in which it goes away.
    """
    for goes, strike, lasts_s in ways:
        shows = not lasts_s or lasts_s > lease_s
        yield Motion(
            place,
            who,
            goes,
            "on_client_lost at the server",
            mover,
            SERVER,
            strike,
            ("lost",) if shows else (),
            lease_s + LOST_S if shows else None,
            allowed_s=0.5,
            lasts_s=lasts_s,
            ends=not lasts_s,
        )


def leases(place: Place, column: str) -> Iterator[Motion]:
    """Yield the cases of a lease that commands wheels of ROS 2."""
    ways: tuple[tuple[str, Strike, float, float | None], ...] = (
        ("fails", run_into("fail"), 0.0, TTL_S),
        ("gets SIGTERM", signalled(signal.SIGTERM), 0.0, TTL_S),
        (
            "gets two signals within 2 ms",
            signalled(signal.SIGINT, signal.SIGTERM, apart_s=0.002),
            0.0,
            TTL_S,
        ),
        ("blocks its loop in time.sleep for 5 s", run_into("sleep", 5.0), 5.0, TTL_S),
        ("is killed", killed, 0.0, None),
    )
    for goes, strike, lasts_s, limit_s in ways:
        yield Motion(
            place,
            "a holder of a lease",
            goes,
            f"a lease at the mover, wheels of {column}",
            Role("", mover=Mover("")),
            TOPIC,
            strike,
            ("lease",) if limit_s else (),
            limit_s,
            lasts_s=lasts_s,
            ends=not lasts_s,
        )


def ros_motions() -> Iterator[Motion]:
    """Yield every case with ROS 2, and those of aionode's rclpy."""
    publisher, client = Mover("", asks="publisher"), Mover("", asks="goal")
    rclpy = Role("", mover=publisher, rclpy=True), Role("", mover=client, rclpy=True)
    ros = Role("", mover=publisher, ros=True), Role("", mover=client, ros=True)
    for way in ("link", "Zenoh"):
        place = layer(way)
        yield from publishers(place, "a publisher of aionode's rclpy", rclpy[0], *ENDS, *freezes(5))
        yield from clients(place, "a client of aionode's rclpy", rclpy[1], 0.0, *ENDS[:1])
    dds = over_dds("aionode")
    yield from publishers(dds, "a publisher of rclpy", rclpy[0], *ENDS, *freezes(5, 14))
    yield from clients(
        dds,
        "a client of rclpy",
        rclpy[1],
        # Also after SIGINT: rclpy's action clients keep their participant.
        DDS_LEASE_S,
        *ENDS[:2],
        *freezes(5, 30),
    )
    yield from leases(over_dds("rclpy"), "rclpy")
    zenoh = over_zenoh("aionode")
    yield from publishers(zenoh, "a publisher of ROS 2", ros[0], ENDS[0], *freezes(5, 14, 70))
    yield from clients(
        zenoh,
        "a client of ROS 2",
        ros[1],
        ROS_LEASE_S,
        ENDS[0],
        *freezes(5, 14, 70),
    )
    yield from leases(over_zenoh("ros"), "ROS 2")
