"""The end of motion: of the clients of this gateway, and of those of others in the domain."""

from __future__ import annotations

import asyncio
import secrets
from contextlib import suppress
from itertools import islice
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from aionode.errors import AionodeError
from aionode.gateway.policy.identity import Identity
from aionode.gateway.session.rights import Rights
from aionode.graph import EndpointKind
from aionode.message import DEFAULT, Message, Sequence, ServiceType

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from aionode.gateway.session.motions import Motions
    from aionode.gateway.session.robot import Robot
    from aionode.gateway.session.session import Session
    from aionode.graph import EndpointInfo

__all__ = ["Moving", "StopMotion", "Stopped", "Stopping", "cancelled"]

ENDING_SEC: Final = 1.0
"""The longest time that stopped motion may take to end, in seconds."""

ANSWER_SEC: Final = 2 * ENDING_SEC
"""How long to wait for another gateway, in seconds."""

MAX_GATEWAYS: Final = 100

MAX_NAME: Final = 200
"""Maximum length of a client's name in a request, in characters."""

MAX_TOLD: Final = 100
"""Maximum number of motions of each kind accepted from another gateway's answer."""

MAX_TEXT: Final = 300
"""Maximum length of a name in such an answer, in characters."""


class StopMotion(ServiceType, typename="aionode_gateway/srv/StopMotion"):
    """A request to a gateway of the same domain to end a client's motion.

    Everyone in the domain can publish commands, so everyone may ask for their end.
    """

    class Request(Message):
        """The name of the client under the policy."""

        identity: str = ""

    class Response(Message):
        """What was ended and what still moves, with the names of the clients that move it."""

        ended: Sequence[str] = DEFAULT
        ended_of: Sequence[str] = DEFAULT
        moving: Sequence[str] = DEFAULT
        moving_of: Sequence[str] = DEFAULT


class Moving(NamedTuple):
    """A topic or action that moves something, and the name of its client."""

    name: str
    who: str


class Stopped(NamedTuple):
    """What was ended, and what still moves."""

    ended: set[Moving]
    moving: set[Moving]


class Stopping:
    """Ends motion: leases, goals and calls of assistants.

    Each gateway and assistant of a domain offers this as a hidden service, so that `stop` reaches
    what the same client moves through another one.

    Args:
        robot: The robot, as the clients of this gateway share it.
        motions: The motions of the assistants among them.
        sessions: The current sessions of all of them.
    """

    def __init__(self, robot: Robot, motions: Motions, sessions: Collection[Session]) -> None:
        self._robot = robot
        self._motions = motions
        self._sessions = sessions
        self._node = robot.node
        self._service = self._node.create_service(
            StopMotion, f"~/_stop_{secrets.token_hex(8)}", self._serve, concurrent=True
        )

    def close(self) -> None:
        """Withdraw the service."""
        self._service.destroy()

    async def everywhere(self, rights: Rights) -> Stopped:
        """End a client's motion in the whole domain, and that of others as far as it may.

        A gateway that does not answer in time is listed as still moving, and so is the number of
        gateways that were not asked.
        """
        others = [
            endpoint
            for endpoint in self._node.graph.endpoints(EndpointKind.SERVER)
            if endpoint.type_name == StopMotion.__ros_type__
            and endpoint.name != self._service.srv_name
        ]
        answers = await asyncio.gather(
            self.here(rights), *(self._ask(each, rights) for each in others[:MAX_GATEWAYS])
        )
        ended = set().union(*(each.ended for each in answers))
        moving = set().union(*(each.moving for each in answers))
        if left := len(others[MAX_GATEWAYS:]):
            moving.add(Moving("unknown", f"{left} more gateways were not asked"))
        return Stopped(ended, moving)

    async def here(self, rights: Rights) -> Stopped:
        """End a client's motion through this gateway, and that of others as far as it may."""
        ended: set[Moving] = set()

        def may_end(name: str, type_name: str, owner: Identity) -> bool:
            """Return whether it may end a motion, its own or by a rule, and record that."""
            own = owner.name == rights.identity.name
            allowed = own or rights.decision("stop", name, type_name).allowed
            if allowed:
                ended.add(Moving(name, owner.name))
            return allowed

        commands, by = self._robot.commands, f"stop of {rights.identity.name}"
        ending = [
            motion for motion in self._motions
            if may_end(motion.name, motion.type_name, motion.identity)
        ]  # fmt: skip
        for motion in ending:
            motion.end(by=by)
        with suppress(TimeoutError):
            async with asyncio.timeout(ENDING_SEC):
                for motion in ending:
                    await motion.ended.wait()
        for topic, holder in commands.holders().items():
            if may_end(topic, holder.type_name, holder.identity):
                await commands.leave(holder.owner, topic)
        goals = [
            handle
            for session in self._sessions
            for handle, (action, type_name) in session.goals.items()
            if may_end(action, type_name, session.identity)
        ]
        await asyncio.gather(*map(cancelled, goals))
        return Stopped(ended, self._moving())

    def _moving(self) -> set[Moving]:
        """Return the current motions of this gateway's clients."""
        holders = self._robot.commands.holders()
        moving = {Moving(topic, holder.identity.name) for topic, holder in holders.items()}
        return moving | {
            Moving(action, session.identity.name)
            for session in list(self._sessions)
            for handle, (action, _) in session.goals.items()
            if not handle.done
        }

    async def _ask(self, other: EndpointInfo, rights: Rights) -> Stopped:
        """Ask another gateway to end a client's motion."""
        client = self._node.create_client(StopMotion, other.name)
        try:
            request = StopMotion.Request(identity=rights.identity.name)
            response = await client.call(request, timeout_sec=ANSWER_SEC)
        except (AionodeError, TimeoutError):
            if other not in self._node.graph.endpoints(EndpointKind.SERVER, name=other.name):
                return Stopped(set(), set())  # it has ended meanwhile
            node = other.node.fully_qualified_name
            return Stopped(set(), {Moving("unknown", f"{node} does not answer")})
        finally:
            client.destroy()
        ended = told(response.ended, response.ended_of)
        moving = told(response.moving, response.moving_of)
        if max(len(response.ended), len(response.moving)) > MAX_TOLD:
            node = other.node.fully_qualified_name
            moving.add(Moving("unknown", f"{node} names more than {MAX_TOLD}"))
        return Stopped(ended, moving)

    async def _serve(
        self, request: StopMotion.Request, response: StopMotion.Response
    ) -> StopMotion.Response:
        """End the motion of another gateway's client through this one."""
        name = request.identity[:MAX_NAME]
        identity = self._robot.policy.named(name) or Identity(name)
        stopped = await self.here(Rights(self._robot, identity, "stop"))
        for name, who in stopped.ended:
            self._robot.audit.note(
                identity, "stop", name, result=f"of {who}", way="another gateway"
            )
        response.ended = [name for name, _ in stopped.ended]
        response.ended_of = [who for _, who in stopped.ended]
        response.moving = [name for name, _ in stopped.moving]
        response.moving_of = [who for _, who in stopped.moving]
        return response


def told(names: Iterable[str], clients: Iterable[str]) -> set[Moving]:
    """Return the motions in another gateway's answer, limited, as anyone can pose as a gateway."""
    pairs = islice(zip(names, clients, strict=False), MAX_TOLD)
    return {Moving(name[:MAX_TEXT], who[:MAX_TEXT]) for name, who in pairs}


async def cancelled(handle: Any) -> Any:
    """Cancel a goal, and return its result; None if it does not end within a second."""
    with suppress(TimeoutError, AionodeError):
        async with asyncio.timeout(ENDING_SEC):
            await handle.cancel()
            return await handle.result()
    return None
