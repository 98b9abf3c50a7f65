"""The fixtures that users' tests get."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import settle

if TYPE_CHECKING:
    from collections.abc import Callable

    import pytest

    from aionode.context import Context

pytest_plugins = ["pytester"]


class Talker(Node):
    """A node as users write them: it knows nothing of contexts."""

    def __init__(self, word: str = "hello") -> None:
        super().__init__("talker")
        publisher = self.create_publisher(String, "words", 10)
        self.create_timer(1.0, lambda: publisher.publish(String(data=word)))


async def test_a_node_of_ones_own_class_runs_in_the_context_of_the_test(
    node_factory: Callable[..., Node], aionode_context: Context, manual_clock: Any
) -> None:
    """And follows its clock, without a word about either in the class."""
    heard: list[str] = []
    listener = node_factory("listener")
    listener.create_subscription(String, "words", lambda msg: heard.append(msg.data))
    talker = node_factory(Talker, word="tick")
    await manual_clock.advance(2.0)
    assert heard == ["tick", "tick"]
    assert talker.context is aionode_context


async def test_a_node_from_the_factory_may_be_entered_by_the_test(
    node_factory: Callable[..., Node],
) -> None:
    """Then the test decides when it ends."""
    node = node_factory("node")
    async with node:
        await settle()
        assert node.is_running
    assert node.destroyed


def test_a_failing_callback_fails_the_test_at_its_end(pytester: pytest.Pytester) -> None:
    """A test that forgot to look still notices."""
    pytester.makeini("[pytest]\nasyncio_mode = auto\n")
    pytester.makepyfile(
        """
        from aionode.testing import settle

        async def test_nothing(node_factory):
            node_factory("node").create_timer(0.0, lambda: 1 / 0)
            await settle()
        """
    )
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    result.assert_outcomes(passed=1, errors=1)
    result.stdout.fnmatch_lines(["*ZeroDivisionError*"])
