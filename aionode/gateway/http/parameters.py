"""Parameters over HTTP."""

from __future__ import annotations

from typing import Any

from starlette.exceptions import HTTPException
from starlette.responses import Response

from aionode.gateway.http.answers import Asked, json_response

__all__ = ["set_parameter", "show_parameters"]


def node_and_parameter(asked: Asked) -> tuple[str, str]:
    """Split a path into the node and the parameter that it names; the parameter may be empty.

    Both may contain slashes, so the longest matching node name at the beginning is taken.

    Raises:
        HTTPException: it does not begin with the name of a node that the caller sees (404).
    """
    path = asked.name
    nodes = [node for node in asked.session.graph.nodes() if f"{path}/".startswith(f"{node}/")]
    if not nodes:
        raise HTTPException(404, f"{path[:200]}: no node of that name")
    node = max(nodes, key=len)
    return node, path[len(node) + 1 :]


async def show_parameters(asked: Asked) -> Response:
    """Return the parameters of a node, or the value of one."""
    node, parameter = node_and_parameter(asked)
    names = [parameter] if parameter else await asked.session.parameters.names(node)
    found = await asked.session.parameters.get(node, names)
    values = {each.name: each.value for each in found.values()}
    if parameter and parameter not in values:
        raise HTTPException(404, f"{node}: parameter {parameter[:200]!r} is not declared")
    return json_response(plain(values[parameter] if parameter else values))


async def set_parameter(asked: Asked) -> Response:
    """Set one parameter."""
    node, parameter = node_and_parameter(asked)
    if not parameter:
        raise HTTPException(404, f"{node}: name a parameter, as in /parameters{node}/rate")
    result = await asked.session.parameters.set_json(node, parameter, asked.json())
    if not result.successful:
        raise HTTPException(409, f"{node}: {parameter}: {result.reason}")
    return Response(status_code=204)


def plain(value: Any) -> Any:
    """Return the value of a parameter, or of several by name, in JSON form."""
    if isinstance(value, dict):
        return {name: plain(item) for name, item in value.items()}
    if isinstance(value, bytes):
        return list(value)
    return value.tolist() if hasattr(value, "tolist") else value
