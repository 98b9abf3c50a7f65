"""Notes what each callback works on, where the context keeps causes.

Executors step coroutines in any thread, without a context of their own; so the causes of a callback
are set for each step, and taken back after it.
"""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any, Final
from uuid import uuid4
from weakref import WeakKeyDictionary

from aionode.clock import perf_ns
from aionode.engine.causes import CAUSES, Party, Run

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine, Generator

    from aionode.engine.causes import CauseLog, Kind
    from aionode.graph import EndpointInfo

__all__ = ["caused_by", "noting", "party_of", "timer_party"]

PARTIES: Final[WeakKeyDictionary[Any, Party]] = WeakKeyDictionary()
"""The parties of entities, which are made when they are first needed."""


def party_of(entity: Any, endpoint: EndpointInfo, callback: Any = None) -> Party:
    """Return who takes what arrives at an endpoint, with the name of the callback."""
    party = PARTIES.get(entity)
    if party is None:
        name = getattr(callback, "__qualname__", "") or ""
        party = PARTIES[entity] = Party.of(endpoint, lambda: name)
    return party


def timer_party(timer: Any, node: str) -> Party:
    """Return the party of a timer of a node."""
    party = PARTIES.get(timer)
    if party is None:
        name = getattr(timer.callback, "__qualname__", "") or ""
        period = f"timer of {timer.timer_period_ns / 1e9:g} s"
        party = PARTIES[timer] = Party("timer", node, period, uuid4().bytes, lambda: name)
    return party


def noting(
    call: Callable[[], Any],
    log: CauseLog,
    party: Party,
    kind: Kind,
    taken: tuple[bytes, int],
    waited_ns: int = 0,
) -> Callable[[], Any]:
    """Return a function that calls a callback for what it takes: its gid and number."""

    def act() -> Any:
        token = CAUSES.set(())
        run = log.begin(party, kind, *taken, perf_ns() - max(waited_ns, 0))
        result = None
        try:
            result = call()
            if inspect.iscoroutine(result):
                return stepped(result, CAUSES.get(), run)
            return result
        finally:
            if not inspect.iscoroutine(result):
                run.end(perf_ns())
            CAUSES.reset(token)

    return act


def caused_by(callback: Callable[..., Any], run: Run | None) -> Callable[..., Any]:
    """Return a function that calls another one, and what that sends is caused by a run."""
    if run is None:
        return callback

    def call(*args: Any) -> Any:
        token = CAUSES.set((run,))
        try:
            return callback(*args)
        finally:
            CAUSES.reset(token)

    return call


async def stepped(coroutine: Coroutine[Any, Any, Any], causes: tuple[Run, ...], run: Run) -> Any:
    """Await a callback; what it sends is caused by what it has taken and awaited."""
    return await Steps(coroutine, causes, run)


class Steps:
    """A coroutine each of whose steps has the causes of the callback."""

    def __init__(
        self, coroutine: Coroutine[Any, Any, Any], causes: tuple[Run, ...], run: Run
    ) -> None:
        self._coroutine = coroutine
        self._causes = causes
        self._run = run

    def __await__(self) -> Generator[Any, Any, Any]:
        thrown: BaseException | None = None
        try:
            while True:
                token = CAUSES.set(self._causes)
                try:
                    waits_for = (
                        self._coroutine.send(None)
                        if thrown is None
                        else self._coroutine.throw(thrown)
                    )
                finally:
                    self._causes = CAUSES.get()
                    CAUSES.reset(token)
                thrown = None
                try:
                    yield waits_for
                except BaseException as error:  # noqa: BLE001  # handed on to the callback
                    thrown = error
        except StopIteration as stop:
            return stop.value
        finally:
            self._run.end(perf_ns())
