"""The fault cases: roles, a fault, and the promises."""

from __future__ import annotations

import contextlib
import subprocess
from collections.abc import Iterator

import msgspec

from tests.faults.faults import (
    arrive,
    end_and_replace,
    end_beside_frozen,
    freeze,
    freeze_idle,
    replace,
    wait,
)
from tests.faults.harness import Case, Skipped
from tests.faults.hosts import host_cases
from tests.faults.roles import Hear, Output, Publish, Role

__all__ = ["all_cases"]

WAYS = {"link": "on", "Zenoh": "off"}
PAST_LEASE_S = 14
FREEZES_S = (5, PAST_LEASE_S, 70)
"""Shorter than the lease of 10 s, longer, and longer than that of ROS 2 nodes, which is 60 s."""

RETURNS_S = (5, PAST_LEASE_S, 33, 70)
"""Those, and one in between: a peer of ROS 2 nodes is gone for itself, but not yet for them."""

LEASE_S = 10.0
"""Time after which a frozen process counts as gone, in seconds."""

ROUTER = Role("router", router="tcp/127.0.0.1:{AIONODE_ROUTER_PORT}")


def on(way: str, *roles: Role) -> tuple[Role, ...]:
    """Return roles that talk over links, or over Zenoh alone."""
    return tuple(
        msgspec.structs.replace(role, env={**role.env, "AIONODE_LINK": WAYS[way]}) for role in roles
    )


def talk(*, keep_all: bool, period_s: float = 0.02, transient: bool = False) -> tuple[Role, ...]:
    """Return a publisher, a reader to be struck, and another reader with a topic of its own.

    Messages for a frozen reader soon fill every buffer on the way to it.
    """
    return (
        Role(
            "talker",
            publish=(
                Publish(
                    "/a", keep_all=keep_all, transient=transient, period_s=period_s, size=59_000
                ),
                Publish("/b", depth=100),
            ),
        ),
        Role("reader", hear=(Hear("/a", keep_all=keep_all, transient=transient),)),
        Role("beside", hear=(Hear("/b", depth=100),)),
    )


CALLING = (
    Role("server", serve="/add"),
    Role("client", call="/add", callers=10, size=100_000),
    Role("other", call="/add"),
)

LARGE_CALLING = (
    Role("server", serve="/add"),
    Role("client", call="/add", size=6_500_000, publish=(Publish("/b", depth=100),)),
    Role("beside", hear=(Hear("/b", depth=100),)),
)
"""One request takes more than all buffers on the way hold."""

ACTING = (
    Role("server", act="/count"),
    Role("client", send="/count"),
    Role("other", send="/count"),
)


MANY = 5
"""How many processes there are where all but one are frozen."""

CROWD = 30
"""How many processes start at the same moment."""


def members(count: int, *, ros: int = 0, period_s: float = 0.05) -> tuple[Role, ...]:
    """Return processes that all receive from each other."""
    return tuple(
        Role(
            f"{'ros' if number < ros else 'member'}{number}",
            publish=(Publish("/hello", period_s=period_s),),
            hear=(Hear("/hello", depth=100),),
            ros=number < ros,
        )
        for number in range(count)
    )


def freezes(way: str) -> Iterator[Case]:
    """Yield what happens when a process stops for a while."""
    for seconds in FREEZES_S:
        short = seconds == FREEZES_S[0]
        for keep_all in (True, False):
            kind = "KEEP_ALL" if keep_all else "KEEP_LAST"
            for name in ("reader", "talker"):
                yield Case(
                    f"{way}: {kind} {name} frozen {seconds} s",
                    on(way, *talk(keep_all=keep_all, period_s=0.02 if short else 0.1)),
                    freeze((name,), seconds),
                    (name,),
                    loss="none" if keep_all else "told",
                    lasts_s=seconds,
                )
        yield Case(
            f"{way}: KEEP_ALL reader frozen {seconds} s, its publisher idle at first",
            on(way, *talk(keep_all=True, period_s=0.02 if short else 0.1)),
            freeze_idle("reader", "talker", seconds, idle_s=2.0 if short else LEASE_S + 1.0),
            ("reader",),
            lasts_s=seconds,
        )
        yield Case(
            f"{way}: KEEP_ALL callback awaits for {seconds} s",
            on(
                way,
                Role("talker", publish=(Publish("/a", keep_all=True, period_s=0.001),)),
                Role("reader", hear=(Hear("/a", keep_all=True, pause_s=seconds),)),
            ),
            wait(seconds),
            lasts_s=seconds,
        )
        yield Case(
            f"{way}: KEEP_ALL reader frozen {seconds} s, transient local",
            on(way, *talk(keep_all=True, transient=True, period_s=0.02 if short else 0.1)),
            freeze(("reader",), seconds),
            ("reader",),
            lasts_s=seconds,
        )
        yield Case(
            f"{way}: large calls, server frozen {seconds} s",
            on(way, *LARGE_CALLING),
            freeze(("server",), seconds),
            ("server",),
            loss="told",
            lasts_s=seconds,
        )
        yield Case(
            f"{way}: KEEP_ALL talker ended after its reader was frozen {seconds} s",
            on(way, *talk(keep_all=True, period_s=0.02 if short else 0.1)),
            end_beside_frozen("talker", ("reader",), seconds),
            ("reader",),
            loss="told",
            lasts_s=seconds,
        )
        for roles, kind in ((CALLING, "calls"), (ACTING, "goals")):
            for name in ("server", "client"):
                yield Case(
                    f"{way}: {kind}, {name} frozen {seconds} s",
                    on(way, *roles),
                    freeze((name,), seconds),
                    (name,),
                    loss="told",
                    lasts_s=seconds,
                )
    for seconds in RETURNS_S:
        yield Case(
            f"{way}: one of three frozen {seconds} s, all hear all",
            on(way, *members(3)),
            freeze(("member1",), seconds),
            ("member1",),
            loss="any",
            lasts_s=seconds,
        )
    first, *others = (role.name for role in members(MANY))
    frozen = tuple(others)
    for what, fault in (
        ("all hear all", freeze(frozen, PAST_LEASE_S)),
        ("the other one ends", end_beside_frozen(first, frozen, PAST_LEASE_S)),
    ):
        yield Case(
            f"{way}: {len(frozen)} of {MANY} frozen {PAST_LEASE_S} s, {what}",
            on(way, *members(MANY)),
            fault,
            frozen,
            loss="any",
            lasts_s=PAST_LEASE_S,
        )


def kills(way: str) -> Iterator[Case]:
    """Yield what happens when a process is killed, and another takes its place."""
    for name in ("reader", "talker"):
        yield Case(
            f"{way}: KEEP_ALL {name} killed and replaced",
            on(way, *talk(keep_all=True)),
            replace(name),
        )
    for roles, kind in ((CALLING, "calls"), (ACTING, "goals")):
        for name in ("server", "client"):
            yield Case(
                f"{way}: {kind}, {name} killed and replaced",
                on(way, *roles),
                replace(name),
                loss="told",
            )


def comings(way: str) -> Iterator[Case]:
    """Yield what happens to messages while processes start and stop."""
    yield Case(
        f"{way}: talker beside a reader that starts and stops",
        on(
            way,
            Role("talker", publish=(Publish("/a", keep_all=True, period_s=0.005),)),
            Role("reader", hear=(Hear("/a", keep_all=True),)),
            Role("other", hear=(Hear("/a", keep_all=True),)),
        ),
        end_and_replace("other", 3),
    )
    for keep_all in (True, False):
        yield Case(
            f"{way}: {'KEEP_ALL' if keep_all else 'KEEP_LAST'} talker ends after 400 messages",
            on(
                way,
                Role(
                    "talker",
                    publish=(Publish("/a", keep_all=keep_all, depth=400, period_s=0, count=400),),
                ),
                Role("reader", hear=(Hear("/a", keep_all=keep_all, depth=1000),)),
            ),
            wait(2),
        )
    yield Case(
        f"{way}: KEEP_ALL reader takes 4 ms a message, its publisher 2 ms",
        on(
            way,
            Role(
                "talker",
                publish=(
                    Publish("/a", keep_all=True, period_s=0.002),
                    Publish("/b", depth=100),
                ),
            ),
            Role("reader", hear=(Hear("/a", keep_all=True, slow_s=0.004),)),
            Role("beside", hear=(Hear("/b", depth=100),)),
        ),
        wait(5),
        recovery_limit_s=RECOVERY_OF_BACKLOG_S,
    )


RECOVERY_OF_BACKLOG_S = 20.0
"""A slow reader has the backlog of its publisher, some thousand messages, before what is new."""


def crowds(way: str) -> Iterator[Case]:
    """Yield what happens when many processes start at the same moment."""
    first, *others = on(way, *members(CROWD, period_s=0.5))
    yield Case(
        f"{way}: {CROWD} processes start at the same moment, all hear all",
        (first,),
        arrive(others),
        loss="any",
        lasts_s=9.0,
    )


def outputs(way: str) -> Iterator[Case]:
    """Yield what happens when the output of a process is not read, or the disk is full."""
    full: tuple[Output, str] = ("full", "on /dev/full")
    unread: tuple[Output, str] = ("unread", "in a pipe that is not read")
    for output, what in (full, unread):
        yield Case(
            f"{way}: a process logs without end, stdout and stderr {what}",
            on(
                way,
                Role("noisy", noisy=True, output=output),
                Role("talker", publish=(Publish("/a", keep_all=True),)),
                Role("reader", hear=(Hear("/a", keep_all=True),)),
            ),
            wait(3),
            ("noisy",),
            short=way == "link" and output == "unread",
        )
    yield Case(
        f"{way}: shared memory full, large messages",
        on(
            way,
            Role(
                "talker",
                publish=(Publish("/a", keep_all=True, size=300_000),),
                wrapper=FULL_MEMORY,
            ),
            Role("reader", hear=(Hear("/a", keep_all=True),), wrapper=FULL_MEMORY),
        ),
        wait(3),
        around=OwnMounts(),
    )
    yield Case(
        f"{way}: a node in a forked child",
        on(
            way,
            Role("talker", publish=(Publish("/a", keep_all=True),), fork=True),
            Role("reader", hear=(Hear("/a", keep_all=True),)),
        ),
        wait(3),
        ("talker",),
    )


FULL_MEMORY = (
    "unshare",
    "--mount",
    "sh",
    "-c",
    'mount -t tmpfs -o size=64k none /dev/shm && exec "$@"',
    "sh",
)
"""Runs a command where ``/dev/shm`` has room for next to nothing; needs root."""


class OwnMounts(contextlib.AbstractContextManager[None]):
    """Nothing to set up, but the machine must allow mounts."""

    def __enter__(self) -> None:
        done = subprocess.run([*FULL_MEMORY, "true"], capture_output=True, text=True, check=False)
        if done.returncode:
            raise Skipped(f"no file system of its own: {done.stderr.strip()}")

    def __exit__(self, *_: object) -> None:
        pass


def routers() -> Iterator[Case]:
    """Yield what happens beside a router, and beside ROS 2 nodes with their lease of 60 s."""
    yield Case(
        "router killed and replaced, all hear all",
        (ROUTER, *on("Zenoh", *members(3))),
        replace("router", after_s=3.0),
        loss="any",
        short=True,
    )
    for seconds in RETURNS_S:
        yield Case(
            f"router, one of three frozen {seconds} s, all hear all",
            (ROUTER, *on("Zenoh", *members(3))),
            freeze(("member2",), seconds),
            ("member2",),
            loss="any",
            lasts_s=seconds,
        )
        for name in ("member2", "ros0"):
            yield Case(
                f"router and two ROS 2 nodes, {name[:-1]} frozen {seconds} s, all hear all",
                (ROUTER, *members(3, ros=2)),
                freeze((name,), seconds),
                (name,),
                loss="any",
                lasts_s=seconds,
            )


def all_cases() -> list[Case]:
    """Return every case."""
    cases = [
        case
        for way in WAYS
        for make in (freezes, kills, comings, crowds, outputs)
        for case in make(way)
    ]
    return [*cases, *routers(), *host_cases()]
