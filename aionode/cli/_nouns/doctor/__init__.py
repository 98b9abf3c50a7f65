"""``aionode doctor``: a summary of the network, and why endpoints do not communicate."""

from __future__ import annotations

import asyncio
import os
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import click

from aionode._distribution import other_distribution
from aionode.cli._nouns.doctor.diagnosis import Finding, diagnose
from aionode.cli._nouns.doctor.routes import link_findings, pairs_of, query_links
from aionode.cli._nouns.doctor.transforms import transform_findings
from aionode.cli._nouns.doctor.work import findings_of_work
from aionode.cli._support import lookup
from aionode.cli._support.completion import complete_names
from aionode.cli._support.options import interfaces_option, json_option, ros2_options
from aionode.cli._support.session import run_verb, silent_processes
from aionode.engine.transport.network import DiscoveryRange, unheard_middleware
from aionode.errors import FAST_DDS_REMEDY, FAST_DDS_SILENCE
from aionode.graph import SERVICE_KINDS, TOPIC_KINDS, EndpointKind

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from aionode.cli._support.output import Output
    from aionode.engine.transport.network import Network
    from aionode.graph import EndpointInfo, NodeInfo
    from aionode.node import Node

__all__ = ["doctor", "doctor_command", "network_findings"]

PROBE_S = 0.2
"""Timeout for a router on this machine to accept a connection, in seconds; it takes 0.1 ms."""

ZENOH = "rmw_zenoh_cpp"


@click.command()
@interfaces_option
@click.argument("names", nargs=-1, shell_complete=complete_names("topic"))
@click.option(
    "--transform", nargs=2, metavar="TARGET SOURCE", help="Explain why this transform is missing."
)
@json_option
@ros2_options
def doctor_command(names: tuple[str, ...], transform: tuple[str, str] | None, json: bool) -> None:
    """Summarize the network, and find out why endpoints do not communicate, or are late.

    NAMES of nodes, topics and services restrict it to those, and show the route by which each
    publisher reaches each subscription. The exit status is 1 if a problem was found.
    """
    run_verb(
        lambda node, output: doctor(node, names, output=output, transform=transform), json=json
    )


async def doctor(
    node: Node,
    names: Sequence[str] = (),
    *,
    output: Output,
    transform: tuple[str, str] | None = None,
) -> int:
    """Print a summary of the network and its problems; return 1 if there is a problem, else 0.

    Args:
        node: The command's node.
        names: Consider only these nodes, topics and services, and show the routes of messages.
        output: Where to print.
        transform: The target and source frame of a transform that is missing.

    Raises:
        CommandError: one of the names does not exist.
    """
    network = node.context.network
    middleware = middleware_of(node)
    has_router = not middleware and await answers(network.router_port)
    nodes, endpoints = chosen(node, names)
    links = await query_links(node)
    bridges = bridges_of(node)
    domains = await other_domains(node)
    wanted = full_names(names)
    pairs = [
        pair
        for pair in pairs_of(endpoints, links)
        if not wanted or wanted & {pair.publisher.name, *pair.nodes}
    ]
    record = {
        "domain_id": network.domain_id,
        "other_domains": domains,
        "discovery_range": network.discovery_range.value,
        "static_peers": list(network.static_peers),
        "middleware": middleware,
        "router": has_router,
        "bridges": len(bridges),
        "participants": len({info.participant for info in nodes}),
        "nodes": len(nodes),
        "topics": count(endpoints, *TOPIC_KINDS),
        "services": count(endpoints, *SERVICE_KINDS),
        "links": len(links.pairs),
        "pairs": [pair.record() for pair in pairs],
    }
    lines = summary(record, network.router_port)
    if names:
        lines += [f"  {pair.text()}" for pair in pairs]
    output.item("\n".join(lines), record)
    findings = [silence_finding(who) for who in silent_processes(node)]
    findings += diagnose(nodes, endpoints)
    hashes = {end.type_hash for end in endpoints if not end.node.bridged}
    hint = other_distribution(node.context.ros_distro, hashes)
    if hint is not None:
        problem, remedy = hint.split(": ")
        findings.insert(0, Finding("problem", "ROS_DISTRO", problem, remedy))
    if not middleware:
        findings += link_findings(pairs)
        findings += bridge_findings(bridges)
        # The middleware set in the environment does not concern nodes reached through a bridge.
        environ = {} if bridges else os.environ
        findings += network_findings(
            network, environ, has_router=has_router, domains=domains, alone=not nodes
        )
    if not names:
        findings += await findings_of_work(node)
    if not names or transform is not None or "/tf" in wanted:
        findings += await transform_findings(node, transform)
    for finding in findings:
        output.item(
            f"\n{finding.severity}: {finding.subject}: {finding.text}\n  -> {finding.remedy}",
            asdict(finding),
        )
    problems = sum(finding.severity == "problem" for finding in findings)
    output.text(f"\n{problems} problem(s), {len(findings) - problems} hint(s)")
    return 1 if problems else 0


def silence_finding(who: str) -> Finding:
    """Return the finding for a process that does not answer."""
    return Finding(
        "problem",
        "process",
        f"{who}: its nodes are not in this list, and they do not answer",
        "resume it or end it",
    )


def summary(record: Mapping[str, Any], router_port: int) -> list[str]:
    """Return the summary of the network as lines of text."""
    if record["middleware"]:
        reached = [f"Middleware: {record['middleware']} (transport rcl)"]
    else:
        router = "answers" if record["router"] else "none"
        reached = [
            f"Router on this machine (port {router_port}): {router}",
            f"Bridges to DDS: {record['bridges'] or 'none'}",
        ]
    return [
        f"Domain: {record['domain_id']}",
        f"Other domains here: {', '.join(map(str, record['other_domains'])) or 'none'}",
        f"Discovery range: {record['discovery_range']}",
        f"Static peers: {', '.join(record['static_peers']) or 'none'}",
        *reached,
        f"Other processes: {record['participants']}",
        f"Nodes: {record['nodes']}",
        f"Topics: {record['topics']}",
        f"Services: {record['services']}",
        f"Pairs of linked processes: {record['links']}",
    ]


def count(endpoints: Sequence[EndpointInfo], *kinds: EndpointKind) -> int:
    """Count the distinct names of endpoints of the given kinds."""
    return len({endpoint.name for endpoint in endpoints if endpoint.kind in kinds})


def chosen(node: Node, names: Sequence[str]) -> tuple[list[NodeInfo], list[EndpointInfo]]:
    """Return the nodes and endpoints selected by `names`; all of them if there are none."""
    nodes = lookup.node_infos(node)
    endpoints = [e for e in lookup.endpoints(node) if not e.node.name.startswith("_")]
    if not names:
        return nodes, endpoints
    wanted = full_names(names)
    known = {info.fully_qualified_name for info in nodes} | {end.name for end in endpoints}
    for name in sorted(wanted - known):
        raise lookup.unknown("No node, topic or service", name, known, "node list")
    # Keep endpoints with similar names: a counterpart may be misspelled.
    of_nodes = {end.name for end in endpoints if end.node.fully_qualified_name in wanted}
    near = {
        name
        for name in {end.name for end in endpoints}
        if any(lookup.likeness(name, other) >= lookup.ALIKE for other in wanted | of_nodes)
    }
    return (
        [info for info in nodes if info.fully_qualified_name in wanted] or nodes,
        [end for end in endpoints if end.name in wanted | of_nodes | near],
    )


def full_names(names: Sequence[str]) -> set[str]:
    """Return the names with a leading slash."""
    return set(map(lookup.absolute, names))


def middleware_of(node: Node) -> str:
    """Return the middleware of the installed ROS 2 that the node uses; empty over Zenoh."""
    names = (getattr(transport, "middleware", "") for transport in node.context.transports)
    return next(filter(None, names), "")


async def other_domains(node: Node) -> list[int]:
    """Return the other domains on this machine, and those whose nodes can be reached."""
    found = [await transport.other_domains() for transport in node.context.transports]
    return sorted(frozenset().union(*found))


def bridges_of(node: Node) -> dict[str, bool]:
    """Return the Zenoh ids of the bridges, each with whether nodes on Fast DDS are behind it."""
    bridges: dict[str, bool] = {}
    for transport in node.context.transports:
        bridges |= getattr(transport, "dds_bridges", {})
    return bridges


def bridge_findings(bridges: Mapping[str, bool]) -> list[Finding]:
    """Return a finding if there are nodes behind bridges whose services do not answer."""
    if not any(bridges.values()):
        return []
    return [Finding("problem", "zenoh-bridge-ros2dds", FAST_DDS_SILENCE, FAST_DDS_REMEDY)]


async def answers(port: int) -> bool:
    """Return whether a port of this machine accepts connections."""
    try:
        async with asyncio.timeout(PROBE_S):
            _, writer = await asyncio.open_connection("127.0.0.1", port)
    except (OSError, TimeoutError):
        return False
    writer.close()
    return True


def network_findings(
    network: Network,
    environ: Mapping[str, str],
    *,
    has_router: bool,
    domains: Sequence[int],
    alone: bool,
) -> list[Finding]:
    """Return findings about settings that prevent discovery."""
    findings = []
    if domains and alone:
        others = ", ".join(map(str, domains))
        findings.append(
            Finding(
                "hint",
                "domain",
                f"there is no other node in domain {network.domain_id}, but there are programs in "
                f"domain {others}: domains do not communicate",
                f"set ROS_DOMAIN_ID={domains[0]}",
            )
        )
    wide = network.discovery_range
    if wide is DiscoveryRange.OFF and not network.static_peers:
        findings.append(
            Finding(
                "problem",
                "discovery range",
                "it is OFF, so no other nodes are discovered",
                "set ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST or SUBNET",
            )
        )
    elif wide is DiscoveryRange.SYSTEM_DEFAULT and not has_router:
        findings.append(
            Finding(
                "problem",
                "router",
                "nodes are discovered only through a router, and none answers on port "
                f"{network.router_port}",
                "start one: aionode router, or ros2 run rmw_zenoh_cpp rmw_zenohd",
            )
        )
    elif wide is DiscoveryRange.LOCALHOST and alone and not network.static_peers and not domains:
        findings.append(
            Finding(
                "hint",
                "discovery range",
                "there are no nodes on this machine, and other machines are not searched",
                "set ROS_STATIC_PEERS=<host> or ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET, or start a "
                "router",
            )
        )
    return [*findings, *rmw_findings(environ)]


def rmw_findings(environ: Mapping[str, str]) -> list[Finding]:
    """Return a finding if ROS 2 nodes started from this environment would use another RMW."""
    hint = unheard_middleware(environ)
    if hint is None:
        return []
    text, _, remedy = hint.partition("; ")
    return [
        Finding(
            "hint",
            "RMW_IMPLEMENTATION",
            text,
            f"{remedy}, on this machine; or run ROS 2 with RMW_IMPLEMENTATION={ZENOH}",
        )
    ]
