"""A participant made with zenoh-ros2-sdk, which shares no code with aionode.

``python tests/end_to_end/sdk_peer.py PORT`` publishes ``sdk`` on /hello, prints ``heard NAME`` for
what it receives there, serves /add_sdk, calls /add_ours with 2 and 3 and prints ``sum N``.
"""

from __future__ import annotations

import sys
import threading
from typing import Any

from zenoh_ros2_sdk import (
    ROS2Publisher,
    ROS2ServiceClient,
    ROS2ServiceServer,
    ROS2Subscriber,
)

STRING_HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
ADD_HASH = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
ADD_TYPE = "example_interfaces/srv/AddTwoInts"
ADD: dict[str, Any] = {
    "request_definition": "int64 a\nint64 b\n",
    "response_definition": "int64 sum\n",
    "type_hash": ADD_HASH,
}
STRING: dict[str, Any] = {"msg_definition": "string data\n", "type_hash": STRING_HASH}


def tell(*words: object) -> None:
    """Write one line at once."""
    sys.stdout.write(" ".join(str(word) for word in words) + "\n")
    sys.stdout.flush()


def main() -> None:
    """Run until the other process ends this one."""
    there: dict[str, Any] = {"router_port": int(sys.argv[1])}
    heard: set[str] = set()
    both = threading.Event()

    def hear(msg: Any) -> None:
        if msg.data not in heard:
            heard.add(msg.data)
            tell("heard", msg.data)
            both.set()

    ROS2Subscriber("/hello", "std_msgs/msg/String", hear, **STRING, **there)
    publisher = ROS2Publisher("/hello", "std_msgs/msg/String", **STRING, **there)

    server: Any = None

    def add(request: Any) -> Any:
        return server.response_msg_class(sum=request.a + request.b)

    server = ROS2ServiceServer("/add_sdk", ADD_TYPE, add, **ADD, **there)
    client = ROS2ServiceClient("/add_ours", ADD_TYPE, **ADD, **there)
    tell("open")
    while not both.wait(0.02):
        publisher.publish(data="sdk")
    tell("sum", client.call(a=2, b=3).sum)
    while True:
        publisher.publish(data="sdk")
        threading.Event().wait(0.02)


if __name__ == "__main__":
    main()
