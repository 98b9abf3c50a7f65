"""Two hosts, as network namespaces with a cable between them, and what happens to the cable."""

from __future__ import annotations

import asyncio
import os
import subprocess
from collections.abc import Iterator

import msgspec

from tests.faults.faults import Fault
from tests.faults.harness import Case, Skipped, Stage
from tests.faults.roles import Hear, Publish, Role

__all__ = ["host_cases"]

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
    """Two namespaces and a cable; made before the processes of a case, and removed after them.

    Attributes:
        names: Of the namespaces; each has the address of its place in `ADDRESSES`.
    """

    def __init__(self, number: int) -> None:
        tag = f"{os.getpid() % 100_000}x{number}"
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
        """Return a role as one on a host."""
        env = {"AIONODE_LINK": "off", "AIONODE_ROUTER_PORT": str(PORT), **role.env}
        wrapper = ("ip", "netns", "exec", self.names[host])
        return msgspec.structs.replace(role, env=env, wrapper=wrapper)

    def cut(self, seconds: float) -> Fault:
        """Pull the cable out for some time."""

        async def strike(stage: Stage) -> None:
            ip("-n", self.names[0], "link", "set", self._devices[0], "down")
            await asyncio.sleep(seconds)
            ip("-n", self.names[0], "link", "set", self._devices[0], "up")

        return strike

    def shape(self, seconds: float, *words: str) -> Fault:
        """Let the cable be bad for some time: what `tc qdisc` says, on both of its ends."""

        async def strike(stage: Stage) -> None:
            for verb in ("add", "delete"):
                for name, device in zip(self.names, self._devices, strict=True):
                    command = ("tc", "qdisc", verb, "dev", device, "root", *words)
                    ip("netns", "exec", name, *command)
                await asyncio.sleep(seconds if verb == "add" else 0)

        return strike


def host_cases() -> Iterator[Case]:
    """Yield what happens to the cable between two hosts with a router on each of them."""
    shapes: list[tuple[str, float | tuple[str, ...]]] = [
        *((f"is cut {seconds} s", seconds) for seconds in (3, 14, 70)),
        ("delays 100 ms for 5 s", ("netem", "delay", "100ms", "20ms")),
        ("loses 5 % for 5 s", ("netem", "loss", "5%")),
        ("carries 1 Mbit/s for 5 s", ("tbf", "rate", "1mbit", "burst", "10kb", "latency", "50ms")),
    ]
    for number, (what, how) in enumerate(shapes):
        hosts = TwoHosts(number)
        strike = hosts.shape(5, *how) if isinstance(how, tuple) else hosts.cut(how)
        for_all = Hear("/hello", depth=1000)
        roles = (
            Role("router here", router=f"tcp/0.0.0.0:{PORT}"),
            Role(
                "router there",
                router=f"tcp/0.0.0.0:{PORT}",
                env={"ZENOH_CONFIG_OVERRIDE": f'connect/endpoints=["tcp/{ADDRESSES[0]}:{PORT}"]'},
            ),
            Role(
                "here",
                publish=(Publish("/hello"), Publish("/all", keep_all=True)),
                hear=(for_all,),
                serve="/add",
            ),
            Role(
                "there",
                publish=(Publish("/hello"),),
                hear=(for_all, Hear("/all", keep_all=True)),
                call="/add",
            ),
        )
        yield Case(
            f"two hosts, the cable {what}",
            tuple(hosts.within(int(role.name.endswith("there")), role) for role in roles),
            strike,
            loss="any",
            lasts_s=5 if isinstance(how, tuple) else how,
            around=hosts,
        )
