"""``aionode doctor`` about the work of processes, and about what nodes say of themselves."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from aionode.cli._nouns.doctor import doctor
from aionode.cli._nouns.doctor.work import work_findings
from aionode.endpoints.stats import Distribution
from aionode.engine.observation import DurationReport, EntityReport, NodeReport, ProcessReport
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from aionode.interfaces.std_msgs.msg import String
from aionode.observe import Snapshot, rates
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import settle

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode import Node
    from aionode.cli._nouns.doctor.diagnosis import Finding


def durations(milliseconds: float, count: int) -> DurationReport:
    """Return as many durations."""
    measured = Distribution()
    measured._record_all([int(milliseconds * 1e6)] * count)
    return DurationReport(measured.buckets, measured.max_ns)


def snapshot(entity: EntityReport | None = None, **process: Any) -> Snapshot:
    """Return a look at one process with one node and one entity."""
    values: dict[str, Any] = {
        "participant": "a", "host": "robot", "pid": 7, "program": "driver.py", "version": "1",
        "python": "3", "now_ns": 0, "cpu_ns": 0, "memory_bytes": 0, "load": 0.5, "cores": 2,
        "processor_waits": 0, "processor_waited_ns": 0, "dropped": {},
    }  # fmt: skip
    node = NodeReport("/driver", True, 0, [] if entity is None else [entity])
    report = ProcessReport(**{**values, **process}, nodes=[node])
    return Snapshot([report], {}, {}, [], [], {})


def scan(durations: dict[str, DurationReport] | None = None, **counts: int) -> EntityReport:
    """Return the subscription to /scan."""
    return EntityReport(
        "subscription", "/scan", "sensor_msgs/msg/LaserScan", "on_scan", counts, durations or {}
    )


def found(after: Snapshot) -> list[Finding]:
    """Return the findings about a second look; at the first one nothing had happened."""
    before = snapshot()
    after.processes[0].now_ns = 10**9
    return list(work_findings(rates(before, after)))


@pytest.mark.parametrize(
    ("entity", "severity", "text"),
    [
        (scan({"blocking": durations(40, 50)}), "hint", "holds the event loop for 4"),
        (scan({"blocking": durations(450, 50)}), "problem", "holds the event loop for 4"),
        (scan({"queue_wait": durations(200, 50)}), "problem", "on_scan of /driver begins 197 ms"),
        (scan(received=90, dropped=10), "hint", "10 of 100 messages for on_scan of /driver were"),
        (scan(received=90, lost=10), "hint", "10 messages from other processes did not"),
        (scan(received=90, errors=3), "problem", "has failed 3 times, 3 of them just now"),
    ],
)
def test_what_is_wrong_is_told_with_a_remedy(
    entity: EntityReport, severity: str, text: str
) -> None:
    """By callback, node and topic."""
    (finding,) = found(snapshot(entity))

    assert (finding.severity, finding.subject) == (severity, "subscription /scan")
    assert text in finding.text
    assert finding.remedy


@pytest.mark.parametrize(
    "entity",
    [
        scan({"blocking": durations(400, 4), "queue_wait": durations(400, 4)}),
        scan({"blocking": durations(5, 500), "queue_wait": durations(5, 500)}),
        scan(received=1000, dropped=1, lost=1),
    ],
)
def test_a_sound_callback_has_no_finding(entity: EntityReport) -> None:
    """A few calls say nothing, and a single loss is none."""
    assert found(snapshot(entity)) == []


@pytest.mark.parametrize(("load", "remedy"), [(8.0, "aionode top"), (0.5, "taskset -pc 7")])
def test_waits_for_a_processor_are_told(load: float, remedy: str) -> None:
    """With the load, or else with how to see whether the process is bound to a busy core."""
    look = snapshot(load=load, processor_waits=12, processor_waited_ns=345_000_000)
    (finding,) = found(look)

    assert finding.severity == "hint"
    assert "12 of its callbacks were late because no processor was free, 345 ms" in finding.text
    assert f"{load:.1f} on 2 cores" in finding.text
    assert remedy in finding.remedy


def test_silent_and_older_processes_are_named() -> None:
    """By their nodes, with the others."""
    whole = snapshot(scan(errors=1))
    whole.silent["b"] = ["/frozen"]
    whole.older["c"] = ["/old"]

    assert [each.subject for each in found(whole)] == ["subscription /scan", "/frozen", "/old"]


async def test_what_nodes_say_of_themselves_is_told(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The worst first; what is OK is not told, and control characters of others are escaped."""
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = node_factory("driver").create_publisher(DiagnosticArray, "/diagnostics", latched)
    levels = [DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR]
    levels.append(DiagnosticStatus.STALE)
    status = [
        DiagnosticStatus(level=level, name=f"driver: {level[0]}", message="\x1b[2J")
        for level in levels
    ]
    node_factory("talker").create_publisher(String, "/chatter", 1)

    async def speak() -> None:
        await publisher.wait_for_subscribers(1)
        publisher.publish(DiagnosticArray(status=status))

    code, _ = await asyncio.gather(doctor(tool, output=screen.json_output), speak())
    await settle()
    told = [each for each in screen.records if "diagnostics of" in str(each.get("subject"))]

    assert code == 1
    assert [(each["severity"], each["subject"]) for each in told] == [
        ("problem", "diagnostics of driver: 3"),
        ("problem", "diagnostics of driver: 2"),
        ("hint", "diagnostics of driver: 1"),
    ]
    assert "\x1b" not in str(told)
