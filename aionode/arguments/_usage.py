"""Reports arguments that no node has used, so that a typo in a name does not go unnoticed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from aionode.names import RemapKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.arguments._parse import Arguments
    from aionode.clock import TimeBase

__all__ = ["Usage"]

CHECK_AFTER_NS = 1_000_000_000
"""Time from the start of the first node to the check of the arguments."""


class NodeParameters(Protocol):
    """The part of a `ParameterStore` used here; a protocol, as the store imports this package."""

    node_name: str
    allow_undeclared: bool
    asked: set[str]

    def names(self) -> list[str]:
        """Return the names of all declared parameters."""


class Usage:
    """Records which arguments nodes use, and logs the unused ones once.

    Args:
        arguments: The arguments: their remap rules, and the parameters given by ``-p``.
    """

    def __init__(self, arguments: Arguments) -> None:
        self.arguments = arguments
        # Rules and parameters that are still unused, and the nodes so far.
        self._rules = set(arguments.remap_rules)
        self._parameters = [rule for rule in arguments.parameter_rules if rule.typed]
        self._names: set[str] = set()
        self._stores: list[NodeParameters] = []
        self._begun = False

    @property
    def is_over(self) -> bool:
        """Whether nothing is left to record: all were used, or the unused ones have been logged."""
        return not (self._rules or self._parameters)

    def note_node(self, name: str) -> None:
        """Record a node, by its name before remapping."""
        for kind in (RemapKind.NODE_NAME, RemapKind.NAMESPACE):
            self._rules -= {rule for rule in self._rules if rule.applies_to(kind, name)}

    def note_name(self, name: str, node_name: str, namespace: str, *, is_service: bool) -> None:
        """Record the absolute name of a topic or service before remapping."""
        kind = RemapKind.SERVICE if is_service else RemapKind.TOPIC
        self._names.add(name)
        self._rules -= {
            rule
            for rule in self._rules
            if rule.applies_to(kind, node_name)
            and rule.new_name(name, node_name, namespace) is not None
        }

    def note_parameters(self, store: NodeParameters) -> None:
        """Record the parameters of a node, including those that it declares later."""
        self._stores.append(store)

    def begin(
        self, time_base: TimeBase, is_alive: Callable[[], bool], warn: Callable[[str], Any]
    ) -> None:
        """Check in a second, and `warn` about unused arguments, if the node is still alive.

        A program that ends sooner may not have created all its names.
        """
        if self._begun or self.is_over:
            return
        self._begun = True

        def check() -> None:
            if is_alive():
                for text in self.unused():
                    warn(text)
            self._rules.clear()
            self._parameters.clear()
            self._stores.clear()
            self._names.clear()

        time_base.call_at(time_base.steady_ns() + CHECK_AFTER_NS, check)

    def unused(self) -> list[str]:
        """Return a text for each argument that has not been used so far."""
        texts = [
            f"-r {rule}: has matched no name of this program's nodes so far, so it changes nothing"
            f"{meant(rule.match, self._names)}"
            for rule in self.arguments.remap_rules
            if rule in self._rules
        ]
        for rule in self._parameters:
            stores = [store for store in self._stores if rule.matches(store.node_name)]
            if any(rule.name in store.asked or store.allow_undeclared for store in stores):
                continue
            problem, known = "this program has no such node", set[str]()
            if stores:
                problem = f"no node has declared the parameter {rule.name!r} so far"
                known = {name for store in stores for name in store.names()}
            hint = meant(rule.name, known)
            texts.append(f"-p {rule.typed}: {problem}, so it changes nothing{hint}")
        return texts


def meant(word: str, known: Iterable[str]) -> str:
    """Return a hint with the most similar known word; empty if none is similar."""
    import difflib  # for hints only

    plain = {name.strip("/"): name for name in known}
    close = difflib.get_close_matches(word.strip("/"), plain, n=1)
    return f"; did you mean {plain[close[0]]!r}?" if close else ""
