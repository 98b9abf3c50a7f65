"""The network of a context: how environment and arguments become a Zenoh configuration."""

from __future__ import annotations

import json
import os
from typing import Any

import pytest
import zenoh  # noqa: TID251  # asks Zenoh whether it knows the settings

from aionode.engine.transport.network import (
    DOMAINS_WITH_PORTS,
    MEETING_PORTS,
    ROUTER_PORT,
    DiscoveryRange,
    Network,
    domain_of_port,
    is_near,
    network_from,
    new_participant,
    pid_of,
)
from aionode.engine.transport.zenoh.connections.config import probed_ports
from aionode.engine.transport.zenoh.session.settings import (
    GOSSIPING,
    Neighbours,
    router_settings,
    session_settings,
)
from aionode.errors import ConfigurationError

H1, H2, H3 = MEETING_PORTS


def test_nothing_set_means_this_machine_and_domain_0() -> None:
    """Programs in two terminals find each other without configuration."""
    assert network_from({}) == Network(
        domain_id=0,
        discovery_range=DiscoveryRange.LOCALHOST,
        override_source="ZENOH_CONFIG_OVERRIDE",
    )


@pytest.mark.parametrize("text", ["", "0", "00", " 0 "])
def test_an_empty_variable_is_none(text: str) -> None:
    """In a shell, setting a variable to nothing is a common way to unset it."""
    assert network_from({"ROS_DOMAIN_ID": text}).domain_id == 0


def test_arguments_win_over_the_environment() -> None:
    """A program knows better than the shell that started it."""
    environ = {
        "ROS_DOMAIN_ID": "1",
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF",
        "ROS_STATIC_PEERS": "a",
        "ZENOH_SESSION_CONFIG_URI": "/a.json5",
    }
    network = network_from(
        environ,
        domain_id=2,
        discovery_range="subnet",
        static_peers=["tcp/b:1"],
        config="/b.json5",
    )

    assert network.domain_id == 2
    assert network.discovery_range is DiscoveryRange.SUBNET
    assert network.static_peers == ("tcp/b:1",)
    assert network.config_file == "/b.json5"


@pytest.mark.parametrize(
    ("localhost_only", "expected"),
    [
        ("1", (DiscoveryRange.LOCALHOST, ())),
        ("0", (DiscoveryRange.SUBNET, ("tcp/a:1",))),
        ("", (DiscoveryRange.SUBNET, ("tcp/a:1",))),
    ],
)
def test_localhost_only_overrules_the_variables_that_replaced_it(
    localhost_only: str, expected: tuple[DiscoveryRange, tuple[str, ...]]
) -> None:
    """As in ROS 2 since Iron, where it is deprecated; Humble has no other variable."""
    environ = {
        "ROS_LOCALHOST_ONLY": localhost_only,
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",
        "ROS_STATIC_PEERS": "tcp/a:1",
    }
    network = network_from(environ)

    assert (network.discovery_range, network.static_peers) == expected
    assert network_from(environ, static_peers=["tcp/b:1"]).static_peers == ("tcp/b:1",)


@pytest.mark.parametrize(
    ("environ", "named"),
    [
        ({"ROS_DOMAIN_ID": "abc"}, r"ROS_DOMAIN_ID: 'abc' given; use an integer from 0 to"),
        ({"ROS_DOMAIN_ID": "-1"}, "ROS_DOMAIN_ID: '-1' given"),
        ({"ROS_DOMAIN_ID": "1_0"}, "ROS_DOMAIN_ID: '1_0' given"),
        ({"ROS_DOMAIN_ID": "4294967296"}, "ROS_DOMAIN_ID: '4294967296' given"),
        (
            {"ROS_AUTOMATIC_DISCOVERY_RANGE": "WORLD"},
            "ROS_AUTOMATIC_DISCOVERY_RANGE: 'WORLD' given; use one of OFF, LOCALHOST, SUBNET",
        ),
        ({"ROS_STATIC_PEERS": "a;b:c"}, "ROS_STATIC_PEERS: 'c' given; use a TCP port"),
        ({"ROS_STATIC_PEERS": "a b"}, "ROS_STATIC_PEERS: 'a b' given; use a host, host:port or"),
        ({"ROS_STATIC_PEERS": "tcp/"}, "ROS_STATIC_PEERS: 'tcp/' given"),
        (
            {"ZENOH_CONFIG_OVERRIDE": "mode"},
            "ZENOH_CONFIG_OVERRIDE: 'mode' given; use settings such",
        ),
        ({"AIONODE_MEETING_PORTS": "1,x"}, "AIONODE_MEETING_PORTS: 'x' given; use a TCP port"),
        ({"AIONODE_ROUTER_PORT": "0"}, "AIONODE_ROUTER_PORT: '0' given; use a TCP port"),
    ],
)
def test_an_error_names_the_variable_what_it_says_and_what_fits(
    environ: dict[str, str], named: str
) -> None:
    """Whoever set the variable reads the error, far from the code."""
    with pytest.raises(ConfigurationError, match=named):
        network_from(environ)


def test_an_error_names_the_argument() -> None:
    """The check is the same, only the source differs."""
    with pytest.raises(ConfigurationError, match="domain_id: '-1' given"):
        network_from({}, domain_id=-1)
    with pytest.raises(TypeError, match="domain_id: '5' given; use an integer"):
        network_from({}, domain_id="5")  # type: ignore[arg-type]  # the error is the point
    with pytest.raises(ConfigurationError, match="discovery_range: 'WORLD' given"):
        network_from({}, discovery_range="WORLD")
    with pytest.raises(ConfigurationError, match="static_peers: 'a b' given"):
        network_from({}, static_peers=["a b"])


@pytest.mark.parametrize(
    ("peer", "endpoints"),
    [
        ("10.0.0.7", [f"tcp/10.0.0.7:{p}" for p in (ROUTER_PORT, H1, H2, H3)]),
        ("robot:7000", ["tcp/robot:7000"]),
        ("tls/robot:7000", ["tls/robot:7000"]),
        ("[fe80::1]:7000", ["tcp/[fe80::1]:7000"]),
        ("fe80::1", [f"tcp/[fe80::1]:{p}" for p in (ROUTER_PORT, H1, H2, H3)]),
    ],
)
def test_a_peer_is_a_host_a_port_or_an_endpoint(peer: str, endpoints: list[str]) -> None:
    """Without a port: wherever a router or an aionode process could listen."""
    assert list(network_from({"ROS_STATIC_PEERS": f"; {peer};"}).static_peers) == endpoints


def test_meeting_ports_beyond_three_are_spare() -> None:
    """They are used if other programs occupy all three."""
    network = network_from({"AIONODE_MEETING_PORTS": "1,2,3,4,5"})

    assert network.meeting_ports == (1, 2, 3)
    assert network.spare_ports == (4, 5)


def test_each_domain_has_ports_of_its_own() -> None:
    """Processes of other domains are not connected, and cost nothing."""
    domains = [network_from({}, domain_id=domain_id) for domain_id in range(DOMAINS_WITH_PORTS)]
    ports = [p for each in domains for p in (*each.meeting_ports, *each.spare_ports)]

    assert len(set(ports)) == len(ports)
    assert max(ports) < 32_768  # # the start of the ephemeral ports
    assert [domain_of_port(each.meeting_ports[0]) for each in domains] == list(
        range(DOMAINS_WITH_PORTS)
    )
    assert domains[0].meeting_ports == MEETING_PORTS


@pytest.mark.parametrize("domain_id", [DOMAINS_WITH_PORTS + 3, 2**32 - 1])
def test_domains_beyond_those_with_ports_share_them(domain_id: int) -> None:
    """ROS allows four billion domains."""
    shared = network_from({}, domain_id=domain_id % DOMAINS_WITH_PORTS)

    assert network_from({}, domain_id=domain_id).meeting_ports == shared.meeting_ports


def test_all_domains_meet_at_ports_that_are_set() -> None:
    """Domains can then be joined on purpose."""
    environ = {"AIONODE_MEETING_PORTS": "1,2,3"}

    assert network_from(environ, domain_id=7).meeting_ports == (1, 2, 3)


@pytest.mark.parametrize("first", [0, 17448, 17450, 17449 + 6 * DOMAINS_WITH_PORTS])
def test_other_ports_belong_to_no_domain(first: int) -> None:
    """They were configured explicitly, or belong to another program."""
    assert domain_of_port(first) is None


def settings(network: Network, *answering: int) -> dict[str, Any]:
    """Return the settings while other processes listen on these ports."""
    return session_settings(network, answering)


def dialled(found: dict[str, Any]) -> list[str]:
    """Return where a session dials, without what is set for each endpoint."""
    return [endpoint.partition("#")[0] for endpoint in found["connect/endpoints"]]


def test_a_session_dials_those_that_are_listed_and_listens_at_one_port() -> None:
    """A second connection to the same session would fail forever."""
    found = session_settings(Network(), (), Neighbours(H1, (40001, 40002)))

    assert found["listen/endpoints"] == [f"tcp/127.0.0.1:{H1}"]
    assert dialled(found) == [f"tcp/127.0.0.1:{port}" for port in (40001, 40002, ROUTER_PORT)]


@pytest.mark.parametrize(
    ("network", "port", "introduces"),
    [
        (Network(), 40000, False),
        (Network(), H2, True),
        (Network(discovery_range=DiscoveryRange.SUBNET), 40000, True),
        (Network(static_peers=("tcp/127.0.0.1:7000",)), 40000, True),
        (Network(static_peers=("tcp/10.0.0.7:7000",)), 40000, False),
    ],
    ids=["listed", "at a meeting port", "subnet", "near peer", "far peer"],
)
def test_a_listed_session_introduces_peers_only_if_some_cannot_be_listed(
    network: Network, port: int, *, introduces: bool
) -> None:
    """Otherwise each would announce every newcomer to all others, as routers of ROS do."""
    others = tuple(range(41000, 41000 + GOSSIPING))
    found = session_settings(network, (), Neighbours(port, others))

    target = found.get("scouting/gossip/target", {"peer": ["router", "peer"]})
    assert ("peer" in target["peer"]) is introduces
    assert "router" in target["peer"]


def test_the_first_sessions_introduce_others_wherever_they_listen() -> None:
    """More than one does, because gossip is lost on a connection that is still being made."""
    few = tuple(range(41000, 41000 + GOSSIPING - 1))

    assert "scouting/gossip/target" not in session_settings(Network(), (), Neighbours(40000, few))


def test_a_session_that_connects_with_many_may_be_silent_for_longer() -> None:
    """Otherwise sessions connected early would give it up while it connects to the last ones."""
    lease = "transport/link/tx/lease"

    assert session_settings(Network(), ())[lease] == 10_000
    assert session_settings(Network(), (), Neighbours(40000, ()))[lease] == 10_000
    many = Neighbours(40000, tuple(range(41000, 41050)))
    assert session_settings(Network(), (), many)[lease] == 35_000


def test_no_number_of_listed_sessions_makes_a_lease_longer_than_that_of_ros_2() -> None:
    """Any local user can list any number of processes that never answer."""
    lies = Neighbours(40000, tuple(range(41000, 42000)))

    assert session_settings(Network(), (), lies)["transport/link/tx/lease"] == 60_000


def test_a_session_that_the_others_can_look_at_is_silent_for_long() -> None:
    """Keep-alives are what wakes an idle process; another machine cannot look."""
    keys = "transport/link/tx/lease", "transport/link/tx/keep_alive"
    others = Neighbours(40000, ())

    near = session_settings(Network(), (), others, is_watched=True)
    far = session_settings(
        Network(discovery_range=DiscoveryRange.SUBNET), (), others, is_watched=True
    )

    assert [near[key] for key in keys] == [100_000, 2]
    assert [far[key] for key in keys] == [10_000, 4]


def test_among_many_a_session_that_the_others_can_look_at_is_silent_for_longer() -> None:
    """Each idle process gets the signs of life of all others."""
    many = Neighbours(40000, tuple(range(41000, 41100)))
    lies = Neighbours(40000, tuple(range(41000, 42000)))

    leases = [
        session_settings(Network(), (), others, is_watched=True)["transport/link/tx/lease"]
        for others in (many, lies)
    ]

    assert leases == [3_100_000, 3_600_000]


def test_an_id_names_its_process() -> None:
    """Others of its machine look whether it is stopped."""
    assert pid_of(new_participant()) == os.getpid()


@pytest.mark.parametrize("other", ["", "a1", "f" * 32, "g" * 32])
def test_an_id_of_other_software_names_none(other: str) -> None:
    """It may have any length and digits."""
    assert pid_of(other) is None


@pytest.mark.parametrize("number", ["00000000", "ffffffff", "80000000", "in a tok"])
def test_an_id_with_a_number_that_no_process_has_names_none(number: str) -> None:
    """A peer may choose it, and the system would take 0 for all processes of a group."""
    own = new_participant()

    assert pid_of(own[:17] + number + own[25:]) is None


def test_the_first_process_takes_the_first_meeting_port_and_dials_the_others() -> None:
    """Later processes find it there; the port of a ROS router is never taken."""
    found = settings(Network())

    assert found["listen/endpoints"] == [f"tcp/127.0.0.1:{H1}", "tcp/127.0.0.1:0"]
    assert dialled(found) == [f"tcp/127.0.0.1:{p}" for p in (H2, H3, ROUTER_PORT)]


def test_a_free_meeting_port_is_taken_over() -> None:
    """When the process that held it has gone, newcomers can still meet there."""
    found = settings(Network(), H1, H3)

    assert found["listen/endpoints"][0] == f"tcp/127.0.0.1:{H2}"
    assert f"tcp/127.0.0.1:{H2}" not in dialled(found)


def test_without_a_free_meeting_port_all_are_dialled() -> None:
    """This applies to the fourth process and all after it."""
    found = settings(Network(), H1, H2, H3)

    assert found["listen/endpoints"] == ["tcp/127.0.0.1:0"]
    assert len(dialled(found)) == 4


@pytest.mark.parametrize("discovery_range", DiscoveryRange)
def test_only_subnet_listens_beyond_loopback(discovery_range: DiscoveryRange) -> None:
    """No other machine can reach a node unless its user asks for it."""
    found = settings(Network(discovery_range=discovery_range))
    beyond = [e for e in found["listen/endpoints"] if "127.0.0.1" not in e]

    assert bool(beyond) == (discovery_range is DiscoveryRange.SUBNET)
    assert found["scouting/multicast/enabled"] == bool(beyond)


def test_off_neither_listens_nor_dials() -> None:
    """Static peers are not dialled either."""
    network = Network(discovery_range=DiscoveryRange.OFF, static_peers=("tcp/a:1",))

    assert probed_ports(network) == ()
    assert settings(network)["listen/endpoints"] == []
    assert settings(network)["connect/endpoints"] == []


def test_the_system_default_is_that_of_rmw_zenoh() -> None:
    """Only a router on this machine introduces peers."""
    network = Network(discovery_range=DiscoveryRange.SYSTEM_DEFAULT)

    assert probed_ports(network) == (ROUTER_PORT,)
    assert dialled(settings(network)) == [f"tcp/127.0.0.1:{ROUTER_PORT}"]


def test_a_session_dials_static_peers_of_its_own_machine_only() -> None:
    """A router of the machine dials the others, and the session finds that router as always."""
    network = Network(static_peers=("tls/robot:7447", "tls/localhost:7448"))
    found = settings(network)

    assert dialled(found)[-2:] == [f"tcp/127.0.0.1:{ROUTER_PORT}", "tls/localhost:7448"]
    assert found["listen/endpoints"][0] == f"tcp/127.0.0.1:{H1}"
    assert network.far_peers == ("tls/robot:7447",)


@pytest.mark.parametrize(
    ("endpoint", "near"),
    [
        ("tcp/127.0.0.1:1", True),
        ("tcp/[::1]:1", True),
        ("tcp/[::ffff:127.0.0.1]:1", True),
        ("tls/localhost:1?so_sndbuf=1", True),
        ("unixsock-stream//tmp/a", True),
        ("tcp/10.0.0.1:1", False),
        ("tcp/[fe80::1]:1", False),
        ("tls/robot.local:1#iface=lo", False),
    ],
)
def test_what_is_near_is_seen_from_the_text_of_an_endpoint(endpoint: str, near: bool) -> None:
    """Names are not resolved: a router that dials its own machine does no harm."""
    assert is_near(endpoint) == near


def test_a_file_takes_the_place_of_all_settings() -> None:
    """Its author decides; only overrides are applied on top of it."""
    network = network_from(
        {"ZENOH_SESSION_CONFIG_URI": "/a.json5", "ZENOH_CONFIG_OVERRIDE": "mode='client';x/y=[1]"}
    )

    assert probed_ports(network) == ()
    assert session_settings(network, ()) == {}
    assert network.overrides == (("mode", "'client'"), ("x/y", "[1]"))


def test_single_settings_win_over_the_environment() -> None:
    """They are applied last, as JSON."""
    network = network_from(
        {"ZENOH_CONFIG_OVERRIDE": "a=1"}, config={"transport/shared_memory/enabled": False}
    )

    assert network.overrides == (("a", "1"), ("transport/shared_memory/enabled", "false"))


@pytest.mark.parametrize(("name", "usual"), [("queue_bytes", 32 << 20), ("graph_bytes", 64 << 20)])
def test_limits_in_bytes_are_set_by_argument_or_environment(name: str, usual: int) -> None:
    """A robot that sends clouds of a gigabyte on purpose needs higher limits."""
    variable = f"AIONODE_{name.upper()}"
    environ = {variable: "1000000"}

    def limit(environ: dict[str, str], **given: Any) -> Any:
        return getattr(network_from(environ, **given), name)

    assert limit({}) == usual
    assert limit(environ) == 1_000_000
    assert limit(environ, **{name: 70_000}) == 70_000
    for bad in ("32M", "-1", "1000", "9" * 30):
        with pytest.raises(ConfigurationError, match=rf"{variable}: .* at least 65536"):
            network_from({variable: bad})
    with pytest.raises(ConfigurationError, match=f"{name}: '5' given"):
        limit({}, **{name: 5})
    with pytest.raises(TypeError, match=f"{name}: '5' given"):
        limit({}, **{name: "5"})


@pytest.mark.parametrize(
    "found",
    [
        *(settings(Network(discovery_range=r)) for r in DiscoveryRange),
        router_settings(["tcp/127.0.0.1:0"], ["tcp/robot:7447"]),
    ],
)
def test_zenoh_knows_every_setting(found: dict[str, Any]) -> None:
    """Otherwise a key path renamed by a release of Zenoh would fail at the first start."""
    config = zenoh.Config()
    for key, value in found.items():
        config.insert_json5(key, json.dumps(value))
