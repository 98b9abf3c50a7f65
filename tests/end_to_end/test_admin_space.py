"""No router's admin space is queried, as that could lock its routing table forever."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest
import zenoh  # noqa: TID251  # plays the router and who listens behind it, without aionode

from tests.end_to_end.process import Process, member
from tests.support.peers import ros_router, router_client

CONTROL = "@/control/router"


class Overheard:
    """Records queries and puts under ``@/`` by any session behind the router."""

    def __init__(self) -> None:
        self.keys: list[str] = []
        self._control = threading.Event()

    def take(self, asked: zenoh.Query | zenoh.Sample) -> None:
        """Record one key; from any thread."""
        key = str(asked.key_expr)
        self.keys.append(key)
        if key == CONTROL:
            self._control.set()

    def all(self, session: zenoh.Session) -> list[str]:
        """Return all keys before a final query of the test."""
        list(session.get(CONTROL, timeout=1))
        assert self._control.wait(50)
        return self.keys


@contextmanager
def router_with_a_listener() -> Iterator[tuple[zenoh.Session, Overheard]]:
    """A ROS router, and a session that answers for every admin space behind it."""
    overheard = Overheard()
    with ExitStack() as stack:
        router = ros_router()
        stack.callback(router.close)
        port = os.environ["AIONODE_ROUTER_PORT"]
        listener = stack.enter_context(router_client(port))
        listener.declare_queryable("@/**", overheard.take)
        listener.declare_subscriber("@/**", overheard.take)
        yield stack.enter_context(router_client(port)), overheard


@pytest.mark.slow
@pytest.mark.parametrize("link", ["on", pytest.param("off", marks=pytest.mark.stress)])
def test_nodes_and_commands_ask_no_admin_space(link: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two nodes with or without a link, commands of a user, and the doctor.

    A router holds its routing table's lock while it answers, and acquires it again for each reply:
    with a declaration in between, no process can join any more (zenoh 1.8 to 1.10).
    """
    monkeypatch.setenv("AIONODE_LINK", link)
    with router_with_a_listener() as (asking, overheard), ExitStack() as stack:
        one, two = (stack.enter_context(member(name)) for name in ("one", "two"))
        one.expect("open", "heard two")
        two.expect("open", "heard one")
        commands = [
            stack.enter_context(Process("-m", "aionode", *command.split()))
            for command in ("topic list", "node list", "doctor", "doctor /hello")
        ]
        for command in commands:
            command.rest()
        one.stop()
        two.stop()

        assert overheard.all(asking) == [CONTROL]
