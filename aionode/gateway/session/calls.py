"""Classifies calls: a call may be part of a goal, or concern parameters."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import MessageError
from aionode.graph import EndpointKind
from aionode.parameter import Parameter

if TYPE_CHECKING:
    from aionode.gateway.policy.policy import Verb
    from aionode.gateway.session.rights import Rights
    from aionode.gateway.session.robot import Robot

__all__ = ["decide_call", "seen_response"]

ACTION_PARTS: Final = ("/_action/send_goal", "/_action/get_result", "/_action/cancel_goal")
SETTERS: Final = ("SetParameters", "SetParametersAtomically")
READERS: Final = ("GetParameters", "GetParameterTypes", "DescribeParameters")
LISTER: Final = "ListParameters"
PARAMETERS: Final = "rcl_interfaces/srv/"
"""The types of the parameter services, whose names a node may have remapped."""


def decide_call(
    rights: Rights, robot: Robot, service: str, type_name: str, request: Any = None
) -> tuple[Verb, str]:
    """Return the verb and the name that the policy checks for a call, which may be part of a goal.

    Raises:
        RefusedError: the policy does not allow it.
    """
    for part in ACTION_PARTS:
        if service.endswith(part):
            action = service.removesuffix(part)
            if part == ACTION_PARTS[0]:
                raise rights.refusal(
                    "call", service, "send goals as goals, so that they end with the client",
                    "not_allowed",
                )  # fmt: skip
            rights.decide("goal", action, "")
            return "goal", action
    rights.decide("call", service, type_name)
    part = type_name.removeprefix(PARAMETERS) if type_name.startswith(PARAMETERS) else ""
    for node in nodes_of(robot, service) if part and request is not None else ():
        if part in SETTERS:
            for message in request.parameters:
                decide_in_a_call(rights, node, message)
        elif part in READERS:
            rights.check_seen(node, request.names)
    return "call", service


def nodes_of(robot: Robot, service: str) -> list[str]:
    """Return the nodes whose parameters a service concerns, by its name and its servers."""
    servers = robot.node.graph.endpoints(EndpointKind.SERVER, name=service)
    named = service.rpartition("/")[0]
    return sorted({named, *(server.node.fully_qualified_name for server in servers)})


def seen_response(rights: Rights, robot: Robot, service: str, response: Any) -> Any:
    """Return a response; parameters that the client may not see are removed from lists."""
    if response.__ros_type__ != f"{PARAMETERS}{LISTER}_Response":
        return response
    nodes, result = nodes_of(robot, service), response.result
    names = [
        name for name in result.names
        if all(rights.sees(f"{node}:{name}", []) for node in nodes)
    ]  # fmt: skip
    prefixes = [
        prefix for prefix in result.prefixes
        if any(name.startswith(f"{prefix}.") for name in names)
    ]  # fmt: skip
    return type(response)(result=type(result)(names=names, prefixes=prefixes))


def decide_in_a_call(rights: Rights, node: str, message: Any) -> None:
    """Refuse to set a parameter by a call if its rule does more than allow it."""
    try:
        given = Parameter.from_parameter_msg(message)
    except (RuntimeError, ValueError) as error:
        raise MessageError("parameters", str(error)) from error
    rule = rights.decide("parameter", f"{node}:{given.name}", "").rule
    has_more = rule is not None and (rule.ask or rule.rate_hz < math.inf)
    if has_more or rights.decide_parameter(node, given) is not given:
        raise rights.refusal(
            "parameter", f"{node}:{given.name}", "set it as a parameter, not by a call",
            "not_allowed",
        )  # fmt: skip
