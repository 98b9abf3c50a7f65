"""The number of objects in a subscription, each of which costs memory."""

from __future__ import annotations

import gc
from collections import Counter
from typing import TYPE_CHECKING, Any

import pytest

from aionode.interfaces.std_msgs.msg import Int32
from tests.support.arrivals import reader_of
from tests.support.links import Counting, Two, folder, two_nodes, writer_of
from tests.support.waiting import until

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["folder"]

VALUES = {"Duration", "QoSProfile", "NodeInfo"}  # shared by all endpoints of a node


def own_objects(root: object, shared: Iterable[object]) -> Counter[str]:
    """Return how many objects of aionode's classes are reachable only from `root`, by class."""
    seen = {id(one) for one in shared}
    found: Counter[str] = Counter()
    ahead: list[Any] = [root]
    while ahead:
        one = ahead.pop()
        if id(one) in seen or isinstance(one, type):
            continue
        seen.add(id(one))
        kind = type(one)
        if kind.__module__.partition(".")[0] == "aionode" and kind.__name__ not in VALUES:
            found[kind.__name__] += 1
        ahead.extend(gc.get_referents(one))
    return found


async def linked_subscription(nodes: Two) -> Counter[str]:
    """Return the objects of a subscription that receives from one publisher over a link."""
    first = Counting(nodes, topic="first")  # for which the link is made
    await first.until_linked()
    publisher = nodes.a.create_publisher(Int32, "second", 10)
    got: list[Int32] = []
    gc.collect()
    gc.unfreeze()  # objects frozen by tests/conftest.py are not counted
    shared = gc.get_objects()
    gc.freeze()
    subscription = nodes.b.create_subscription(Int32, "second", got.append, 10)
    await publisher.wait_for_subscribers()
    while not (writer_of(publisher).linked and got):
        publisher.publish(Int32())
        await first.go()
    await until(lambda: not len(reader_of(subscription)))  # # waiting messages are not part of it
    return own_objects(subscription, shared)


@pytest.mark.slow
async def test_a_linked_subscription_is_made_of_few_objects() -> None:
    """Objects that messages do not need are created only on demand.

    There are no histograms before something is recorded, no monitor without a policy, and no entry
    of the graph beside the endpoint. Zenoh's part is what the subscription has without a link.
    """
    async with two_nodes() as nodes:
        found = await linked_subscription(nodes)

    over_zenoh = {
        "ZenohReader": 1,
        "MessageArrivals": 1,
        "StatefulReader": 1,
        "Recent": 1,  # its last numbers
        "WriterProxy": 1,
        "Placeholder": 1,
        "SharedPayload": 1,  # for all subscriptions of its key
    }
    assert found - Counter(over_zenoh) == {
        "Subscription": 1,
        "EndpointInfo": 1,
        "CallbackStats": 1,
        "CallbackRunner": 1,
        "SubscriptionReader": 1,
        "Recent": 1,  # its last numbers
        "LocalReader": 1,
        "LinkReader": 1,
        "RemotePublisher": 1,
    }
