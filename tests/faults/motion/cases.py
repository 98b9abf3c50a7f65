"""The cases of motion: who moves wheels, how it goes away, and what stops them."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import msgspec

from tests.faults.hosts import ADDRESSES, NAMING, TwoHosts
from tests.faults.hosts import ROUTER as HOST_ROUTER
from tests.faults.motion.case import Motion, Place, Switch
from tests.faults.motion.goings import (
    Strike,
    at_once,
    browser_leaves,
    comes_near,
    drives_into_standstill,
    frozen,
    guardian_killed,
    hung_up,
    interrupted_twice,
    killed,
    killed_beside_another,
    leaves,
    run_into,
    signalled,
)
from tests.faults.motion.ros_cases import ros_motions
from tests.faults.motion.words import Mover, Way, Wheel
from tests.faults.roles import Role

__all__ = ["motions"]

TTL_S = 0.3
SILENCE_S = 0.3
LOST_S = 3.0
CHUNK_S = 0.5
"""How long the chunks of a policy last: see `tests.faults.motion.policy`."""

LONG_TTL_S = 5.0
"""The time to live of a lease that is to be stopped by something else."""

ROUTER = Role("router", router="tcp/127.0.0.1:{AIONODE_ROUTER_PORT}")


def linked(way: str) -> Place:
    """Return a place where messages travel by one transport."""

    def within(role: Role) -> Role:
        env = {"AIONODE_LINK": "on" if way == "link" else "off", **role.env}
        return msgspec.structs.replace(role, env=env)

    return Place(way, "On one host", way, within, roles=(ROUTER,) * (way == "router"))


def mover(topic: str = "", **options: Any) -> Role:
    """Return a process that moves wheels; see `Mover`."""
    return Role("", mover=Mover(topic, **options))


TOPIC = Wheel("")
WATCHFUL = Wheel("", silence_sec=SILENCE_S)
SERVER = Wheel("", action=True, lost_sec=LOST_S)

TERM, INT, QUIT = signal.SIGTERM, signal.SIGINT, signal.SIGQUIT

ENDINGS: tuple[tuple[str, Strike], ...] = (
    ("gets SIGTERM", signalled(TERM)),
    ("gets two signals within 2 ms", signalled(INT, TERM, apart_s=0.002)),
    ("gets two signals within 20 ms", signalled(TERM, TERM, apart_s=0.02)),
    ("loses its terminal", hung_up),
)
"""Ends of a process that has time to clean up."""

DEATHS: tuple[tuple[str, Strike], ...] = (
    ("is killed", killed),
    ("calls os._exit", run_into("exit")),
    ("gets SIGQUIT", signalled(QUIT)),
)
"""Ends of a process that has none."""

BLOCKS: tuple[tuple[str, Strike], ...] = (
    ("blocks its loop in time.sleep for 5 s", run_into("sleep", 5.0)),
    ("blocks its loop with a computation for 5 s", run_into("compute", 5.0)),
)


def case(place: Place, who: str, goes: str, stops: str, **options: Any) -> Motion:
    """Return a case whose fault may need a terminal, and may end the process of its mover."""
    strike = options["strike"]
    if strike is hung_up:
        role = msgspec.structs.replace(options["mover"], output="terminal")
        options["mover"] = role
    return Motion(place, who, goes, stops, **options)


def leases(place: Place) -> Iterator[Motion]:
    """Yield the cases of movers that hold a lease."""
    promised: dict[str, Any] = {"wheel": TOPIC, "switches": ("lease",), "limit_s": TTL_S}
    lease = "a lease at the mover"
    for goes, strike in (("fails", run_into("fail")), *ENDINGS):
        yield case(
            place,
            "a holder of a lease",
            goes,
            lease,
            mover=mover(ttl_sec=LONG_TTL_S),
            strike=strike,
            ends=True,
            **promised,
        )
    for goes, strike in BLOCKS:
        yield case(
            place,
            "a holder of a lease",
            goes,
            lease,
            mover=mover(),
            strike=strike,
            lasts_s=5.0,
            **promised,
        )
    yield case(
        place,
        "a holder of a lease",
        "is suspended by Ctrl-Z for 5 s",
        lease,
        mover=mover(ttl_sec=LONG_TTL_S),
        strike=frozen(5.0, signal.SIGTSTP),
        lasts_s=5.0,
        **promised,
    )
    for program, text in (("run", ""), ("asyncio", " of asyncio.run"), ("uvicorn", " of uvicorn")):
        yield case(
            place,
            f"a holder of a lease{text}",
            "gets a second Ctrl-C while it cleans up",
            lease,
            mover=mover(program=program, ttl_sec=LONG_TTL_S, cleans_up_s=30.0, graceful_s=None),
            # asyncio.run alone lets the first one wait for the cleanup.
            strike=interrupted_twice(judged=int(program == "asyncio")),
            ends=True,
            **promised,
        )
    yield case(
        place,
        "a holder of a lease",
        "gets a second Ctrl-C while its loop is blocked",
        lease,
        mover=mover(ttl_sec=60.0),
        strike=interrupted_twice("sleep 30"),
        ends=True,
        **promised,
    )
    for route in ("awaited", "streamed"):
        yield case(
            place,
            f"a route of FastAPI that holds a lease, {route},",
            "loses its browser",
            lease,
            mover=mover(program="uvicorn", route=route, ttl_sec=LONG_TTL_S),
            strike=browser_leaves,
            **promised,
        )
    for route in ("awaited", "streamed"):
        for number, name in ((INT, "Ctrl-C"), (TERM, "SIGTERM")):
            yield case(
                place,
                f"a route of FastAPI that holds a lease, {route},",
                f"gets {name}, and uvicorn waits for its browser without a limit",
                lease,
                mover=mover(program="uvicorn", route=route, ttl_sec=LONG_TTL_S, graceful_s=None),
                strike=signalled(number),
                ends=route == "awaited",  # a stream goes on that goes on without its lease
                **{**promised, "limit_s": 0.2},
            )
    yield case(
        place,
        "a holder of a lease",
        "is frozen 5 s while another goes on",
        lease,
        mover=mover(),
        beside=mover(),
        strike=frozen(5.0),
        lasts_s=5.0,
        **{**promised, "limit_s": 0.0},
    )
    transient = {"mover": mover(transient=True), "joins_late": True, "lasts_s": 5.0}
    yield case(
        place,
        "a holder of a lease, transient local,",
        "blocks its loop for 5 s, and other wheels join late",
        lease,
        strike=run_into("sleep", 5.0),
        **{**promised, **transient, "wheel": Wheel("", transient=True)},
    )


def leases_and_silence(place: Place) -> Iterator[Motion]:
    """Yield the cases in which both sides provide a stop: nothing moves afterwards."""
    transient = {
        "mover": mover(transient=True),
        "wheel": Wheel("", silence_sec=SILENCE_S, transient=True),
        "joins_late": True,
    }
    both = "a lease at the mover, on_silence at the wheels"
    frozen_cases: tuple[tuple[str, dict[str, Any]], ...] = (
        ("is killed", {"strike": killed, "ends": True, "short": place.name == "link"}),
        *(
            (f"is frozen {each} s", {"strike": frozen(each), "lasts_s": each})
            for each in (5, 14, *((70,) if place.name == "router" else ()))
        ),
        (
            "is frozen 5 s, and other wheels join late",
            {"strike": frozen(5), "lasts_s": 5, **transient},
        ),
    )
    for goes, options in frozen_cases:
        # One that is killed has no commands left that its lease could hold back.
        switches = ("silence",) if options["strike"] is killed else ("silence", "lease")
        yield case(
            place,
            "a holder of a lease",
            goes,
            both,
            **{
                "mover": mover(),
                "wheel": WATCHFUL,
                "switches": switches,
                "limit_s": SILENCE_S,
                **options,
            },
        )


def policies(place: Place) -> Iterator[Motion]:
    """Yield the cases of a policy whose chunks are sent by an actor."""
    who, lease = "a policy with chunks of 0.5 s", "the lease of its actor, after its chunk"
    promised: dict[str, Any] = {"wheel": TOPIC, "switches": ("lease",), "limit_s": CHUNK_S + TTL_S}
    for goes, trouble, seconds in (
        ("hangs for 5 s", "hang", 5.0),
        ("computes in Python for 5 s", "think", 5.0),
        ("takes 1.5 s for each chunk from now on", "slow", 1.5),
        ("sees nothing any more", "blind", 0.0),
    ):
        yield case(
            place,
            who,
            goes,
            lease,
            mover=mover(asks="policy"),
            strike=run_into(trouble, seconds),
            lasts_s=seconds,
            **promised,
        )
    for goes, stops, trouble, switches in (
        ("is killed", "the end of its actor's block", "kill", ("end",)),
        ("is frozen 5 s", lease, "freeze", ("lease",)),
    ):
        yield case(
            place,
            f"{who} in a process of its own",
            goes,
            stops,
            mover=mover(asks="policy apart"),
            strike=run_into(trouble, 5.0),
            lasts_s=5.0,
            **{**promised, "switches": switches},
        )
    for goes, strike, seconds in (
        ("is killed", killed, 0.0),
        ("is frozen 5 s", frozen(5.0), 5.0),
    ):
        yield case(
            place,
            who,
            goes,
            "the lease of its actor, on_silence at the wheels",
            mover=mover(asks="policy"),
            wheel=WATCHFUL,
            strike=strike,
            switches=("silence",),
            limit_s=SILENCE_S,
            lasts_s=seconds,
            ends=strike is killed,
        )


def limits(place: Place) -> Iterator[Motion]:
    """Yield the cases that a lease alone cannot stop: a process that no longer runs."""
    for goes, strike in DEATHS:
        yield case(
            place,
            "a holder of a lease",
            goes,
            "a lease at the mover alone",
            mover=mover(),
            wheel=TOPIC,
            strike=strike,
            ends=True,
        )


def publishers(place: Place) -> Iterator[Motion]:
    """Yield the cases of a plain publisher."""
    cases: tuple[tuple[str, dict[str, Any]], ...] = (
        *((goes, {"strike": strike, "ends": True}) for goes, strike in DEATHS),
        ("fails", {"strike": run_into("fail"), "ends": True}),
        *((goes, {"strike": strike, "lasts_s": 5.0}) for goes, strike in BLOCKS),
        ("is suspended by Ctrl-Z for 5 s", {"strike": frozen(5, signal.SIGTSTP), "lasts_s": 5}),
        *(
            (f"is frozen {each} s", {"strike": frozen(each), "lasts_s": each})
            for each in (5, 14, *((70,) if place.name == "router" else ()))
        ),
        (
            "is killed beside aionode topic pub -r 1",
            {"strike": killed, "ends": True, "beside": PUB},
        ),
    )
    for goes, options in cases:
        yield case(
            place,
            "a publisher",
            goes,
            "on_silence at the wheels",
            mover=mover(asks="publisher"),
            wheel=WATCHFUL,
            switches=("silence",),
            returns=True,
            **{"limit_s": SILENCE_S, **options},
        )


def last_messages(place: Place) -> Iterator[Motion]:
    """Yield the cases of a publisher whose ``finally`` sends a stop."""
    endings: tuple[tuple[str, Strike, Switch], ...] = (
        ("fails", run_into("fail"), "end"),
        ("gets SIGTERM", ENDINGS[0][1], "end"),
        *((goes, strike, "signals") for goes, strike in ENDINGS[1:]),
    )
    for goes, strike, switch in endings:
        yield case(
            place,
            "a publisher",
            goes,
            "finally at the mover",
            # Long enough for a second signal to come between.
            mover=mover(asks="finally", cleans_up_s=0.1),
            wheel=TOPIC,
            strike=strike,
            switches=(switch,),
            limit_s=TTL_S,
            ends=True,
        )


def launches(place: Place) -> Iterator[Motion]:
    """Yield the cases of a publisher started by a launch file."""
    for goes, strike in (
        ("has its guardian killed", guardian_killed),
        ("is killed", killed),
        ("gets SIGTERM", signalled(TERM)),
    ):
        yield case(
            place,
            "aionode launch of a publisher",
            goes,
            "on_silence at the wheels",
            mover=LAUNCH,
            wheel=WATCHFUL,
            switches=("silence",),
            limit_s=SILENCE_S,
            strike=strike,
            ends=True,
        )


def goals(place: Place) -> Iterator[Motion]:
    """Yield the cases of an action client."""
    lost: tuple[tuple[str, dict[str, Any]], ...] = (
        *((goes, {"strike": strike, "ends": True}) for goes, strike in DEATHS),
        *((goes, {"strike": strike, "lasts_s": 5.0}) for goes, strike in BLOCKS),
        ("is suspended by Ctrl-Z for 5 s", {"strike": frozen(5, signal.SIGTSTP), "lasts_s": 5}),
        *(
            (f"is frozen {each} s", {"strike": frozen(each), "lasts_s": each})
            for each in (5, 14, *((70,) if place.name == "router" else ()))
        ),
    )
    for goes, options in lost:
        yield case(
            place,
            "a client of a goal",
            goes,
            "on_client_lost at the server",
            mover=mover(asks="goal"),
            wheel=SERVER,
            switches=("lost",),
            limit_s=LOST_S,
            allowed_s=0.5,
            **options,
        )
    ends: tuple[tuple[str, str, Role, Strike, bool], ...] = (
        *(
            ("a client of a goal", goes, mover(asks="goal"), strike, True)
            for goes, strike in (("fails", run_into("fail")), *ENDINGS)
        ),
        (
            "a route of FastAPI that awaits a goal",
            "loses its browser",
            mover(asks="goal", program="uvicorn"),
            browser_leaves,
            False,
        ),
        (
            "a route of FastAPI that awaits a goal",
            "has a node that fails",
            mover(asks="goal", program="uvicorn"),
            run_into("fail"),
            False,
        ),
    )
    for who, goes, role, strike, ending in ends:
        yield case(
            place,
            who,
            goes,
            "the end of the client",
            mover=role,
            # Nothing but the client itself may end it in time.
            wheel=Wheel("", action=True),
            strike=strike,
            switches=("end",),
            limit_s=TTL_S,
            ends=ending,
        )


def cables() -> Iterator[Motion]:
    """Yield the cases of a robot whose operator is out of reach."""
    for seconds in (5, 14, 70):
        for verb, text in (("cut", "is cut off for"), ("swallow", "is out of reach for")):
            hosts = TwoHosts()
            place = Place(
                f"{verb} {seconds}",
                "Two hosts",
                "longest",
                partial(beyond, hosts),
                hosts.placed((HOST_ROUTER,)),
                hosts,
                together=True,
            )
            strike = at_once(getattr(hosts, verb)(seconds))
            asking: tuple[tuple[str, str, dict[str, Any]], ...] = (
                (
                    "a holder of a lease",
                    "a lease at the mover, on_silence at the wheels",
                    {
                        "mover": mover(),
                        "wheel": WATCHFUL,
                        "switches": ("silence",),
                        # It has not gone away; only its wheels have, which it does not know.
                        "returns": True,
                    },
                ),
                (
                    "a publisher",
                    "on_silence at the wheels",
                    {
                        "mover": mover(asks="publisher"),
                        "wheel": WATCHFUL,
                        "switches": ("silence",),
                        "returns": True,
                    },
                ),
                (
                    "a client of a goal",
                    "on_client_lost at the server",
                    {
                        "mover": mover(asks="goal"),
                        "wheel": SERVER,
                        "switches": ("lost",),
                        "limit_s": LOST_S,
                        "allowed_s": 0.5,
                    },
                ),
            )
            for who, stops, options in asking:
                yield case(
                    place,
                    who,
                    f"{text} {seconds} s",
                    stops,
                    strike=strike,
                    lasts_s=seconds,
                    **{"limit_s": SILENCE_S, **options},
                )


GATEWAY = Role("gateway", command=("-m", "tests.faults.motion.gateway"))
WAYS: tuple[Way, ...] = ("rosbridge", "foxglove json", "foxglove cdr", "http")
GOAL_WAYS: tuple[Way, ...] = ("rosbridge", "http")


def gateways() -> Iterator[Motion]:
    """Yield the cases of clients of a gateway."""

    def place(name: str, *roles: Role) -> Place:
        return Place(name, "Through a gateway", "longest", roles=(GATEWAY, *roles))

    by_lease: dict[str, Any] = {"wheel": TOPIC, "switches": ("gateway",), "limit_s": TTL_S}
    together = place("gateway")
    for way in WAYS:
        yield case(
            together,
            f"a page over {way}",
            "computes NaN from some time on",
            "a lease of the gateway, which refuses NaN",
            mover=mover(program="page", asks="publisher", way=way),
            strike=run_into("nan"),
            **by_lease,
        )
    for way in GOAL_WAYS:
        yield case(
            together,
            f"a page with a goal over {way}",
            "is killed",
            "the gateway, at a server of aionode without a cancel_callback",
            mover=mover(program="page", asks="goal", way=way),
            wheel=Wheel("", action=True, accepts=False),
            strike=killed,
            switches=("lost",),
            limit_s=TTL_S,
            ends=True,
        )
        yield case(
            place(f"gateway that stands still, {way}"),
            f"a page over {way}",
            "lets go, and drives for 2 s of 3 in which the gateway is frozen",
            "a lease of the gateway, which passes on nothing old",
            mover=mover(program="page", asks="publisher", way=way),
            strike=drives_into_standstill,
            lasts_s=4.0,
            **by_lease,
        )
    yield case(
        together,
        "a page with a goal over rosbridge",
        "is killed",
        "the gateway, at a server that rejects to cancel, as rclpy's by default",
        mover=mover(program="page", asks="goal"),
        wheel=Wheel("", action=True, accepts=False, continues=True),
        strike=killed,
        ends=True,
    )
    rival = mover(topic="/motion0", program="page", asks="publisher", way="http")
    yield case(
        place("gateway with two", msgspec.structs.replace(rival, name="rival")),
        "a program over http, beside another with the same token,",
        "is killed",
        "a lease of the gateway, which one of them holds",
        mover=mover(program="page", asks="publisher", way="http"),
        strike=killed_beside_another,
        returns=True,
        ends=True,
        **by_lease,
    )


ASSISTANTS = Role("gateway", command=("-m", "tests.faults.motion.gateway", "assistants"))
ERAS = {"new": "2026-07-28", "old": "2025-11-25"}
NOTICED_S = 0.1
"""The longest time between what a gateway can notice and the stop."""

CEILING_S = 4.0


def assistants() -> Iterator[Motion]:
    """Yield the cases of a language model's client that moves by MCP."""
    place = Place("assistants", "By an assistant", "longest", roles=(ASSISTANTS,))
    ways: tuple[Way, ...] = ("mcp stdio new", "mcp stdio old", "mcp http new", "mcp http old")
    for way in ways:
        _, transport, era = way.split()
        for asks, what in (("publisher", "a move"), ("goal", "a goal")):
            who = f"an assistant with {what} over {transport} of {ERAS[era]}"
            common: dict[str, Any] = {
                "wheel": SERVER if asks == "goal" else TOPIC,
                "limit_s": NOTICED_S,
                "switches": ("lost",) if asks == "goal" else ("gateway",),
            }
            drives = mover(program="page", asks=asks, way=way)
            frozen_mover = mover(program="page", asks=asks, way=way, seconds=CEILING_S)
            ended = "the end of the call"
            yield case(
                place, who, "gives up", ended, mover=drives, strike=run_into("cancel"), **common
            )
            yield case(
                place, who, "is killed", ended, mover=drives, strike=killed, ends=True, **common
            )
            if transport == "stdio":
                yield case(
                    place, who, "closes its streams", ended, mover=drives, strike=leaves, **common
                )
            yield case(
                place, who, "is frozen for 5 s", "the seconds of the call", mover=frozen_mover,
                strike=frozen(5.0), lasts_s=5.0, **{**common, "limit_s": CEILING_S},
            )  # fmt: skip
            if transport == "http":
                yield assistant_out_of_reach(who, mover(
                    program="page", asks=asks, way=way, host=ADDRESSES[0],
                ), common)  # fmt: skip


def assistant_out_of_reach(who: str, drives: Role, common: dict[str, Any]) -> Motion:
    """Return the case of an assistant on another host that is cut off."""
    hosts = TwoHosts()
    place = Place(
        f"cut, {who}", "By an assistant", "longest", partial(beyond, hosts),
        hosts.placed((HOST_ROUTER, ASSISTANTS)), hosts, together=True,
    )  # fmt: skip
    return case(
        place, who, "is cut off for 8 s", "the gateway, which hears of TCP that nobody is there",
        mover=drives, strike=at_once(hosts.cut(8)), lasts_s=8.0,
        **{**common, "limit_s": LOST_S, "allowed_s": 1.0},
    )  # fmt: skip


INTERFACES = Path(__file__).with_name("interfaces")


def defaults() -> Iterator[Motion]:
    """Yield the cases of movers that send the defaults of a definition.

    Only the wheels have the definition: the others know the type from a node's description. With
    zeros in place of the defaults, nothing would end the motion.
    """

    def within(role: Role) -> Role:
        if not (role.wheels or role.moves):
            return role
        env = {"AIONODE_INTERFACES": str(INTERFACES), **role.env}
        return msgspec.structs.replace(role, env=env)

    shell = Place("defaults", "On one host", "link", within)
    web = Place("defaults, gateway", "Through a gateway", "longest", within, roles=(GATEWAY,))
    near: dict[str, Any] = {
        "goes": "comes near its target",
        "stops": "the tolerance in the definition of the action",
        "wheel": Wheel("", action=True, has_defaults=True),
        "strike": comes_near,
        "limit_s": 0.0,
    }
    dies: dict[str, Any] = {
        "goes": "is killed",
        "stops": "the time in the definition of the message",
        "wheel": Wheel("", has_defaults=True),
        "strike": killed,
        "limit_s": 0.5,
        "ends": True,
    }
    by_page: dict[str, Any] = {"program": "page", "client": "lax", "has_defaults": True}
    movers: list[tuple[Place, str, Role, dict[str, Any]]] = [
        (shell, "aionode action send_goal of {}", SEND_GOAL, near | {"ends": True}),
        (shell, "aionode topic pub of {}", PUB_DEFAULTS, dies),
    ]
    for way in WAYS:
        if way in GOAL_WAYS:
            role = mover(asks="goal", way=way, **by_page)
            movers.append((web, f"a page with a goal of {{}} over {way}", role, near))
        if way != "foxglove cdr":  # there the page itself encodes all fields
            role = mover(asks="publisher", way=way, **by_page)
            movers.append((web, f"a page that sends {{}} over {way}", role, dies))
    for place, who, role, options in movers:
        yield case(place, who, mover=role, switches=("defaults",), **options)


def beyond(hosts: TwoHosts, role: Role) -> Role:
    """Return a role placed on the robot if it has wheels, else on the other host."""
    if role.wheels:
        return hosts.within(0, role)
    return hosts.within(1, msgspec.structs.replace(role, env={**NAMING, **role.env}))


PUB = Role(
    "",
    command=(
        "-m",
        "aionode",
        "topic",
        "pub",
        "-r",
        "1",
        "TOPIC",
        "geometry_msgs/msg/Twist",
        "{linear: {x: 0.5}}",
    ),
)
"""A command from a shell: one message a second, without a sender in it."""


PUB_DEFAULTS = Role(
    "",
    command=(
        *("-m", "aionode", "topic", "pub", "-r", "20"),
        *("TOPIC", "minibot_interfaces/msg/Drive", "{}"),
    ),
)
SEND_GOAL = Role(
    "",
    command=(
        *("-m", "aionode", "action", "send_goal"),
        *("TOPIC", "minibot_interfaces/action/Approach", "{}"),
    ),
)


LAUNCH = Role(
    "",
    command=(
        "-m",
        "aionode",
        "launch",
        str(Path(__file__).with_name("mover.launch.xml")),
        f"python:={sys.executable}",
        "topic:=TOPIC",
    ),
)
"""A launch that starts such a command."""


def motions() -> list[Motion]:
    """Return every case."""
    kinds = (leases, leases_and_silence, publishers, last_messages, goals)
    places = [linked(way) for way in ("link", "Zenoh", "router")]
    return [
        *(motion for place in places for kind in kinds for motion in kind(place)),
        *policies(places[0]),
        *limits(places[0]),
        *gateways(),
        *assistants(),
        *defaults(),
        *launches(places[0]),
        *cables(),
        *ros_motions(),
    ]
