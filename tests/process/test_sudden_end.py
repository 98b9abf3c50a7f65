"""Tests of interrupted senders, whose step has to end before anything else is sent."""

from __future__ import annotations

import sys
from collections import Counter
from types import FrameType, ModuleType
from typing import TYPE_CHECKING, Any

import pytest

from aionode._process import sudden_end
from aionode._process.sudden_end import is_sending
from aionode.endpoints.client import Client
from aionode.endpoints.publisher import Publisher
from aionode.interfaces.std_msgs.msg import UInt8MultiArray
from aionode.interfaces.std_srvs.srv import Trigger
from tests.support.links import Counting, folder, two_nodes

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["folder"]

WRITES = {"delete", "put", "reply", "send", "sendmsg", "write"}
"""The functions of sockets, descriptors and Zenoh that take bytes to be sent."""

PUBLISHING = {Publisher.publish.__code__, Client.call.__code__}


def called_in(module: str, call: object) -> object:
    """Return the result of `call`, called by a function of a module."""
    made = ModuleType(module)
    exec("def run(call):\n    return call()", vars(made))  # noqa: S102  # a frame of that module
    return made.run(call)


def test_a_callback_that_a_transport_has_called_is_not_sending() -> None:
    """It may block for any time, and the connection is idle."""
    inside = lambda: is_sending(sys._getframe())  # noqa: E731

    assert not is_sending(sys._getframe())
    assert not called_in("aionode.engine.transport.link", inside)
    assert called_in("aionode.engine.transport.link", lambda: called_in("json", inside)) is False


def test_code_between_a_transport_and_a_callback_is_sending() -> None:
    """When that code returns, the transport continues with bytes that it has read or written."""
    for between in ("json", "rclpy.executors", "aionode.engine.rules.goal"):
        made = ModuleType(between)
        exec("import sys\ndef run(test):\n    return test(sys._getframe())", vars(made))  # noqa: S102
        called = ModuleType("aionode.engine.transport.link")
        exec("def run(call, test):\n    return call(test)", vars(called))  # noqa: S102

        assert called.run(made.run, is_sending) is True, between


class Interrupted:
    """Checks at each call of this thread whether a signal would find code that sends.

    Attributes:
        writes: How often each function of `WRITES` was called by aionode.
        publishing: How often a call was made within `Publisher.publish` or `Client.call`.
        unmarked: The code that sends without saying so.
    """

    def __init__(self) -> None:
        self.writes: Counter[str] = Counter()
        self.publishing = 0
        self.unmarked: set[str] = set()

    def __call__(self, frame: FrameType, event: str, function: Any) -> None:
        """Check one call."""
        name = frame.f_globals.get("__name__", "aionode")
        if not name.startswith("aionode"):
            return
        is_write = event == "c_call" and function.__name__ in WRITES
        is_publishing = event in {"call", "c_call"} and any(
            outer.f_code in PUBLISHING for outer in frames_of(frame)
        )
        self.writes[function.__name__ if is_write else ""] += 1
        self.publishing += is_publishing
        if (is_write or is_publishing) and not is_sending(frame):
            self.unmarked.add(f"{name}.{frame.f_code.co_qualname}")


def frames_of(frame: FrameType | None) -> Iterator[FrameType]:
    """Yield a frame and its callers."""
    while frame is not None:
        yield frame
        frame = frame.f_back


def test_the_transport_of_another_package_is_sending() -> None:
    """Its writers may hold part of a frame as well, and it derives from aionode's contract."""
    made = ModuleType("own_transport")
    exec(  # noqa: S102  # a module of its own
        "import sys\nfrom aionode.transport.base import Writer\n"
        "class Own(Writer):\n    def close(self): ...\n"
        "    def write(self, test, sequence, source_ns): return test(sys._getframe())\n",
        vars(made),
    )

    assert made.Own().write(is_sending, 1, 0)
    assert not called_in("own_transport_of_none", lambda: is_sending(sys._getframe(1)))


@pytest.mark.slow
async def test_whatever_sends_says_so() -> None:
    """A signal handler that sent within such a step would tear a frame, or lose a message.

    A package of publishers or transports that moves, or a new one, has to call `mark_sending`.
    """
    assert (await sent_everything()).unmarked == set()


@pytest.mark.slow
@pytest.mark.parametrize("package", ["aionode.endpoints", "aionode.engine.transport"])
async def test_a_package_that_forgets_to_say_so_is_found(
    package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A package that has moved is an example; the test before would pass if it checked nothing."""
    marked = [each for each in sudden_end.SENDING if not each.startswith(package)]
    monkeypatch.setattr(sudden_end, "SENDING", marked)

    unmarked = (await sent_everything()).unmarked

    assert any(name.startswith(package) for name in unmarked)


async def sent_everything() -> Interrupted:
    """Send messages, a large one and a request; return what was seen at each call."""
    interrupted = Interrupted()
    sys.setprofile(interrupted)
    try:
        async with two_nodes() as nodes:
            counting = Counting(nodes)
            large = nodes.a.create_publisher(UInt8MultiArray, "large", 1)
            arrived = nodes.b.create_subscription(UInt8MultiArray, "large", None, 1)
            nodes.b.create_service(Trigger, "serve", lambda _, response: response)
            client = nodes.a.create_client(Trigger, "serve")
            await counting.until_linked()
            await large.wait_for_subscribers()
            large.publish(UInt8MultiArray(data=bytes(200_000)))
            await arrived.receive()
            await client.wait_for_service()
            await client.call(Trigger.Request())
    finally:
        sys.setprofile(None)

    assert interrupted.writes["put"]
    assert interrupted.writes["sendmsg"] + interrupted.writes["send"]
    assert interrupted.publishing
    return interrupted
