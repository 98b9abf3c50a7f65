"""Programs of a system are started, restarted and stopped, and nothing is left behind."""

from __future__ import annotations

import asyncio
import io
import json
import os
import resource
import signal
import sys
import time  # noqa: TID251  # the guardian's
from dataclasses import asdict
from pathlib import Path
from typing import Any, ClassVar

import pytest

from aionode import Context, Node
from aionode._process.sudden_end import SENDS
from aionode.errors import MemberNotFoundError, NotReadyError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from aionode.system import (
    ActionReady,
    NodeActive,
    NodeExists,
    ServiceReady,
    System,
    SystemLog,
    TopicPublished,
)
from aionode.system._guardian import Program, is_in_exec
from aionode.system._process import ProcessMember
from aionode.testing import settle
from tests.support.waiting import until
from tests.system.left import guardian

FOREVER = ["sleep", "1000"]
SUPERVISED = f"while kill -0 {os.getpid()}"
"""A loop of sh that ends with the supervisor: without a guardian, nobody else would end it."""


@pytest.fixture
def output() -> io.StringIO:
    """The output of the system under test."""
    return io.StringIO()


@pytest.fixture
def system(output: io.StringIO) -> System:
    """A system whose nodes have no network."""
    return System("tested", context=Context(transport="local"), log=SystemLog(output))


def alive(pid: int | None) -> bool:
    """Return whether a process exists and is not a zombie."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"


async def test_a_program_runs_until_the_block_is_left(system: System) -> None:
    """`async with` promises that."""
    async with system:
        system.process("sleeper", FOREVER)
        await system.ready()
        status = system.status()["sleeper"]
        assert status.state == "running"
        assert alive(status.pid)

    assert not alive(status.pid)
    assert system.status()["sleeper"].state == "stopped"
    assert system.exit_status == 0


async def test_no_grandchild_is_left_even_one_that_forked_twice(
    system: System, tmp_path: Path
) -> None:
    """Its parent and session differ from those of the program that started it."""
    child, orphan = tmp_path / "child", tmp_path / "orphan"
    script = f"sleep 1000 & echo $! >{child}; (setsid sh -c 'echo $$ >{orphan}; exec sleep 999' &)"
    async with system:
        system.process("forking", ["sh", "-c", f"{script}; exec sleep 998"], term_after_sec=0.1)
        await system.ready()
        await until(lambda: orphan.exists() and orphan.read_text())
        pids = [int(file.read_text()) for file in (child, orphan)]
        assert all(map(alive, pids))

    assert not any(map(alive, pids))


async def test_what_a_program_leaves_behind_ends_with_it(system: System, tmp_path: Path) -> None:
    """Otherwise a restart would find its port or device in use."""
    orphan = tmp_path / "orphan"
    script = (
        f"(setsid sh -c 'echo $$ >{orphan}; exec sleep 999' &); while ! [ -s {orphan} ]; do :; done"
    )
    async with system:
        system.process("forking", ["sh", "-c", script], term_after_sec=0.1)
        await system.wait()

        assert not alive(int(orphan.read_text()))


@pytest.mark.slow
async def test_what_becomes_another_program_meanwhile_is_not_lost(
    system: System, tmp_path: Path
) -> None:
    """During exec it has no environment, hence no token that identifies it."""
    changing = tmp_path / "changing"
    changing.write_text(f"#!/bin/sh\n[ $1 = 0 ] || exec {changing} $(($1 - 1))\nexec sleep 999\n")
    changing.chmod(0o755)
    orphans = [tmp_path / f"orphan{number}" for number in range(10)]
    async with system:
        for orphan in orphans:
            becomes = f"echo $$ >{orphan}; exec {changing} 300"
            script = f"(setsid sh -c '{becomes}' &); while ! [ -s {orphan} ]; do :; done"
            system.process(orphan.name, ["sh", "-c", script], term_after_sec=0.1)
        await system.wait()

        assert not any(alive(int(orphan.read_text())) for orphan in orphans)


def test_a_program_is_not_gone_while_a_process_waits_in_an_exec_for_a_processor(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """On a busy machine that takes longer than the moment in which any stranger may be its own."""
    now_s = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    program = Program(1, 2, [], [], guardian=3)
    assert program.is_left(strangers=True, in_exec=True)
    now_s += 1.0

    assert program.is_left(strangers=True, in_exec=True)
    assert not program.is_left(strangers=True, in_exec=False)


async def test_a_process_without_environment_is_in_no_exec() -> None:
    """Its arguments tell; ends would wait for it otherwise."""
    process = await asyncio.create_subprocess_exec("sleep", "999", env={})
    try:
        assert not is_in_exec(process.pid)
    finally:
        process.kill()
        await process.wait()


async def test_a_program_has_its_environment_and_folder_and_the_domain_of_its_system(
    output: io.StringIO, tmp_path: Path
) -> None:
    """Whatever the environment of the supervisor says."""
    context = Context(transport="local", domain_id=42, discovery_range="OFF")
    script = "echo $ROS_DOMAIN_ID $ROS_AUTOMATIC_DISCOVERY_RANGE $AIONODE_LOOP; pwd; cat"
    async with System("tested", context=context, log=SystemLog(output)) as system:
        env = {"AIONODE_LOOP": "asyncio"}
        system.process("driver", ["sh", "-c", script], env=env, cwd=tmp_path)
        system.process("other", ["sh", "-c", script], env={"ROS_DOMAIN_ID": "7"})
        await system.wait()  # `cat` ends: standard input is empty

    assert system.log.last_lines("driver") == ["42 OFF asyncio", str(tmp_path)]
    assert system.log.last_lines("other")[0].startswith("7 OFF")


def test_a_program_has_seven_seconds_after_sigint_and_five_after_sigterm(system: System) -> None:
    """An aionode node needs at most five seconds to end its callbacks."""
    member = system.process("driver", FOREVER)

    assert isinstance(member, ProcessMember)
    assert member.process.ladder() == [("SIGINT", 7.0), ("SIGTERM", 5.0), ("SIGKILL", 0.0)]


async def test_each_policy_restarts_what_it_says(system: System) -> None:
    """None of them treats a clean exit as a failure."""
    async with system:
        for policy in ("never", "on-failure", "always"):
            system.process(policy, ["true"], restart=policy, min_delay_sec=0.0)
        system.process("broken", ["false"])
        ended = {"never": "ended", "on-failure": "ended", "broken": "failed"}
        await until(lambda: {name: system.status()[name].state for name in ended} == ended)
        await until(lambda: system.status()["always"].restarts >= 2)
        status = system.status()

    assert {name: status[name].state for name in ended} == ended
    assert {status[name].restarts for name in ended} == {0}


async def test_a_program_that_is_killed_is_restarted_on_failure(system: System) -> None:
    """An exit by a signal is a failure."""
    async with system:
        system.process("sleeper", FOREVER, restart="on-failure", min_delay_sec=0.0)
        await system.ready()
        first = system.status()["sleeper"].pid
        assert first is not None
        os.kill(first, signal.SIGKILL)
        await until(lambda: system.status()["sleeper"].restarts == 1)
        await until(lambda: system.status()["sleeper"].state == "running")

        assert system.status()["sleeper"].pid != first
        assert system.exit_status == 0


async def test_restarts_have_a_limit(system: System) -> None:
    """A program that fails at each start is given up, and the system exits with its status."""
    async with system:
        system.process(
            "failing", ["sh", "-c", "exit 3"], restart="always", max_restarts=2, min_delay_sec=0.0
        )
        await system.wait()

        status = system.status()["failing"]
        assert (status.state, status.restarts, status.exit_status) == ("failed", 2, 3)
        assert system.exit_status == 3


async def test_members_stop_in_reverse_order_each_after_the_one_before(
    system: System, tmp_path: Path
) -> None:
    """The driver must still run when its commander sends its last command."""
    ends = tmp_path / "ends"
    code = (
        "import signal, sys, time\n"
        "signal.signal(signal.SIGINT, lambda *_: sys.exit(0))\n"
        "print('up', flush=True)\n"
        "try: signal.pause()\n"
        f"finally: time.sleep(0.05); open({str(ends)!r}, 'a').write(sys.argv[1] + ' ')\n"
    )
    async with system:
        for name in ("first", "second", "third"):
            system.process(name, [sys.executable, "-S", "-c", code, name])
        names = ("first", "second", "third")
        await until(lambda: all(system.log.last_lines(name) == ["up"] for name in names))

    assert ends.read_text() == "third second first "


async def test_members_end_in_order_and_leave_nothing_when_the_guardian_was_killed(
    system: System, output: io.StringIO, tmp_path: Path
) -> None:
    """The supervisor does this itself, and then ends."""
    ends, orphan = tmp_path / "ends", tmp_path / "orphan"
    ending = f"trap 'sleep 0.05; echo $0 >>{ends}; exit' INT"
    script = f"{ending}; echo up; {SUPERVISED}; do sleep 0.01; done"
    deaf = f"trap '' INT; echo $$ >{orphan}; {SUPERVISED}; do sleep 1; done"
    forking = f'(setsid sh -c "{deaf}" &); exec sleep 60'.replace("$$", "\\$\\$")
    async with system:
        for name in ("first", "second"):
            system.process(name, ["sh", "-c", script, name])
        system.process("forking", ["sh", "-c", forking], term_after_sec=0.1)
        await until(lambda: orphan.exists() and orphan.read_text())
        await until(lambda: all(system.log.last_lines(member) for member in ("first", "second")))
        guardian().kill()
        await system.wait()
        assert not system.health().ok
        with pytest.raises(NotReadyError, match="could not be started"):
            await system.process("late", FOREVER).wait_ready()

    assert ends.read_text().split() == ["second", "first"]
    assert not alive(int(orphan.read_text()))
    assert system.exit_status == 128 + signal.SIGKILL
    assert "the first to fail was the guardian: it was killed by SIGKILL" in output.getvalue()


async def test_a_program_that_ends_after_the_guardian_was_killed_has_ended(system: System) -> None:
    """Its exit status is unknown, so it counts as failed."""
    async with system:
        system.process("brief", FOREVER)
        await system.ready()
        pid = system.status()["brief"].pid
        guardian().kill()
        await system.wait()
        os.kill(pid or 0, signal.SIGTERM)
        await until(lambda: system.status()["brief"].state == "failed")

        error = system.status()["brief"].error
        assert error == "ended; its exit status was lost with the guardian"


async def test_what_is_being_stopped_is_stopped_although_the_guardian_is_killed_meanwhile(
    system: System,
) -> None:
    """Otherwise the supervisor would wait forever."""
    script = f"trap '' INT; echo up; {SUPERVISED}; do sleep 0.1; done"
    async with system:
        system.process("slow", ["sh", "-c", script], term_after_sec=0.2)
        await until(lambda: system.log.last_lines("slow"))
        async with asyncio.TaskGroup() as tasks:
            stop = tasks.create_task(system.stop("slow"))
            await until(lambda: system.status()["slow"].state == "stopping")
            guardian().kill()
            async with asyncio.timeout(20.0):
                await stop

    assert system.status()["slow"].state == "stopped"


async def test_a_second_signal_kills_all_although_the_guardian_was_killed(system: System) -> None:
    """A user who presses Ctrl-C twice does not want to wait."""
    script = f"trap '' INT TERM; echo up; {SUPERVISED}; do sleep 1; done"
    async with system:
        system.process("deaf", ["sh", "-c", script])
        await until(lambda: system.log.last_lines("deaf"))
        pid = system.status()["deaf"].pid
        guardian().kill()
        await system.wait()
        for send in SENDS:
            send(0)
        await until(lambda: not alive(pid))


async def test_a_program_that_ignores_signals_is_killed(system: System) -> None:
    """SIGINT, then SIGTERM, then SIGKILL."""
    script = f"trap '' INT TERM; echo deaf; {SUPERVISED}; do sleep 1; done"
    async with system:
        system.process("deaf", ["sh", "-c", script], term_after_sec=0.1, kill_after_sec=0.1)
        await until(lambda: system.log.last_lines("deaf"))

    assert system.status()["deaf"].exit_status == 128 + signal.SIGKILL


async def test_ready_names_what_is_missing_and_shows_the_last_lines(system: System) -> None:
    """An error that only says "timeout" helps nobody."""
    async with system:
        system.process(
            "driver",
            ["sh", "-c", "echo no device; exec sleep 1000"],
            ready=[TopicPublished("/odom", timeout_sec=0.2), ServiceReady("reset", 0.2)],
        )
        with pytest.raises(NotReadyError) as caught:
            await system.ready()

    assert "a publisher of /odom (waited 0.2 s)" in caught.value.problem
    assert "service /reset" in caught.value.problem
    assert caught.value.last_lines == ("no device",)


async def test_ready_fails_at_once_for_a_program_that_has_ended(system: System) -> None:
    """The awaited fact can no longer happen."""
    async with system:
        system.process("driver", ["sh", "-c", "exit 4"], ready=NodeExists("/driver"))
        with pytest.raises(NotReadyError, match="ended with exit status 4"):
            await system.ready()


async def test_a_program_that_is_not_there_fails_and_says_so(
    system: System, output: io.StringIO
) -> None:
    """A typo is reported, and the others run."""
    async with system:
        system.process("typo", ["no-such-program"])
        await system.wait()

    assert system.exit_status == 127
    assert "no-such-program: could not be started" in output.getvalue()


@pytest.mark.parametrize("room", range(1, 12))
async def test_a_program_for_which_no_descriptor_is_left_fails_and_says_so(
    system: System, output: io.StringIO, room: int
) -> None:
    """Whichever file hits the limit, nothing stays open and the others run."""
    limit, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    async with system:
        system.process("first", ["sleep", "60"])
        await system.ready()
        before = [int(path.name) for path in Path("/proc/self/fd").iterdir()]
        highest = max(before)
        fillers = [os.open(os.devnull, os.O_RDONLY) for _ in range(highest + 1 - len(before))]
        resource.setrlimit(resource.RLIMIT_NOFILE, (highest + room, hard))
        try:
            system.process("second", ["true"])
            while system.status()["second"].state not in {"failed", "ended"}:
                await system.changed()
            is_short = system.status()["second"].state == "failed"
        finally:
            resource.setrlimit(resource.RLIMIT_NOFILE, (limit, hard))
            for filler in fillers:
                os.close(filler)
        after = list(Path("/proc/self/fd").iterdir())
        assert system.status()["first"].state == "running"

    assert len(after) == len(before)
    assert is_short == ("raise `ulimit -n`" in output.getvalue())
    assert is_short or room > 3


async def test_a_member_starts_after_those_that_it_needs_are_ready(system: System) -> None:
    """A node whose driver never becomes ready is not started."""
    async with system:
        system.process("driver", FOREVER, ready=NodeExists("/driver", 0.1))
        system.process("planner", FOREVER, after="driver")
        await until(lambda: system.status()["planner"].state == "failed")

        assert system.status()["planner"].pid is None
        assert "driver" in system.status()["planner"].error


async def test_a_required_member_ends_the_system(system: System, output: io.StringIO) -> None:
    """The report names the first member to end, with its status and last lines."""
    async with system:
        system.process("sleeper", FOREVER)
        system.process("brain", ["sh", "-c", "echo out of memory; exit 9"], required=True)
        await system.wait()

    assert system.exit_status == 9
    assert "the first to fail was brain: it ended with exit status 9" in output.getvalue()
    assert "  out of memory" in output.getvalue()


async def test_the_exit_status_is_that_of_the_first_that_failed_for_good(
    system: System, tmp_path: Path
) -> None:
    """A member that succeeded after a restart, or ended later, does not count."""
    script = "[ -e $0 ] || { : >$0; exit 2; }"
    async with system:
        again = ["sh", "-c", script, f"{tmp_path}/once"]
        system.process("again", again, restart="on-failure", min_delay_sec=0.0)
        await until(lambda: system.status()["again"].state == "ended")
        system.process("first", ["sh", "-c", "exit 3"])
        await until(lambda: system.status()["first"].state == "failed")
        system.process("second", ["sh", "-c", "exit 4"])
        await system.wait()

    assert [(end.name, end.status) for end in system.ends if end.failed] == [
        ("again", 2),
        ("first", 3),
        ("second", 4),
    ]
    assert system.exit_status == 3


async def test_a_member_stops_and_starts_with_the_one_it_fails_with(system: System) -> None:
    """A commander does not know that its driver was replaced."""
    async with system:
        system.process("driver", FOREVER, restart="on-failure", min_delay_sec=0.0)
        system.process("commander", FOREVER, fails_with="driver")
        await system.ready()
        first = system.status()["commander"].pid
        os.kill(system.status()["driver"].pid or 0, signal.SIGKILL)
        await until(
            lambda: (
                system.status()["commander"].restarts == 1
                and system.status()["commander"].state == "running"
            )
        )

        assert system.status()["commander"].pid != first


async def test_one_member_is_stopped_and_restarted_by_name(system: System) -> None:
    """The others keep running."""
    async with system:
        for name in ("a", "b"):
            system.process(name, FOREVER)
        await system.ready()
        before = {name: status.pid for name, status in system.status().items()}
        await system.restart("b")
        await system.ready()
        await system.stop("a")
        after = system.status()

        assert (after["a"].state, after["b"].state) == ("stopped", "running")
        assert not alive(before["a"])
        assert after["b"].pid != before["b"]
        assert system.health().ok
        with pytest.raises(MemberNotFoundError, match="the system has a, b"):
            await system.stop("c")


async def test_health_says_who_is_not_well(system: System) -> None:
    """/healthz answers with it."""
    async with system:
        system.process("good", FOREVER)
        system.process("bad", ["sh", "-c", "exit 1"])
        await until(lambda: system.status()["bad"].state == "failed")
        health = system.health()

    assert not health.ok
    assert health.problems == ("bad: failed: ended with exit status 1",)
    assert json.loads(json.dumps(asdict(health)))["members"] == {"good": "running", "bad": "failed"}


class Beacon(Node):
    """A node of a system."""

    def __init__(self) -> None:
        super().__init__("own_name")
        self.declare_parameter("text", "")


async def test_a_node_runs_as_tasks_with_its_parameters_and_name(system: System) -> None:
    """A class can be used twice, under two names."""
    nodes: list[Beacon] = []

    def make() -> Beacon:
        nodes.append(Beacon())
        return nodes[-1]

    async with system:
        system.node("left", make, parameters={"text": "1.0"}, namespace="robot")
        system.node("right", make)
        await system.ready()

        assert [node.get_fully_qualified_name() for node in nodes] == ["/robot/left", "/right"]
        assert nodes[0].get_parameter("text").value == "1.0"
        assert system.status()["left"].pid == os.getpid()
        nodes[1].destroy_node()
        await until(lambda: system.status()["right"].state == "ended")


async def test_a_node_is_named_by_its_module_and_its_topics_are_remapped(system: System) -> None:
    """The same holds for tasks of this process and for the command line of a process."""
    shared: dict[str, Any] = {"remappings": {"/cmd_vel": "/left/speed"}, "namespace": "robot"}
    wheels = "tests.system.robot:Wheels"
    apart = system.node("apart", wheels, processes=True, cwd="/", **shared)
    assert isinstance(apart, ProcessMember)
    assert apart.process.cwd == "/"
    words = " ".join(apart.process.argv[1:])
    assert words == (
        "-m aionode run tests.system.robot:Wheels --ros-args "
        "-r __node:=apart -r __ns:=/robot -r /cmd_vel:=/left/speed"
    )

    driver = system.process("driver", ["my_driver", "-x"], parameters={"speed": 2.0}, **shared)
    assert isinstance(driver, ProcessMember)
    assert " ".join(driver.process.argv) == (
        "my_driver -x --ros-args -r __ns:=/robot -r /cmd_vel:=/left/speed -p speed:=2.0"
    )

    inside = System("inside", context=system.context, log=system.log)
    async with inside:
        inside.node("wheels", wheels, **shared)
        await inside.ready()
        assert inside.graph_node.count_subscribers("/left/speed") == 1


class Server(Node):
    """A node with one endpoint of each kind that can be awaited."""

    def __init__(self) -> None:
        super().__init__("server")
        self.create_publisher(String, "/words", 1)
        self.create_service(Trigger, "/reset", lambda _: Trigger.Response())
        self.create_action_server(Fibonacci, "/count", lambda _: Fibonacci.Result())


async def test_what_is_awaited_comes_with_the_node_that_has_it(system: System) -> None:
    """A publisher of a topic, a server of a service or an action, or a node."""
    facts = [
        NodeExists("server", 5.0),
        TopicPublished(topic="words", timeout_sec=5.0),
        ServiceReady(service="/reset", timeout_sec=5.0),
        ActionReady(action="/count", timeout_sec=5.0),
    ]
    async with system:
        system.process("viewer", FOREVER, ready=facts)
        await settle()
        assert not system.member("viewer").is_ready()
        system.node("server", Server)
        await system.ready()

    assert [str(fact) for fact in facts] == [
        "node /server",
        "a publisher of /words",
        "service /reset",
        "action /count",
    ]


async def test_a_node_that_fails_is_restarted(system: System) -> None:
    """It is restarted like a process, by the same policy."""
    nodes: list[Beacon] = []

    def make() -> Beacon:
        nodes.append(Beacon())
        if len(nodes) == 1:
            nodes[0].create_timer(0.01, lambda: 1 // 0)
        return nodes[-1]

    async with system:
        system.node("beacon", make, restart="on-failure", min_delay_sec=0.0)
        await until(lambda: len(nodes) == 2)
        await system.ready()

        assert system.status()["beacon"].restarts == 1
        assert any("ZeroDivisionError" in line for line in system.log.last_lines("beacon"))


class Camera(LifecycleNode):
    """A managed node that records its transitions."""

    moves: ClassVar[list[str]] = []

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        """Record it."""
        self.moves.append(f"configure {self.get_name()}")
        return super().on_configure(state)

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Record it."""
        self.moves.append(f"activate {self.get_name()}")
        return super().on_activate(state)

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Record it."""
        self.moves.append(f"deactivate {self.get_name()}")
        return super().on_deactivate(state)


async def test_managed_nodes_are_active_when_ready_and_brought_down_before_the_end(
    system: System,
) -> None:
    """Members that need them wait for their states, not just their processes."""
    Camera.moves.clear()
    async with system:
        system.node("lidar", lambda: Camera("lidar"))
        system.node("camera", lambda: Camera("camera"), managed=["/lidar", "/camera"])
        system.process("viewer", FOREVER, after="camera", ready=NodeActive("/camera", 5.0))
        system.node("planner", lambda: Camera("planner"), after="viewer", managed="/planner")
        await system.ready()
        up = [
            f"{move} {node}" for move in ("configure", "activate") for node in ("lidar", "camera")
        ]
        up += ["configure planner", "activate planner"]
        assert Camera.moves == up

        Camera.moves.clear()
        await system.restart("planner")
        await system.ready()
        assert Camera.moves == ["deactivate planner", "configure planner", "activate planner"]
        Camera.moves.clear()

    assert Camera.moves == ["deactivate planner", "deactivate camera", "deactivate lidar"]


def test_members_may_be_added_before_there_is_an_event_loop(output: io.StringIO) -> None:
    """They start in this order when `async with` is entered."""
    system = System("early", context=Context(transport="local"), log=SystemLog(output))
    system.process("first", ["sh", "-c", "echo first"])
    system.node("second", Beacon)
    assert not system.health().ok
    assert [status.state for status in system.status().values()] == ["waiting", "waiting"]

    async def main() -> None:
        async with system:
            await system.ready()
            await until(lambda: "first | first" in output.getvalue())

    asyncio.run(main())


async def test_nothing_starts_while_the_system_ends(system: System) -> None:
    """A request to restart may come late."""
    async with system:
        member = system.process("sleeper", FOREVER)
        await system.ready()
    await member.restart()

    assert member.state == "stopped"


async def test_mistakes_in_a_description_are_refused_with_what_fits(system: System) -> None:
    """Before anything is started."""
    with pytest.raises(ValueError, match='use "never", "on-failure" or "always"'):
        system.process("a", FOREVER, restart="sometimes")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="use a list"):
        system.process("a", "sleep 1000")
    with pytest.raises(TypeError, match="is not a fact; use NodeExists"):
        system.process("a", FOREVER, ready="/odom")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="the options are min_delay_sec"):
        system.process("a", FOREVER, requird=True)  # type: ignore[call-arg]
    with pytest.raises(MemberNotFoundError):
        system.process("a", FOREVER, after="driver")
    with pytest.raises(ValueError, match="cannot be imported by a process of its own"):
        system.node("a", lambda: Beacon(), processes=True)  # noqa: PLW0108  # has no name
    with pytest.raises(ValueError, match="are for nodes with processes=True"):
        system.node("a", Beacon, cwd="/")
    limits: dict[str, Any] = {"memory_bytes": 10**9, "cpu_cores": 0.5}
    for processes in (False, True):
        with pytest.raises(TypeError, match="by CPUQuota= and MemoryMax= in its systemd unit"):
            system.node("a", Beacon, processes=processes, **limits)
    with pytest.raises(TypeError, match="limit the whole system by MemoryMax= in its systemd"):
        system.process("a", FOREVER, memory_bytes=10**9)  # type: ignore[call-arg]
    system.process("a", FOREVER)
    with pytest.raises(ValueError, match="this name is taken"):
        system.process("a", FOREVER)
