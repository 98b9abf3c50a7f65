"""A node's traffic that is visible on the network, and clients refused by certificates."""

from __future__ import annotations

import stat
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import psutil
import pytest
import trustme

from tests.end_to_end.process import ROOT, Process, member
from tests.support.peers import free_ports

LOOPBACK = ("127.0.0.1", "::1")
CONFIGS = ROOT / "examples" / "security"


# Sockets


def open_ports(process: Process) -> set[tuple[str, str]]:
    """Return the addresses on which a process can be reached, with the protocol of each."""
    sockets = psutil.Process(process.pid).net_connections(kind="inet")
    return {
        ("tcp" if each.status == psutil.CONN_LISTEN else "udp", each.laddr.ip)
        for each in sockets
        if each.status in {psutil.CONN_LISTEN, psutil.CONN_NONE}
    }


@pytest.fixture
def runtime(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder for sockets; not one of pytest, whose paths are too long for sockets."""
    with TemporaryDirectory() as folder:
        monkeypatch.setenv("XDG_RUNTIME_DIR", folder)
        yield Path(folder)


@pytest.mark.usefixtures("runtime")
def test_nothing_listens_beyond_loopback() -> None:
    """By default no other host can even try, neither by TCP nor by UDP."""
    with member("one") as one, member("other") as other:
        one.expect("heard other")
        other.expect("heard one")
        for process in (one, other):
            found = open_ports(process)

            assert found
            assert {address for _, address in found} <= set(LOOPBACK)


@pytest.mark.usefixtures("runtime")
def test_no_connection_leaves_the_machine() -> None:
    """All connections end on this machine."""
    with member("one") as one, member("other") as other:
        one.expect("heard other")
        other.expect("heard one")
        connected = [
            each.raddr.ip
            for process in (one, other)
            for each in psutil.Process(process.pid).net_connections(kind="inet")
            if each.status == psutil.CONN_ESTABLISHED
        ]

    assert connected
    assert set(connected) <= set(LOOPBACK)


def test_the_sockets_of_links_are_in_a_folder_of_the_user_alone(
    runtime: Path,
) -> None:
    """Another user of the machine cannot even dial."""
    with member("one") as one, member("other") as other:
        one.expect("heard other")
        other.expect("heard one")
        paths = {
            Path(address)
            for process in (one, other)
            for each in psutil.Process(process.pid).net_connections(kind="unix")
            # A session is listed by the name of a socket without a path, which does not listen.
            if (address := str(each.laddr)) and not address.startswith("@")
        }

        assert {path.parent for path in paths} == {runtime / "aionode"}
        assert stat.S_IMODE((runtime / "aionode").stat().st_mode) == 0o700


def test_subnet_listens_on_every_interface(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """This shows that the other tests would notice it."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    with member("one") as one:
        one.expect("open")

        assert ("tcp", "0.0.0.0") in open_ports(one)  # noqa: S104  # what is looked for


def test_off_listens_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """No other process finds it."""
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF")
    with member("one") as one:
        one.expect("open")

        assert not open_ports(one)


# Certificates


Join = Callable[..., Process]


@contextmanager
def router(folder: Path, port: int) -> Iterator[Process]:
    """A router with TLS and access control, as the how-to runs it."""
    override = (CONFIGS / "router.txt").read_text(encoding="utf-8")
    env = {"ZENOH_CONFIG_OVERRIDE": override.replace("certs/", f"{folder}/")}
    words = ("-m", "aionode", "router", "--listen", f"tls/localhost:{port}")
    with Process(*words, env=env) as process:
        process.expect("Router is listening")
        yield process


def write(folder: Path, name: str, authority: trustme.CA, *, common_name: str) -> None:
    """Make a certificate and its key."""
    made = authority.issue_cert("localhost", common_name=common_name)
    made.private_key_pem.write_to_path(folder / f"{name}-key.pem")
    made.cert_chain_pems[0].write_to_path(folder / f"{name}.pem")


@pytest.fixture
def join(tmp_path: Path) -> Iterator[Join]:
    """Start a member that presents a certificate to the router, and dials only the router."""
    authority, other_authority = trustme.CA(), trustme.CA()
    authority.cert_pem.write_to_path(tmp_path / "ca.pem")
    write(tmp_path, "router", authority, common_name="router")
    write(tmp_path, "robot", authority, common_name="robot")
    write(tmp_path, "visitor", authority, common_name="visitor")
    write(tmp_path, "forged", other_authority, common_name="robot")
    (port,) = free_ports(1)
    session = (CONFIGS / "session.json5").read_text(encoding="utf-8")
    with ExitStack() as stack:
        stack.enter_context(router(tmp_path, port))

        def start(name: str, certificate: str, program: str = "member.py") -> Process:
            text = session.replace("router.local:7448", f"localhost:{port}")
            text = text.replace("certs/robot", f"certs/{certificate}")
            config = tmp_path / f"{name}.json5"
            config.write_text(text.replace("certs/", f"{tmp_path}/"), encoding="utf-8")
            env = {"ZENOH_SESSION_CONFIG_URI": str(config), "AIONODE_LINK": "off"}
            return stack.enter_context(Process(f"tests/end_to_end/{program}", name, env=env))

        yield start


def test_the_right_certificate_talks(join: Join) -> None:
    """Messages and calls, through the router."""
    one, other = join("one", "robot"), join("other", "robot")

    one.expect("heard other")
    other.expect("heard one")
    one.write("call other 7")
    one.expect("sum 7")


def test_a_certificate_that_access_control_does_not_allow_neither_hears_nor_is_heard(
    join: Join,
) -> None:
    """Even if it was there before the others."""
    one = join("one", "robot")
    wrong = join("wrong", "visitor")
    wrong.expect("open")
    other = join("other", "robot")
    one.expect("heard other")
    other.expect("heard one")

    for process in (one, other, wrong):
        process.stop()
    assert "heard wrong" not in {*one.rest(), *other.rest()}
    assert {line for line in wrong.rest() if line.startswith("heard")} <= {"heard wrong"}


def test_a_visitor_runs_the_node_of_its_rules_and_publishes_its_topic_alone(join: Join) -> None:
    """All of its messages arrive, and none of another topic."""
    robot = join("robot", "robot", "visitor_member.py")
    robot.expect("open")
    join("visitor", "visitor", "visitor_member.py")
    robot.expect("seen")

    for number in range(10):
        robot.expect(f"scan {number}")
    robot.stop()
    assert not [line for line in robot.rest() if line.startswith("chatter")]


def test_a_certificate_of_another_authority_is_refused(join: Join) -> None:
    """It does not even get a session, and the error says so."""
    join("wrong", "forged").expect("error: Zenoh: no session could be opened")
