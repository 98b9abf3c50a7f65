"""The program that puts diagnostics together."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.errors import CommandError
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from aionode.interfaces.std_msgs.msg import Header
from aionode.programs._diagnostics.add_analyzer import AddAnalyzer
from aionode.programs._diagnostics.aggregator_node import Aggregator
from aionode.programs._diagnostics.analyzers import without_prefix
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start
from tests.support.peers import isolated_environment

GENERIC = "diagnostic_aggregator/GenericAnalyzer"
GROUP = "diagnostic_aggregator/AnalyzerGroup"
OK, WARN, ERROR, STALE = (bytes([level]) for level in range(4))

ROBOT: dict[str, Any] = {
    "path": "Robot",
    "arms.type": GENERIC,
    "arms.path": "Arms",
    "arms.startswith": ["/arms"],
    "topology.type": GROUP,
    "topology.path": "Topology",
    "topology.analyzers.left.type": GENERIC,
    "topology.analyzers.left.path": "Left",
    "topology.analyzers.left.contains": ["/left"],
    "topology.analyzers.right.type": GENERIC,
    "topology.analyzers.right.path": "Right",
    "topology.analyzers.right.contains": ["/right"],
}


class Panel:
    """Parts of a robot that report, and what is shown of them."""

    def __init__(self, node: Any, clock: ManualClock) -> None:
        self.clock = clock
        self.shown: list[DiagnosticArray] = []
        self.tops: list[DiagnosticStatus] = []
        self.publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        node.create_subscription(DiagnosticArray, "/diagnostics_agg", self.shown.append)
        node.create_subscription(DiagnosticStatus, "/diagnostics_toplevel_state", self.tops.append)

    async def report(self, *, seconds: float = 1.0, **levels: bytes) -> dict[str, str]:
        """Report the levels of parts, wait, and return what is shown."""
        self.publisher.publish(
            DiagnosticArray(
                header=Header(stamp=Time(sec=1)),
                status=[
                    DiagnosticStatus(name=name.replace("__", "/"), level=level, message=name[-1])
                    for name, level in levels.items()
                ],
            )
        )
        await settle()
        await self.clock.advance(seconds)
        await settle()
        return {each.name: f"{each.level[0]} {each.message}" for each in self.shown[-1].status}


@pytest.fixture
def panel(
    manual_clock: ManualClock, start: Start, node_factory: Callable[..., Any]
) -> Callable[..., Panel]:
    """Start the program."""

    def make(**parameters: Any) -> Panel:
        start(Aggregator, **parameters)
        return Panel(node_factory("parts"), manual_clock)

    return make


async def test_parts_are_shown_under_the_paths_of_their_analyzers(
    panel: Callable[..., Panel],
) -> None:
    """Each with the worst level of those in it; a part may be in several."""
    shown = await panel(**ROBOT).report(__arms__left=OK, __arms__right=WARN, __legs__left=ERROR)

    assert shown == {
        "/Robot/Arms": "1 Warning",
        "/Robot/Arms/ arms left": "0 t",
        "/Robot/Arms/ arms right": "1 t",
        "/Robot/Topology/Left": "2 Error",
        "/Robot/Topology/Left/ arms left": "0 t",
        "/Robot/Topology/Left/ legs left": "2 t",
        "/Robot/Topology/Right": "1 Warning",
        "/Robot/Topology/Right/ arms right": "1 t",
        "/Robot/Topology": "2 Error",
        "/Robot": "2 Error",
    }


async def test_what_no_analyzer_matches_is_other_until_it_is_stale(
    panel: Callable[..., Panel],
) -> None:
    """It is forgotten after 5 seconds."""
    parts = panel(**ROBOT)
    shown = await parts.report(battery=OK)
    assert shown["/Robot/Other"] == "0 OK"
    assert shown["/Robot/Other/battery"] == "0 y"

    assert "/Robot/Other" not in await parts.report(seconds=6.0)


async def test_other_parts_may_be_errors(panel: Callable[..., Panel]) -> None:
    """Whoever lists all of them."""
    shown = await panel(**ROBOT | {"other_as_errors": True}).report(battery=OK)

    assert shown["/Robot/Other"] == '2 Unanalyzed items found in "Other"'


async def test_parts_that_fall_silent_are_stale(panel: Callable[..., Panel]) -> None:
    """An analyzer is stale if all its parts are, else that one is an error."""
    parts = panel(**ROBOT | {"arms.timeout": 2.0})
    await parts.report(__arms__a=OK)
    shown = await parts.report(__arms__b=OK, seconds=2.0)
    assert shown["/Robot/Arms"] == "2 Error"
    assert shown["/Robot/Arms/ arms a"] == "3 a"

    shown = await parts.report(seconds=2.0)
    assert shown["/Robot/Arms"] == "3 Stale"


async def test_parts_that_are_expected_are_missing_until_they_come(
    panel: Callable[..., Panel],
) -> None:
    """They count as their analyzer's, whatever else it takes."""
    parts = panel(**{"a.type": GENERIC, "a.path": "A", "a.expected": ["one", "two"]})
    shown = await parts.report(one=OK)
    assert shown == {"/A": "2 Error", "/A/one": "0 e", "/A/two": "3 Missing"}

    assert (await parts.report(one=OK, two=OK))["/A"] == "0 OK"


@pytest.mark.parametrize(
    ("parameters", "own"),
    [
        ({"num_items": 2}, "2 Expected 2, found 1"),
        ({"num_items": 1}, "0 OK"),
        ({"startswith": ["x"], "num_items": 2}, "3 No items found, expected 2"),
        ({"startswith": ["x"], "num_items": 0}, "0 OK"),
        ({"startswith": ["x"]}, "3 Stale"),
        ({"startswith": ["x"], "discard_stale": True}, "0 OK"),
    ],
)
async def test_a_number_of_parts_may_be_expected(
    panel: Callable[..., Panel], parameters: dict[str, Any], own: str
) -> None:
    """If stale ones are discarded, having none is fine."""
    given_values = {"startswith": ["one"]} | parameters
    of_a = {f"a.{name}": value for name, value in given_values.items()}
    shown = await panel(**{"a.type": GENERIC, "a.path": "A"} | of_a).report(one=OK)

    assert shown["/A"] == own


async def test_prefixes_are_left_out_of_names(panel: Callable[..., Panel]) -> None:
    """With the colon that follows."""
    parameters = {"a.find_and_remove_prefix": ["node"], "a.remove_prefix": ["robot/x"]}
    parts = panel(**{"a.type": GENERIC, "a.path": "A", "a.contains": ["robot"]} | parameters)
    parts.publisher.publish(
        DiagnosticArray(
            header=Header(stamp=Time(sec=1)),
            status=[DiagnosticStatus(name=name) for name in ("node: motor", "robot/x: lidar")],
        )
    )
    await settle()

    assert set(await parts.report()) == {"/A", "/A/motor", "/A/lidar"}


@given(st.text("ab/: ", max_size=12), st.text("ab/: ", max_size=3))
def test_a_name_without_its_prefix_keeps_its_path(name: str, prefix: str) -> None:
    """Whatever is left out is of its last part."""
    path, slash, last = name.rpartition("/")
    found = without_prefix(name, prefix)

    assert found.startswith(path + slash)
    assert last.endswith(found[len(path + slash) :])


async def test_parts_may_be_discarded_or_ignored(panel: Callable[..., Panel]) -> None:
    """Discarded parts are not even listed under Other; ignored ones are."""
    parts = panel(
        **{
            "a.type": "diagnostic_aggregator/DiscardAnalyzer",
            "a.path": "A",
            "a.regex": ["noise[0-9]+"],
            "b.type": "diagnostic_aggregator/IgnoreAnalyzer",
            "b.path": "B",
            "b.contains": ["x"],
        }
    )

    assert await parts.report(noise12=ERROR, x=OK) == {"/Other": "0 OK", "/Other/x": "0 x"}


async def test_the_worst_level_of_all_is_published(panel: Callable[..., Panel]) -> None:
    """Stale parts among others are an error, and so is nothing at all."""
    parts = panel(**ROBOT)
    await parts.report(__arms__left=WARN, __arms__right=OK)
    assert (parts.tops[-1].name, parts.tops[-1].level) == ("toplevel_state", WARN)

    await parts.report(__arms__left=ERROR, seconds=1.0)
    assert parts.tops[-1].level == ERROR
    await parts.report(seconds=7.0)
    assert parts.tops[-1].level == STALE


async def test_an_error_is_published_at_once_if_that_is_critical(
    panel: Callable[..., Panel],
) -> None:
    """For a watchdog."""
    parts = panel(**ROBOT | {"critical": True, "pub_rate": 0.1})
    parts.publisher.publish(
        DiagnosticArray(status=[DiagnosticStatus(name=name, level=ERROR) for name in "ab"])
    )
    await settle()

    assert [(top.name, top.level) for top in parts.tops] == [("toplevel_state_critical", ERROR)]


async def test_a_message_without_a_time_is_said_once(
    panel: Callable[..., Panel], capsys: pytest.CaptureFixture[str]
) -> None:
    """With the names in it."""
    parts = panel(**ROBOT)
    for _ in range(3):
        parts.publisher.publish(DiagnosticArray(status=[DiagnosticStatus(name="motor")]))
        await settle()

    said = "No timestamp set for diagnostic message. Message names: motor"
    assert capsys.readouterr().err.count(said) == 1


async def test_analyzers_that_cannot_be_made_are_shown(
    panel: Callable[..., Panel], capsys: pytest.CaptureFixture[str]
) -> None:
    """As stale, and the log says why."""
    parts = panel(
        **ROBOT
        | {"legs.type": GENERIC, "legs.path": "Legs", "eye.type": "eyes/Eye", "eye.path": "E"}
    )
    shown = await parts.report()

    assert shown["/Robot/legs"] == shown["/Robot/eye"] == "3 Analyzer init failed"
    log = capsys.readouterr().err
    assert "GenericAnalyzer 'Legs' was not initialized with any way of checking" in log
    assert "Unable to find Analyzer class eyes/Eye" in log


async def test_values_of_a_part_are_passed_on(panel: Callable[..., Panel]) -> None:
    """The group's own status lists the messages of the parts."""
    parts = panel(**ROBOT)
    values = [KeyValue(key="temperature", value="40")]
    status = DiagnosticStatus(name="/arms/a", hardware_id="7", message="warm", values=values)
    parts.publisher.publish(DiagnosticArray(header=Header(stamp=Time(sec=1)), status=[status]))
    await settle()
    await parts.report()

    own, part = parts.shown[-1].status[:2]
    assert own.values == [KeyValue(key="/arms/a", value="warm")]
    assert (part.hardware_id, part.values) == ("7", values)


OPTIONAL: dict[str, Any] = {
    "eyes.type": GENERIC,
    "eyes.path": "Eyes",
    "eyes.startswith": ["/eyes"],
    "frequency": 10,
}


async def test_analyzers_are_added_while_it_runs(
    panel: Callable[..., Panel], start: Start, capsys: pytest.CaptureFixture[str]
) -> None:
    """By the parameters of add_analyzer that belong to an analyzer; those of before stay."""
    parts = panel(**ROBOT)
    before = await parts.report(__arms__left=OK, __eyes__left=WARN)
    adding = asyncio.ensure_future(start(AddAnalyzer, **OPTIONAL).add())  # noqa: TID251  # its task
    while not adding.done():
        await parts.clock.advance(0.1)
    await adding
    after = await parts.report(__arms__left=OK, __eyes__left=WARN)

    assert "/Robot/Eyes" not in before
    assert after["/Robot/Eyes"] == "1 Warning"
    assert after["/Robot/Arms"] == "0 OK"
    log = capsys.readouterr().err
    assert "Parameters succesfully set" in log
    assert "frequency" not in log


async def test_without_an_analyzer_there_is_nothing_to_add(start: Start) -> None:
    """The original sets nothing, and says that it succeeded."""
    with pytest.raises(CommandError, match="no parameters of an analyzer are given"):
        await start(AddAnalyzer, frequency=10).add()


async def test_a_rate_has_to_be_one(start: Start) -> None:
    """The original divides by it."""
    with pytest.raises(CommandError, match="pub_rate is 0; use a number above 0"):
        start(Aggregator, pub_rate=0)


YAML = """
analyzers:
  ros__parameters:
    pub_rate: 20.0
    motors:
      type: diagnostic_aggregator/GenericAnalyzer
      path: Motors
      contains: ['motor']
"""


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(90)
@pytest.mark.one_loop
def test_it_is_started_with_a_file_of_parameters(tmp_path: Path) -> None:
    """As a launch file does it."""
    (tmp_path / "analyzers.yaml").write_text(YAML)
    env = {**os.environ, **isolated_environment(), "PYTHONUNBUFFERED": "1"}
    words = ["run", "diagnostic_aggregator", "aggregator_node", "--ros-args", "--params-file"]
    command = [sys.executable, "-m", "aionode", *words, str(tmp_path / "analyzers.yaml")]
    with subprocess.Popen(command, env=env) as process:
        echo = [
            "topic",
            "echo",
            "--once",
            "/diagnostics_agg",
            "diagnostic_msgs/msg/DiagnosticArray",
        ]
        said = subprocess.run(
            [sys.executable, "-m", "aionode", *echo], env=env, capture_output=True, text=True,
            check=False, timeout=60,
        )  # fmt: skip
        process.send_signal(signal.SIGINT)

    assert "name: /Motors" in said.stdout
