"""Which arguments were of no use to any node: a typo in a name is accepted without a word else."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING, Any

from aionode.names import RemapKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.arguments._parse import Arguments
    from aionode.clock import TimeBase
    from aionode.parameter import ParameterStore

__all__ = ["Usage"]

LOOK_AFTER_NS = 1_000_000_000
"""How long after the first node began to run the arguments are looked at."""


class Usage:
    """Notes what nodes make of some arguments, and says once what was of no use to any.

    Args:
        arguments: What is watched: its rules, and the parameters of its ``-p``.
    """

    def __init__(self, arguments: Arguments) -> None:
        self.arguments = arguments
        self._rules = set(arguments.remap_rules)
        self._parameters = [rule for rule in arguments.parameter_rules if rule.typed]
        self._names: set[str] = set()
        self._stores: list[ParameterStore] = []
        self._begun = False

    @property
    def is_over(self) -> bool:
        """Whether nothing is left to note: all was of use, or it was said what was not."""
        return not (self._rules or self._parameters)

    def note_node(self, name: str) -> None:
        """Note a node by the name that its program gives it."""
        for kind in (RemapKind.NODE_NAME, RemapKind.NAMESPACE):
            self._rules -= {rule for rule in self._rules if rule.applies_to(kind, name)}

    def note_name(self, name: str, node_name: str, namespace: str, *, is_service: bool) -> None:
        """Note the absolute name of a topic or service before it is remapped."""
        kind = RemapKind.SERVICE if is_service else RemapKind.TOPIC
        self._names.add(name)
        self._rules -= {
            rule
            for rule in self._rules
            if rule.applies_to(kind, node_name)
            and rule.new_name(name, node_name, namespace) is not None
        }

    def note_parameters(self, store: ParameterStore) -> None:
        """Note the parameters of a node, those included that it declares later."""
        self._stores.append(store)

    def begin(
        self, time_base: TimeBase, is_alive: Callable[[], bool], warn: Callable[[str], Any]
    ) -> None:
        """Look a second from now, and `warn` of what was of no use; not of a node that has gone.

        A program that ends sooner has not shown all of its names.
        """
        if self._begun or self.is_over:
            return
        self._begun = True

        def look() -> None:
            if is_alive():
                for text in self.unused():
                    warn(text)
            self._rules.clear()
            self._parameters.clear()
            self._stores.clear()
            self._names.clear()

        time_base.call_at(time_base.steady_ns() + LOOK_AFTER_NS, look)

    def unused(self) -> list[str]:
        """Return what is to be said of each argument that was of no use so far."""
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
    """Return a question for the word that was probably meant; nothing if none is like it."""
    plain = {name.strip("/"): name for name in known}
    close = difflib.get_close_matches(word.strip("/"), plain, n=1)
    return f"; did you mean {plain[close[0]]!r}?" if close else ""
