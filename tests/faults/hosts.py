"""Two hosts as network namespaces, connected by a cable that can fail."""

from __future__ import annotations

import asyncio
import itertools
import os
import subprocess
from collections.abc import Iterable, Iterator
from typing import Any

import msgspec

from tests.faults.faults import Fault, replace
from tests.faults.harness import Case, Skipped, Stage
from tests.faults.roles import Hear, Publish, Role

__all__ = ["ADDRESSES", "NAMING", "ROUTER", "TwoHosts", "host_cases"]

ADDRESSES = ("10.213.0.1", "10.213.0.2")
PORT = 7447


def ip(*words: str) -> None:
    """Run ``ip``, or ``tc`` within a namespace.

    Raises:
        Skipped: The machine cannot do it.
    """
    try:
        done = subprocess.run(["ip", *words], capture_output=True, text=True, check=False)
    except FileNotFoundError as error:
        raise Skipped("there is no ip command") from error
    if done.returncode:
        raise Skipped(f"ip {' '.join(words)}: {done.stderr.strip()}")


class TwoHosts:
    """Two namespaces and a cable, created before the processes of a case and removed after them.

    Attributes:
        names: The names of the namespaces, in the order of `ADDRESSES`.
    """

    _numbers = itertools.count()

    def __init__(self) -> None:
        tag = f"{os.getpid() % 100_000}x{next(self._numbers)}"
        self.names = (f"aionode{tag}a", f"aionode{tag}b")
        self._devices = (f"v{tag}a", f"v{tag}b")

    def __enter__(self) -> None:
        try:
            for name in self.names:
                ip("netns", "add", name)
                ip("-n", name, "link", "set", "lo", "up")
            one, other = self._devices
            ip("link", "add", one, "type", "veth", "peer", "name", other)
            for name, device, address in zip(self.names, self._devices, ADDRESSES, strict=True):
                ip("link", "set", device, "netns", name)
                ip("-n", name, "address", "add", f"{address}/24", "dev", device)
                ip("-n", name, "link", "set", device, "up")
        except Skipped:
            self.__exit__()
            raise

    def __exit__(self, *_: object) -> None:
        for name in self.names:  # the cable goes with them
            subprocess.run(["ip", "netns", "delete", name], capture_output=True, check=False)

    def within(self, host: int, role: Role) -> Role:
        """Return a role placed on a host."""
        env = {"AIONODE_LINK": "off", "AIONODE_ROUTER_PORT": str(PORT), **role.env}
        wrapper = ("ip", "netns", "exec", self.names[host])
        return msgspec.structs.replace(role, env=env, wrapper=wrapper)

    def placed(self, roles: Iterable[Role]) -> tuple[Role, ...]:
        """Return roles placed on the hosts with which their names end."""
        return tuple(self.within(int(role.name.endswith("there")), role) for role in roles)

    def cut(self, seconds: float) -> Fault:
        """Unplug the cable for some time, which both hosts notice."""

        async def strike(stage: Stage) -> None:
            ip("-n", self.names[0], "link", "set", self._devices[0], "down")
            await asyncio.sleep(seconds)
            ip("-n", self.names[0], "link", "set", self._devices[0], "up")

        return strike

    def swallow(self, seconds: float) -> Fault:
        """Lose all packets for some time, like a radio link out of range: no host notices."""
        ends = list(zip(self.names, self._devices, reversed(ADDRESSES), strict=True))

        async def strike(stage: Stage) -> None:
            for name, device, other in ends:  # to a hardware address that no host has
                unused = ("lladdr", "02:00:00:00:00:01", "nud", "permanent")
                ip("-n", name, "neigh", "replace", other, "dev", device, *unused)
            await asyncio.sleep(seconds)
            for name, device, other in ends:
                ip("-n", name, "neigh", "delete", other, "dev", device)

        return strike

    def shape(self, seconds: float, *words: str) -> Fault:
        """Impair the cable for some time, by `tc qdisc` at both ends."""

        async def strike(stage: Stage) -> None:
            for verb in ("add", "delete"):
                for name, device in zip(self.names, self._devices, strict=True):
                    command = ("tc", "qdisc", verb, "dev", device, "root", *words)
                    ip("netns", "exec", name, *command)
                await asyncio.sleep(seconds if verb == "add" else 0)

        return strike


def member(name: str, **options: Any) -> Role:
    """Return a process that receives from all others of its kind."""
    return Role(
        name,
        publish=(Publish("/hello", period_s=0.05),),
        hear=(Hear("/hello", depth=1000),),
        **options,
    )


ROUTER = Role("router here", router=f"tcp/0.0.0.0:{PORT}")
NAMING: dict[str, str] = {"ROS_STATIC_PEERS": ADDRESSES[0]}
"""Messages of a process that have to reach the other host, which has the only router."""

TALKING = (
    Role(
        "here",
        publish=(Publish("/hello"), Publish("/all", keep_all=True)),
        hear=(Hear("/hello", depth=1000),),
        serve="/add",
    ),
    Role(
        "there",
        publish=(Publish("/hello"),),
        hear=(Hear("/hello", depth=1000), Hear("/all", keep_all=True)),
        call="/add",
    ),
)

ONE_ROUTER = (
    ROUTER,
    TALKING[0],
    msgspec.structs.replace(TALKING[1], env=NAMING),
    member("ros_here", ros=True),
    member("named_there", env=NAMING),
    member("plain_there"),
)
"""A robot with its router and a ROS 2 node, and a laptop whose user names the robot."""

KEEPING = (
    ROUTER,
    Role("here", publish=(Publish("/all", keep_all=True, period_s=0.05),)),
    Role("there", hear=(Hear("/all", keep_all=True),), env=NAMING),
)
"""Publishers and subscriptions that may not lose anything."""

TWO_ROUTERS = (
    ROUTER,
    Role("router there", router=f"tcp/0.0.0.0:{PORT}", connect=f"tcp/{ADDRESSES[0]}:{PORT}"),
    *TALKING,
)


def host_cases() -> Iterator[Case]:
    """Yield what happens between two hosts."""
    shapes: list[tuple[str, float | tuple[str, ...]]] = [
        *((f"is cut {seconds} s", seconds) for seconds in (3, 14, 70)),
        *((f"swallows everything for {seconds} s", -seconds) for seconds in (3, 14, 70)),
        ("delays 100 ms for 5 s", ("netem", "delay", "100ms", "20ms")),
        ("loses 5 % for 5 s", ("netem", "loss", "5%")),
        ("carries 1 Mbit/s for 5 s", ("tbf", "rate", "1mbit", "burst", "10kb", "latency", "50ms")),
    ]
    for what, how in shapes:
        for roles, where in ((TWO_ROUTERS, "a router on each"), (ONE_ROUTER, "one router")):
            if roles is ONE_ROUTER and isinstance(how, tuple):
                continue
            hosts = TwoHosts()
            if isinstance(how, tuple):
                strike = hosts.shape(5, *how)
            else:
                strike = hosts.cut(how) if how > 0 else hosts.swallow(-how)
            yield Case(
                f"two hosts, {where}, the cable {what}",
                hosts.placed(roles),
                strike,
                loss="any",
                lasts_s=5 if isinstance(how, tuple) else abs(how),
                around=hosts,
                short=how == -3 and roles is ONE_ROUTER,
            )
    for seconds in (3, 14, 70):
        hosts = TwoHosts()
        yield Case(
            f"two hosts, KEEP_ALL, the cable swallows everything for {seconds} s",
            hosts.placed(KEEPING),
            hosts.swallow(seconds),
            loss="none",
            lasts_s=seconds,
            around=hosts,
        )
    hosts = TwoHosts()
    yield Case(
        "two hosts, one router, the process that links them killed and replaced",
        hosts.placed(ONE_ROUTER),
        replace("there"),
        loss="any",
        around=hosts,
    )
