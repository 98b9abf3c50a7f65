"""A stand-in for a ROS 2 node in a fault case: a Zenoh session with rmw_zenoh's settings.

``python -m tests.faults.standin ROLE``; it shares keys and encoding with aionode, but neither its
transports nor its event loop. Its lease is 60 s, and it dials only the router.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack, closing
from typing import Any

import msgspec
import zenoh  # plays another participant, without aionode

from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import data_key
from aionode.engine.wire._liveliness import endpoint_token, gid_of, node_token
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import String
from aionode.message import type_name
from aionode.qos import QoSProfile
from tests.faults.motion.ros_session import commander, obey, send_goal
from tests.faults.process import REPORT_S, Reporter, text
from tests.faults.roles import Publish, Role, stream_key
from tests.support.peers import ros_session


class StandIn:
    """A session that publishes and subscribes."""

    def __init__(self, role: Role, session: zenoh.Session) -> None:
        self.role = role
        self.session = session
        self.domain = int(os.environ["ROS_DOMAIN_ID"])
        self.node = NodeInfo(str(session.zid()), 0, role.name, "/", "/")
        self.reporter = Reporter()
        self.kept: list[object] = []
        self.hold(node_token(self.domain, self.node))
        for hear in role.hear:
            self.hear(hear.topic, hear.depth)
        self.publishers = [(each, *self.publisher(each)) for each in role.publish]
        self.command: Callable[[], None] | None = None
        for wheel in role.wheels:
            obey(self, wheel)
        self.reporter.report.ready = True
        if role.mover is not None and role.mover.asks == "publisher":
            self.command = commander(self, role.mover)
        elif role.mover is not None:
            send_goal(self, role.mover)

    def hold(self, token: str) -> None:
        """Announce something."""
        self.kept.append(self.session.liveliness().declare_token(token))

    def endpoint(self, kind: EndpointKind, topic: str, depth: int, interface: Any = String) -> str:
        """Announce an endpoint, and return its token."""
        info = EndpointInfo(
            kind,
            self.node,
            len(self.kept),
            topic,
            type_name(interface),
            type_hash(interface),
            QoSProfile(depth=depth),
            b"",
        )
        token = endpoint_token(self.domain, info)
        self.hold(token)
        return token

    def key(self, topic: str, interface: Any = String) -> str:
        """Return the key of a topic or service."""
        return data_key(self.domain, topic, type_name(interface), type_hash(interface))

    def hear(self, topic: str, depth: int) -> None:
        """Subscribe."""

        def take(sample: zenoh.Sample) -> None:
            self.reporter.hear(topic, cdr.decode(String, sample.payload.to_bytes()).data)

        self.kept.append(self.session.declare_subscriber(self.key(topic), take))
        self.endpoint(EndpointKind.SUBSCRIPTION, topic, depth)

    def publisher(self, publish: Publish) -> tuple[zenoh.Publisher, bytes]:
        """Return what publishes, and its gid."""
        publisher = self.session.declare_publisher(self.key(publish.topic))
        return publisher, gid_of(self.endpoint(EndpointKind.PUBLISHER, publish.topic, 10))

    def publish(self) -> None:
        """Publish one message on each topic."""
        if self.command is not None:
            self.command()
        for setting, publisher, gid in self.publishers:
            key = stream_key(setting.topic, self.role.name, os.getpid())
            number = self.reporter.report.sent.get(key, 0) + 1
            publisher.put(
                cdr.encode(String(data=text(self.role.name, number, setting.size))),
                attachment=attachment.pack(number, time.time_ns(), gid),
            )
            self.reporter.report.sent[key] = number


def hush(quiet: threading.Event) -> None:
    """Wait for the command to be quiet, after which nothing is published.

    It moves wheels without a command.
    """
    while sys.stdin.readline().strip() == "move":
        pass
    quiet.set()


def main() -> None:
    """Run until SIGTERM, and report a last time."""
    role = msgspec.json.decode(sys.argv[1], type=Role)
    ended, quiet = threading.Event(), threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    threading.Thread(target=hush, args=(quiet,), daemon=True).start()
    with ExitStack() as stack:
        stand_in = StandIn(role, stack.enter_context(closing(ros_session())))
        periods_s = [each.period_s for each in role.publish]
        if role.mover is not None:
            periods_s.append(role.mover.period_s)
        period_s = min(periods_s, default=REPORT_S)
        told_s = 0.0
        while not ended.wait(period_s):
            if not quiet.is_set():
                stand_in.publish()
            if time.monotonic() - told_s >= REPORT_S:
                told_s = time.monotonic()
                stand_in.reporter.tell()
        stand_in.reporter.report.last = True
        stand_in.reporter.tell()
    os._exit(0)


if __name__ == "__main__":
    main()
