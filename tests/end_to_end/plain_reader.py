"""A subscription like that of a ROS 2 node on rmw_zenoh_cpp, which acknowledges nothing.

``python tests/end_to_end/plain_reader.py TOPIC COUNT [bare]``; with ``bare``, without a token.
It prints ``open``, ``heard N`` when all have arrived, ``wrong`` if they are out of order, and
``count N`` for each line on stdin.
"""

from __future__ import annotations

import os
import sys
from threading import Event

import zenoh  # noqa: TID251  # plays another participant, without aionode's transport

from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire._key_expression import data_key
from aionode.engine.wire._liveliness import endpoint_token, node_token
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import QoSProfile
from tests.support.peers import raw_session


def tell(*words: object) -> None:
    """Write one line at once."""
    sys.stdout.write(" ".join(str(word) for word in words) + "\n")
    sys.stdout.flush()


def main() -> None:
    """Count messages until stdin ends."""
    topic, count = "/" + sys.argv[1], int(sys.argv[2])
    domain_id = int(os.environ["ROS_DOMAIN_ID"])
    with raw_session() as session:
        node = NodeInfo(str(session.zid()), 0, "plain", "/")
        endpoint = EndpointInfo(
            EndpointKind.SUBSCRIPTION,
            node,
            1,
            topic,
            "std_msgs/msg/String",
            type_hash(String),
            QoSProfile(depth=count),
            b"",
        )
        numbers: list[int] = []
        done = Event()

        def take(sample: zenoh.Sample) -> None:
            extra = sample.attachment
            fields = None if extra is None else attachment.unpack_fields(extra.to_bytes())
            numbers.append(0 if fields is None else fields[0])
            if len(numbers) == count:
                if numbers != sorted(numbers):
                    tell("wrong")
                tell("heard", count)
                done.set()

        subscriber = session.declare_subscriber(
            data_key(domain_id, topic, endpoint.type_name, endpoint.type_hash), take
        )
        own = (node_token(domain_id, node), endpoint_token(domain_id, endpoint))
        tokens = [
            session.liveliness().declare_token(token) for token in own if "bare" not in sys.argv
        ]
        tell("open")
        for _ in sys.stdin:
            tell("count", len(numbers))
        for token in tokens:
            token.undeclare()
        subscriber.undeclare()


if __name__ == "__main__":
    main()
