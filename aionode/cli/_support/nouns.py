"""The nouns with typed names (topics, services and actions), and the verbs they share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from aionode.cli._support import lookup
from aionode.errors import CommandError
from aionode.graph import SERVICE_KINDS, TOPIC_KINDS

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from aionode.cli._support.output import Output
    from aionode.node import Node

__all__ = ["ACTION", "NOUNS", "SERVICE", "TOPIC", "Noun", "with_types"]


@dataclass(frozen=True, slots=True)
class Noun:
    """A kind of name that has types on the network.

    Attributes:
        word: ``topic``, ``service`` or ``action``.
    """

    word: str

    def resolve(self, node: Node, name: str) -> str:
        """Return the full name for a name that the user gave."""
        if self is SERVICE:
            return node.resolve_service_name(name)
        return node.resolve_topic_name(name)

    def types_by_name(self, node: Node, *, hidden: bool = False) -> dict[str, list[str]]:
        """Return the names on the network, sorted, each with its types."""
        if self is ACTION:
            # An action consists of hidden topics and services; its topics show both sides.
            return lookup.actions_and_types(node, *TOPIC_KINDS)
        kinds = SERVICE_KINDS if self is SERVICE else TOPIC_KINDS
        return lookup.names_and_types(node, *kinds, hidden=hidden)

    def unknown(self, node: Node, name: str) -> CommandError:
        """Return the error for a name that is not on the network."""
        known = self.types_by_name(node, hidden=True)
        return lookup.unknown(f"Unknown {self.word}", name, known, f"{self.word} list")

    def name_and_types(self, node: Node, name: str) -> tuple[str, list[str]]:
        """Resolve a name given by the user; return its full name and types.

        Raises:
            CommandError: it is not on the network.
        """
        full_name = self.resolve(node, name)
        types = self.types_by_name(node, hidden=True).get(full_name)
        if types is None:
            raise self.unknown(node, name)
        return full_name, types

    async def list_names(
        self,
        node: Node,
        *,
        output: Output,
        types: bool = False,
        count: bool = False,
        hidden: bool = False,
    ) -> None:
        """Print every name on the network."""
        known = self.types_by_name(node, hidden=hidden)
        self._print_names(known, output, types=types, count=count)

    async def print_type(self, node: Node, name: str, *, output: Output) -> None:
        """Print the types of a name.

        Raises:
            CommandError: it is not on the network.
        """
        full_name, types = self.name_and_types(node, name)
        for type_name in types:
            output.item(type_name, {"name": full_name, "type": type_name})

    async def find(
        self,
        node: Node,
        type_name: str,
        *,
        output: Output,
        count: bool = False,
        hidden: bool = False,
    ) -> None:
        """Print the names of one type."""
        known = self.types_by_name(node, hidden=hidden)
        of_type = {name: types for name, types in known.items() if type_name in types}
        self._print_names(of_type, output, count=count)

    def _print_names(
        self,
        types_by_name: dict[str, list[str]],
        output: Output,
        *,
        types: bool = False,
        count: bool,
    ) -> None:
        items = [
            (with_types(name, of) if types else name, {"name": name, "types": of})
            for name, of in types_by_name.items()
        ]
        output.items(items, count=f"{self.word}s" * count)

    async def wait_for_server(
        self,
        node: Node,
        name: str,
        wait: Callable[[float | None], Awaitable[bool]],
        output: Output,
        timeout_s: float | None,
    ) -> None:
        """Wait for a server of a service or action; warn immediately if a similar name has one.

        Raises:
            CommandError: none appeared within `timeout_s`.
        """
        if hint := lookup.close_to(name, self.types_by_name(node)):
            output.warn(f"No server of '{name}' yet{hint}")
        with output.waiting(f"waiting for a server of {name}"):
            ready = await wait(timeout_s)
        if not ready:
            raise CommandError(
                f"No server of '{name}' appeared within {timeout_s:g} s. "
                f"`aionode {self.word} list` lists the {self.word}s available"
            )


TOPIC = Noun("topic")
SERVICE = Noun("service")
ACTION = Noun("action")

NOUNS = {noun.word: noun for noun in (TOPIC, SERVICE, ACTION)}


def with_types(name: str, types: list[str]) -> str:
    """Return a name with its types in brackets."""
    return f"{name} [{', '.join(types)}]"
