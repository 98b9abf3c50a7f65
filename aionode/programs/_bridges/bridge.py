"""The gateway in place of another program that serves clients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from aionode import Node
from aionode.errors import CommandError

if TYPE_CHECKING:
    from aionode.gateway import Gateway

__all__ = ["Original", "bridge", "serve"]

THIS_HOST: Final = "127.0.0.1"

ALL: Final = ([".*"], [""], "", "*", "[*]", "['*']", False)
"""Values with which a parameter that restricts clients restricts nothing."""


@dataclass(frozen=True)
class Original:
    """A program whose place the gateway takes.

    Attributes:
        node: The name of its node.
        port: The port on which it listens by default.
        restrictions: Its parameters that restrict what clients may do, with their defaults.
    """

    node: str
    port: int
    restrictions: Mapping[str, Any]


def bridge(node: Node, original: Original) -> Gateway:
    """Return the gateway in place of a program, configured by the node's parameters.

    Raises:
        CommandError: A parameter restricts clients, or opens the gateway to other hosts, and there
            is no policy that does so; or the extra ``gateway`` is not installed.
        PolicyFileError: The policy cannot be read.
    """
    try:
        from aionode.gateway import Gateway, Policy
    except ImportError as error:
        raise CommandError(f"{original.node}: {error}") from None
    port = node.declare_parameter("port", original.port).value
    host = node.declare_parameter("address", "").value or THIS_HOST
    path = node.declare_parameter("policy", "").value
    given = {
        name: node.declare_parameter(name, value).value
        for name, value in original.restrictions.items()
    }
    if path:
        return Gateway(node, Policy.load(path), host=host, port=port)
    for name, value in given.items():
        if value not in ALL:
            raise CommandError(
                f"{original.node}: {name} is {value!r}, but here a policy says what clients may "
                "do; write one, and name its file by the parameter 'policy'"
            )
    if host not in {THIS_HOST, "localhost"}:
        node.get_logger().warning(
            f"without a policy that identifies clients, it listens on {THIS_HOST} and not on "
            f"{host}: name the file of one by the parameter 'policy'"
        )
    return Gateway(node, host=THIS_HOST, port=port)


async def serve(original: Original) -> None:
    """Serve clients until the program is ended.

    Raises:
        CommandError: The port is taken; or as for `bridge`.
    """
    async with Node(original.node) as node:
        gateway = bridge(node, original)
        try:
            async with gateway:
                await node.until_destroyed()
        except OSError as error:
            raise CommandError(
                f"{original.node}: cannot listen on port {gateway.port} of {gateway.host}: "
                f"{error.strerror}"
            ) from error
