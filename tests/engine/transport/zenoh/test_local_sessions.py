"""The list of a machine's sessions: who is in it, and for how long."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest

from aionode.engine.transport import network as _network
from aionode.engine.transport.network import new_participant
from aionode.engine.transport.zenoh.session.local_sessions import (
    announce,
    groups,
    holder_of,
    listed,
    listening,
    processes,
    reserve_port,
)

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="only Linux lists the sockets of others"
)


@pytest.fixture
def group() -> int:
    """Return a number that no other test has."""
    return 1024 + os.getpid() % 16_384


def test_a_session_is_listed_with_its_port_until_it_is_closed(group: int) -> None:
    """Killing its process has the same effect, since that closes everything."""
    with closing(announce(group, 4711)), closing(announce(group, 4712)):
        assert listed(group) == {4711, 4712}

    assert listed(group) == set()


def test_a_session_is_listed_with_its_process(group: int) -> None:
    """A command can name the process that does not answer."""
    with closing(announce(group, 4711)):
        found = processes(group)

    assert list(found) == [4711]
    assert found[4711].pid == os.getpid()
    assert found[4711].command
    assert not found[4711].is_stopped


def test_a_port_is_among_those_where_something_listens_until_it_is_closed() -> None:
    """A session is listed before it listens; one that never does is no session."""
    with closing(reserve_port("127.0.0.1")) as reserved:
        port = reserved.getsockname()[1]
        assert port not in (listening() or ())
        reserved.listen()
        assert port in (listening() or ())

    assert port not in (listening() or ())


def test_sessions_of_other_groups_are_not_listed(group: int) -> None:
    """They listen at other ports, and need not be reachable."""
    with closing(announce(group + 16_384, 4711)):
        assert listed(group) == set()


def test_the_groups_with_sessions_are_listed(group: int) -> None:
    """`aionode doctor` names their domains."""
    with closing(announce(group, 4711)), closing(announce(group + 16_384, 4711)):
        assert {group, group + 16_384} <= groups()

    assert group not in groups()


def test_a_session_is_not_listed_any_more_when_its_process_was_killed(group: int) -> None:
    """Nothing is left to be removed."""
    program = (
        "from aionode.engine.transport.zenoh.session.local_sessions import announce\n"
        f"presence = announce({group}, 4711)\n"
        "print('there', flush=True)\n"
        "input()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "there\n"
        assert listed(group) == {4711}
        process.kill()
        process.wait()

    assert listed(group) == set()


def test_nothing_that_is_sent_to_a_listed_session_is_kept(group: int) -> None:
    """Whichever user sends it."""
    with (
        closing(announce(group, 4711)) as presence,
        closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as one,
    ):
        one.sendto(b"anything", presence.getsockname())

        with pytest.raises(BlockingIOError):
            presence.recv(100, socket.MSG_DONTWAIT)


def test_there_is_no_list_where_the_system_hides_it(
    group: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """As in a sandbox; gossip is used instead, and all others dial such a session."""
    monkeypatch.setattr(_network, "UDP_SOCKETS", tmp_path / "hidden")

    assert listed(group) is None
    assert new_participant()[0] == "1"


def test_later_ids_are_greater_and_have_no_leading_zero() -> None:
    """When gossip introduces two sessions, Zenoh has the one with the greater id dial."""
    early = [new_participant() for _ in range(3)]
    while (late := new_participant())[:13] == early[-1][:13]:
        pass

    assert max(early) < late
    assert {len(one) for one in (*early, late)} == {32}
    assert {one[0] for one in (*early, late)} == {"f"}


def test_a_reserved_port_can_be_listened_on_and_is_given_to_nobody_else() -> None:
    """Zenoh takes it before the reservation ends."""
    with closing(reserve_port("127.0.0.1")) as reserved, closing(socket.socket()) as zenoh:
        port = reserved.getsockname()[1]
        zenoh.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        zenoh.bind(("127.0.0.1", port))
        zenoh.listen()

        with closing(socket.create_connection(("127.0.0.1", port))):
            pass
        with closing(reserve_port("127.0.0.1")) as other:
            assert other.getsockname()[1] != port


def test_the_user_of_a_port_is_known() -> None:
    """It may be held by another user, who is not waited for."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        port = one.getsockname()[1]
        assert holder_of(port) == os.getuid()

    assert holder_of(port) is None
