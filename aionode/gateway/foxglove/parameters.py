"""Parameters of nodes, for a client of Foxglove's protocol."""

from __future__ import annotations

import contextlib
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Final

from aionode.errors import AionodeError, MessageError
from aionode.gateway.foxglove import frames
from aionode.gateway.session.encoding.parameters import parameter_of
from aionode.parameter import Parameter, ParameterType

if TYPE_CHECKING:
    from aionode.gateway.session.delivery.subscribed import Subscribed
    from aionode.gateway.session.feed import Received
    from aionode.gateway.session.session import Session

__all__ = ["Parameters"]

EVENTS: Final = "/parameter_events"
EVENT_TYPE: Final = "rcl_interfaces/msg/ParameterEvent"

MAX_FOLLOWED: Final = 10_000
"""Maximum number of parameters that a client may follow."""

MAX_CHARACTERS: Final = 1000
"""The longest name of a followed parameter, in characters."""


class Parameters:
    """The parameters that one client reads, sets and follows.

    A client names a parameter by its node, a dot and its own name: node names contain no dots.

    Args:
        session: The session of the client.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._followed: set[str] = set()
        self._follows_all = False
        self._events: Subscribed | None = None

    async def get(self, names: Sequence[str], request_id: str | None) -> None:
        """Send parameters; without names, those of all nodes.

        Raises:
            MessageError: a name does not consist of a node, a dot and a parameter; or a node or the
                policy withholds some of them. The others are sent.
        """
        failures = Failures()
        wanted = by_node(names, failures) if names else await self._session.parameters.all_names()
        shown: list[dict[str, Any]] = []
        for node, own in wanted.items():
            seen = self._seen(node, own, failures)
            with failures.of(node, TimeoutError):
                found = await self._session.parameters.get(node, seen) if seen else {}
                shown += [
                    frames.shown_parameter(f"{node}.{name}", parameter)
                    for name, parameter in found.items()
                ]
        self._send(shown, request_id)
        failures.tell("getParameters")

    def _seen(self, node: str, names: Iterable[str], failures: Failures) -> list[str]:
        """Return the names of those parameters that the client may see."""
        seen = []
        for name in names:
            with failures.of(f"{node}.{name}"):
                self._session.rights.check_seen(node, [name])
                seen.append(name)
        return seen

    async def set(
        self, parameters: Sequence[frames.FoxgloveParameter], request_id: str | None
    ) -> None:
        """Set parameters, and send their values if the client requested that.

        Raises:
            MessageError: a name does not consist of a node, a dot and a parameter; or some
                parameters cannot be set. The others are set.
        """
        arrived_ns = self._session.arrivals.arrival_ns()
        given = {parameter.name: parameter for parameter in parameters}
        failures = Failures()
        told: list[str] = []
        for node, own in by_node(given, failures).items():
            allowed = []
            for name in own:  # before anything is read
                with failures.of(f"{node}.{name}"):
                    self._session.rights.decide("parameter", f"{node}:{name}", "")
                    allowed.append(name)
            allowed = self._seen(node, allowed, failures)
            if not allowed:
                continue
            with failures.of(node, TimeoutError):  # then the node is not asked twice
                found = await self._session.parameters.get(node, allowed)
                told += [f"{node}.{name}" for name in allowed]
                for name in allowed:
                    with failures.of(f"{node}.{name}"):
                        wish = given[f"{node}.{name}"]
                        await self._set_one(node, wish, name, found.get(name), arrived_ns)
        if request_id is not None:
            if told:
                with failures.of("getParameters"):
                    await self.get(told, request_id)
            else:  # without names, `get` would send all
                self._send([], request_id)
        failures.tell("setParameters")

    async def _set_one(
        self,
        node: str,
        given: frames.FoxgloveParameter,
        name: str,
        now: Parameter | None,
        arrived_ns: int,
    ) -> None:
        type_ = ParameterType.NOT_SET if now is None else now.type_
        parameter = parameter_of(name, given.value, type_, given.type)
        result = await self._session.parameters.set(node, parameter, arrived_ns=arrived_ns)
        if not result.successful:
            raise MessageError(name, result.reason)

    async def follow(self, names: Sequence[str]) -> None:
        """Send parameters whenever they change; without names, all of them.

        Raises:
            RefusedError: the policy refuses to subscribe to the events of parameters.
            MessageError: there are too many names; or some do not consist of a node, a dot and a
                parameter, while the others are followed.
        """
        if len(self._followed) + len(names) > MAX_FOLLOWED or any(
            len(name) > MAX_CHARACTERS for name in names
        ):
            raise MessageError("subscribeParameterUpdates", "too many names, or too long ones")
        if self._events is None:
            self._events = await self._session.subscribe(
                EVENTS, EVENT_TYPE, frame=self._frame, key="parameterValues", depth=100
            )
        self._follows_all = self._follows_all or not names
        self._followed.update(names)
        failures = Failures()
        by_node(names, failures)
        failures.tell("subscribeParameterUpdates")

    def unfollow(self, names: Iterable[str]) -> None:
        """Stop sending these parameters; without names, stop sending any."""
        wanted = set(names)
        self._followed -= wanted or set(self._followed)
        self._follows_all = self._follows_all and bool(wanted)
        if self._events is not None and not self._followed and not self._follows_all:
            self._events.close()
            self._events = None

    def forget(self, ended: list[Subscribed]) -> None:
        """Forget the followed parameters if the policy has ended that."""
        if self._events in ended:
            self._events, self._follows_all = None, False
            self._followed.clear()

    def _frame(self, received: Received) -> str | None:
        """Return the frame for an event, if the client follows one of its parameters."""
        event = received.message
        shown = [
            frames.shown_parameter(f"{event.node}.{msg.name}", Parameter.from_parameter_msg(msg))
            for msg in (*event.new_parameters, *event.changed_parameters)
        ]
        shown += [{"name": f"{event.node}.{msg.name}"} for msg in event.deleted_parameters]
        wanted = [item for item in shown if self._follows_all or item["name"] in self._followed]
        return frames.op_frame("parameterValues", {"parameters": wanted}) if wanted else None

    def _send(self, shown: list[dict[str, Any]], request_id: str | None) -> None:
        fields: dict[str, Any] = {"parameters": shown}
        if request_id is not None:
            fields["id"] = request_id
        self._session.outbox.send(frames.op_frame("parameterValues", fields))


class Failures:
    """The failures within a request about several parameters; the others have succeeded."""

    def __init__(self) -> None:
        self._texts: list[str] = []

    @contextlib.contextmanager
    def of(self, subject: str, *others: type[Exception]) -> Iterator[None]:
        """Record an error raised in the block: one of aionode's own, or of `others`."""
        kinds: tuple[type[Exception], ...] = (AionodeError, *others)
        try:
            yield
        except kinds as error:
            self.add(subject, str(error) or "no answer in time")

    def add(self, subject: str, reason: str) -> None:
        """Record a failure."""
        self._texts.append(f"{subject}: {reason}")

    def tell(self, request: str) -> None:
        """Raise if anything has failed.

        Raises:
            MessageError: something has failed.
        """
        if self._texts:
            raise MessageError(request, "; ".join(self._texts))


def by_node(names: Iterable[str], failures: Failures) -> dict[str, list[str]]:
    """Group the names of parameters by node; a name without a dot is a failure."""
    names_of: dict[str, list[str]] = defaultdict(list)
    for name in names:
        node, dot, own = name.partition(".")
        if dot and own:
            names_of[node].append(own)
        else:
            failures.add(repr(name[:MAX_CHARACTERS]), "it does not have the form /node.parameter")
    return names_of
