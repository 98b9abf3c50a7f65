"""The clients of a gateway: their sessions, their policy, and counts of their actions."""

from __future__ import annotations

import asyncio
from collections import defaultdict
from collections.abc import AsyncIterator, Callable, Iterable, MutableMapping
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode.errors import PolicyFileError, RefusedError
from aionode.gateway._stopping import Stopping
from aionode.gateway.policy.identity import Identity
from aionode.gateway.policy.policy import Policy
from aionode.gateway.session.audit import Audit
from aionode.gateway.session.motions import Motions
from aionode.gateway.session.refusals import Refusal
from aionode.gateway.session.robot import Robot
from aionode.gateway.session.session import Session

if TYPE_CHECKING:
    from aionode.gateway.policy.identity import Credentials
    from aionode.gateway.session.robot import Ask
    from aionode.node import Node

__all__ = ["Clients", "GatewayStats"]

RELOAD_SEC: Final = 1.0
"""Time between two checks of the policy file, in seconds."""


class GatewayStats(msgspec.Struct, frozen=True):
    """Counts of a gateway's work.

    Attributes:
        sessions: Number of clients, by protocol.
        refused: Number of refusals.
        refusals: Number of things refused, dropped or late, by reason code.
        sent: Number of frames sent to current clients.
        dropped: Number of frames dropped because clients were too slow, by topic.
        received: Number of messages received, by topic.
        holders: The client that commands each topic.
        audit_lost: Number of audit log lines that were not written.
    """

    sessions: dict[str, int]
    refused: int
    refusals: dict[str, int]
    sent: int
    dropped: dict[str, int]
    received: dict[str, int]
    holders: dict[str, str]
    audit_lost: int


class Clients:
    """The clients of a robot and the rules for them: everything that the protocols share.

    `Gateway` and `Assistant` open and end it; each protocol creates sessions through it.

    Args:
        node: The node by which the clients take part in the graph.
        policy: Who may do what.
        ask: Asks a person for approval; None if there is nobody to ask.

    Attributes:
        node: The node.
        motions: The motions of the assistants among them.
    """

    def __init__(self, node: Node, policy: Policy, ask: Ask | None = None) -> None:
        self.node = node
        self.motions = Motions()
        self._policy = policy
        self._ask = ask
        self._sessions: dict[Session, None] = {}
        self._refused = 0
        self._robot: Robot | None = None
        self._stopping: Stopping | None = None

    def check_node(self) -> None:
        """Refuse to start with a node that is not running.

        Raises:
            RuntimeError: the node is not running.
        """
        if not self.node.is_running:
            raise RuntimeError(f"gateway: {self.node!r} is not running; enter it first")

    async def open(self, stack: AsyncExitStack) -> asyncio.TaskGroup:
        """Create the state that the sessions share, until a stack closes; return its task group."""
        tasks = await stack.enter_async_context(asyncio.TaskGroup())
        audit = Audit(self.node, self._policy.audit_file)
        stack.callback(audit.close)
        self._robot = Robot(self.node, self._policy, audit, tasks, self._ask)
        stack.callback(self._robot.close)
        self._robot.standstills.watch(self._doubt_all)
        self._stopping = Stopping(self._robot, self.motions, self._sessions)
        stack.callback(self._stopping.close)
        for work in (audit.run(), self._follow_policy()):
            stack.callback(tasks.create_task(work).cancel)
        return tasks

    def end(self) -> None:
        """End the sessions of all clients."""
        for session in self.sessions:
            session.ended.set()

    def _doubt_all(self, is_long: bool) -> None:
        """Doubt all clients after a standstill: what they sent meanwhile was not read in time.

        A client without commands then answers one unnecessary ping, which does no harm.

        Args:
            is_long: Whether the standstill was so long that calls and goals are too old as well.
        """
        for session in self.sessions:
            session.doubt(stood_still=is_long)

    @property
    def robot(self) -> Robot:
        """The robot, as shared by the sessions.

        Raises:
            RuntimeError: the gateway was not entered.
        """
        if self._robot is None:
            raise RuntimeError("gateway: use `async with Gateway(...)`")
        return self._robot

    @property
    def stopping(self) -> Stopping:
        """Ends motion.

        Raises:
            RuntimeError: the gateway was not entered.
        """
        if self._stopping is None:
            raise RuntimeError("gateway: use `async with Gateway(...)`")
        return self._stopping

    @property
    def sessions(self) -> list[Session]:
        """The sessions of all clients, the oldest first."""
        return list(self._sessions)

    @property
    def policy(self) -> Policy:
        """The rules in force."""
        return self._policy

    @asynccontextmanager
    async def session(
        self, identity: Identity, kind: str, credentials: Credentials | None = None
    ) -> AsyncIterator[Session]:
        """Yield a session, and release everything it holds when it ends.

        Args:
            identity: Who the client is.
            kind: The protocol: ``rosbridge``, ``foxglove``, ``http``.
            credentials: Its token, address and so on, checked again when the policy changes.

        Raises:
            RefusedError: there are too many clients, and no other identity has more of them.
        """
        self._make_room(identity)
        async with Session(self.robot, identity, kind, credentials) as session:
            self._sessions[session] = None
            try:
                yield session
            finally:
                del self._sessions[session]
                self._refused += session.rights.refused

    def _make_room(self, identity: Identity) -> None:
        """Disconnect a client of the identity with the most clients, if the limit is reached.

        This gives each identity a fair share of the sessions, and each address a fair share within
        its identity.

        Raises:
            RefusedError: the newcomer already has as many clients as any other, give or take one.
        """
        limit = self._policy.limits.clients
        staying = [session for session in self._sessions if not session.ended.is_set()]
        if len(staying) < limit:
            return
        own = [each for each in staying if each.identity.name == identity.name]
        greediest = largest(staying, lambda each: each.identity.name)
        if len(own) + 1 >= len(greediest):
            here = [each for each in own if each.identity.place == identity.place]
            greediest = largest(own, lambda each: each.identity.place)
            if len(here) + 1 >= len(greediest):
                raise RefusedError("connection", f"there are already {limit} clients", "too_many")
        # Sessions that move something are ended last; of the others, the newest go first.
        leaving = min(reversed(greediest), key=lambda each: each.publishes or each.has_goals)
        leaving.end(
            f"there are {limit} clients, which is the limit, and "
            f"{leaving.identity.name} has the most "
            "of them: another client takes this place"
        )

    @asynccontextmanager
    async def session_of(
        self, scope: MutableMapping[str, Any], kind: str
    ) -> AsyncIterator[Session]:
        """Yield the session for a request that the door has let in.

        The client is identified again: the policy may have changed while the request arrived.

        Raises:
            RefusedError: the policy no longer knows the client.
        """
        credentials, connection = scope["aionode.credentials"], scope["state"]["aionode_connection"]
        identity = self._policy.identify(credentials)
        async with self.session(identity, kind, credentials) as session:
            connection.has_session = True
            try:
                yield session
            finally:
                connection.has_session = False

    @property
    def stats(self) -> GatewayStats:
        """Counts of the gateway's work."""
        sessions: dict[str, int] = {}
        dropped: dict[str, int] = {}
        sent, refused = 0, self._refused
        for session in self._sessions:
            sessions[session.kind] = sessions.get(session.kind, 0) + 1
            sent += session.outbox.sent
            refused += session.rights.refused
            for topic, count in session.dropped().items():
                dropped[topic] = dropped.get(topic, 0) + count
        robot = self.robot
        return GatewayStats(
            sessions,
            refused,
            {kind.value: count for kind, count in robot.refusals.counts.items()},
            sent,
            dropped,
            {feed.topic: feed.received for feed in robot.feeds},
            {topic: holder.identity.name for topic, holder in robot.commands.holders().items()},
            robot.audit.lost,
        )

    def note_refusal(self, credentials: Credentials, error: RefusedError) -> None:
        """Record that a client was refused before it had a session."""
        self._refused += 1
        client = Identity("", address=credentials.address)
        if error.code == "too_many":  # already known
            client = self._policy.identify(credentials)
        self.robot.audit.note(client, "connect", "", result=error.reason, code=error.code)
        # A browser does not pass the reason to its page.
        self.robot.refusals.note(
            client, "connect", Refusal.of(error), error.subject, f"refused: {error.reason}"
        )

    def use_policy(self, policy: Policy) -> None:
        """Apply a new policy from now on; rights that it does not grant end."""
        log = self.node.get_logger()
        if policy.tls != self._policy.tls:
            log.warning("gateway: [tls] has changed in the policy; restart the gateway to apply it")
        if policy.audit_file != self._policy.audit_file:
            self.robot.audit.use_file(policy.audit_file)
            log.info(f"gateway: the audit log goes to {policy.audit_file or 'no file'} from now on")
        self._policy = self.robot.policy = policy
        for session in self.sessions:
            session.check_again()
        log.info("gateway: the policy was read again")

    # The policy file

    async def _follow_policy(self) -> None:
        """Reload the policy file when it changes; a file with a mistake changes nothing."""
        path = self._policy.path
        if not path:
            return
        read = modified(path)
        while True:
            await self.robot.clock.sleep(RELOAD_SEC)
            if modified(path) == read:
                continue
            read = modified(path)
            self._reread(path)

    def _reread(self, path: str) -> None:
        try:
            policy = Policy.load(path)
        except PolicyFileError as error:
            self.node.get_logger().error(f"{error}; the gateway keeps its current policy")
        else:
            self.use_policy(policy)


def largest(sessions: Iterable[Session], key: Callable[[Session], str]) -> list[Session]:
    """Return the largest group of clients other than those created by a program, oldest first."""
    groups: dict[str, list[Session]] = defaultdict(list)
    for session in sessions:
        if session.credentials is not None:
            groups[key(session)].append(session)
    return max(groups.values(), key=len, default=[])


def modified(path: str) -> tuple[int, int] | None:
    """Return a file's modification time and inode number; None if it does not exist."""
    try:
        status = Path(path).stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_ino
