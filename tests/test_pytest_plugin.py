"""The fixtures that users' tests get."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import pytest

from aionode.bag import BagWriter
from aionode.clock import Time
from aionode.interfaces.std_msgs.msg import Float64, String
from aionode.node import Node
from aionode.testing import settle

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.context import Context

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
    """It follows the test's clock, without a word about either in the class."""
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


@pytest.mark.processes
def test_a_failing_callback_fails_the_test_at_its_end(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
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
    result = without(pytester=pytester, monkeypatch=monkeypatch, plugins="asyncio")
    result.assert_outcomes(passed=1, errors=1)
    result.stdout.fnmatch_lines(["*ZeroDivisionError*"])


TEST_OF_A_NODE = """
import pytest
from aionode.node import Node

{mark}
async def test_a_timer(node_factory, manual_clock, aionode_context):
    ticks = []
    node_factory("node").create_timer(1.0, lambda: ticks.append(1))
    await manual_clock.advance(3.0)
    assert len(ticks) == 3
    assert Node("other").context is aionode_context

def test_something_else():
    pass
"""


def without(
    *missing: str,
    pytester: pytest.Pytester,
    monkeypatch: pytest.MonkeyPatch,
    plugins: str = "",
    options: tuple[str, ...] = (),
) -> pytest.RunResult:
    """Run pytest where packages are missing, with aionode's plugin and a few others.

    To load all plugins that are installed takes a second of processor time.
    """
    for name in missing:
        pytester.makepyfile(**{name: f"raise ImportError('{name} is not installed')"})
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv("PYTHONPATH", str(pytester.path), prepend=os.pathsep)
    words = [word for name in (*plugins.split(), "aionode.pytest_plugin") for word in ("-p", name)]
    return pytester.runpytest_subprocess(*words, "-p", "no:cacheprovider", *options)


@pytest.mark.slow
@pytest.mark.processes
def test_pytest_starts_where_no_plugin_for_async_tests_is(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A project that installs aionode may have only tests that are not async."""
    pytester.makepyfile("def test_one():\n    assert True\n")
    result = without("pytest_asyncio", "anyio", pytester=pytester, monkeypatch=monkeypatch)
    result.assert_outcomes(passed=1)


@pytest.mark.slow
@pytest.mark.processes
def test_an_async_fixture_says_what_it_needs(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Instead of a fixture that is a generator."""
    pytester.makepyfile("def test_one(node_factory):\n    node_factory()\n")
    result = without("pytest_asyncio", "anyio", pytester=pytester, monkeypatch=monkeypatch)
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*pip install pytest-asyncio*"])


@pytest.mark.slow
@pytest.mark.processes
def test_the_fixtures_work_with_anyio_alone(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Projects around Starlette and FastAPI have its plugin, and often no other."""
    pytester.makeconftest(
        "import pytest\n@pytest.fixture\ndef anyio_backend():\n    return 'asyncio'\n"
    )
    pytester.makepyfile(TEST_OF_A_NODE.format(mark="@pytest.mark.anyio"))
    result = without(
        "pytest_asyncio", pytester=pytester, monkeypatch=monkeypatch, plugins="anyio.pytest_plugin"
    )
    result.assert_outcomes(passed=2)


@pytest.mark.processes
@pytest.mark.parametrize(
    ("mode", "mark"),
    [
        pytest.param("strict", "@pytest.mark.asyncio", marks=pytest.mark.slow),
        ("auto", ""),
        pytest.param("strict", "@pytest.mark.anyio", marks=pytest.mark.slow),
    ],
)
def test_the_fixtures_work_in_each_mode_of_pytest_asyncio_and_beside_it(
    mode: str, mark: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They also work where anyio's plugin runs the test although pytest-asyncio is installed."""
    pytester.makeini(
        f"[pytest]\nasyncio_mode = {mode}\nasyncio_default_fixture_loop_scope = function\n"
    )
    pytester.makeconftest(
        "import pytest\n@pytest.fixture\ndef anyio_backend():\n    return 'asyncio'\n"
    )
    pytester.makepyfile(TEST_OF_A_NODE.format(mark=mark))
    plugins = "asyncio anyio"
    without(pytester=pytester, monkeypatch=monkeypatch, plugins=plugins).assert_outcomes(passed=2)


GOLDEN = """
from aionode.interfaces.std_msgs.msg import Float64
from aionode.node import Node

async def test_it(replay_bag, golden_bag):
    async with replay_bag("run") as run:
        node = Node("node")
        publisher = node.create_publisher(Float64, "/y", 10)
        node.create_subscription(
            Float64, "/x", lambda msg: publisher.publish(Float64(data=msg.data * FACTOR)), 10
        )
        golden_bag(await run.play(record=["/y"]))
"""


@pytest.mark.slow
@pytest.mark.processes
def test_outputs_are_compared_with_a_golden_bag_beside_the_test(
    pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has to be made once; after that, a difference fails the test and is named."""
    with BagWriter(pytester.path / "run") as writer:
        writer.write_message("/x", Float64(data=2.0), Time(nanoseconds=1))

    def run(factor: float, *options: str) -> pytest.RunResult:
        pytester.makepyfile(GOLDEN.replace("FACTOR", str(factor)))
        return without(
            pytester=pytester,
            monkeypatch=monkeypatch,
            plugins="asyncio",
            options=("-o", "asyncio_mode=auto", *options),
        )

    run(1.0).stdout.fnmatch_lines(["*--update-golden-bags writes it*"])
    run(1.0, "--update-golden-bags").assert_outcomes(passed=1)
    run(1.0).assert_outcomes(passed=1)
    run(1.5).stdout.fnmatch_lines(["*/y at 0.000000 s: data: 3.0 != 2.0*"])
