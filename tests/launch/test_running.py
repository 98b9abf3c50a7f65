"""Running launch files: what is started when, and what remains."""

from __future__ import annotations

import asyncio
import io
import os
import signal
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from aionode import Context, Node
from aionode.errors import LaunchFileError
from aionode.interfaces.composition_interfaces.srv import LoadNode
from aionode.launch import Plan, run_plan
from aionode.lifecycle import LifecycleNode
from aionode.system import System, SystemLog
from tests.launch.conftest import BODY, HEAD
from tests.support import fork_server
from tests.support.waiting import until
from tests.system.left import guardian

if TYPE_CHECKING:
    from tests.launch.conftest import Files

ROOT = Path(__file__).parents[2]


class Robot:
    """A system that runs a launch file, and its output."""

    def __init__(self, files: Files) -> None:
        self.files = files
        self.output = io.StringIO()
        context = Context(transport="local")
        self.system = System("tested", context=context, log=SystemLog(self.output))

    def plan(self, entities: str, imports: str = "") -> Plan:
        """Return the plan of a Python file with these entities."""
        text = HEAD + textwrap.dedent(imports) + BODY.format(entities=textwrap.dedent(entities))
        return Plan(self.files.write("a.launch.py", text))

    async def run(self, entities: str, imports: str = "") -> list[str]:
        """Run a file until it is over, and return the texts of the log."""
        async with self.system:
            await run_plan(self.plan(entities, imports), self.system)
        return self.lines()

    def lines(self) -> list[str]:
        """Return the texts of the log."""
        return [line.partition(" | ")[2] for line in self.output.getvalue().splitlines()]


@pytest.fixture
def robot(files: Files) -> Robot:
    """Return a system without network."""
    return Robot(files)


async def test_the_end_of_a_process_starts_the_next_one(robot: Robot) -> None:
    """An event handler, which may be a function that gets the exit status."""
    lines = await robot.run(
        """
        first := ExecuteProcess(cmd=['sh', '-c', 'exit 3'], name='first'),
        second := ExecuteProcess(cmd=['sleep', '1000'], name='second'),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=lambda event, context: [
            ExecuteProcess(cmd=['echo', f'status {event.returncode}'], name='third'),
        ])),
        RegisterEventHandler(OnProcessExit(
            target_action=lambda action: action not in (first, second),
            on_exit=[Shutdown(reason='all is done')])),
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg='good bye')])),
        """
    )

    assert "status 3" in lines
    assert lines.index("shutdown: all is done") < lines.index("good bye")
    assert robot.system.exit_status == 3


async def test_a_launch_is_over_when_nothing_can_start_any_more(robot: Robot) -> None:
    """A waiting timer may start something, an ended process may not."""
    lines = await robot.run(
        """
        ExecuteProcess(cmd=['true'], name='short'),
        TimerAction(period=0.2, actions=[ExecuteProcess(cmd=['echo', 'later'], name='timed')]),
        """
    )

    assert "later" in lines


SLEEPER = "ExecuteProcess(cmd=['sleep', '1000'], name='sleeper'),"


async def test_a_launch_ends_when_its_guardian_is_killed(robot: Robot) -> None:
    """Nobody would be left to stop its processes if it were killed itself."""
    async with robot.system, asyncio.TaskGroup() as tasks:
        running = tasks.create_task(run_plan(robot.plan(SLEEPER), robot.system))
        await until(lambda: bool(robot.system.status()))
        await robot.system.ready()

        guardian().kill()

        await running
    assert robot.system.exit_status == 128 + signal.SIGKILL


async def test_a_launch_ends_when_its_system_is_asked_to(robot: Robot) -> None:
    """``aionode system stop --all`` says that it ends."""
    async with robot.system, asyncio.TaskGroup() as tasks:
        running = tasks.create_task(run_plan(robot.plan(SLEEPER), robot.system))
        await until(lambda: bool(robot.system.status()))

        robot.system.request_end()

        await running
    assert robot.system.exit_status == 0


async def test_a_main_function_of_a_system_ends_with_it() -> None:
    """It may wait for something that will never happen."""
    async with System("tested", context=Context(transport="local")) as system:

        async def main(system: System) -> None:
            system.request_end()
            await asyncio.Event().wait()

        await system.run_main(main)


async def test_a_start_is_an_event(robot: Robot) -> None:
    """Even of a process that ends at once."""
    lines = await robot.run(
        """
        first := ExecuteProcess(cmd=['true'], name='first'),
        RegisterEventHandler(OnProcessStart(target_action=first, on_start=[LogInfo(msg='begun')])),
        """
    )

    assert "begun" in lines


async def test_a_process_reads_its_parameters_from_a_file(robot: Robot) -> None:
    """The file is removed when the launch is over."""
    script = robot.files.write(
        "node.sh", '#!/bin/sh\nfor last; do :; done\ncat "$last"; echo $last'
    )
    Path(script).chmod(0o755)
    lines = await robot.run(f"Node(executable={script!r}, name='n', parameters=[{{'a': [1, 2]}}]),")

    assert "/n:" not in lines
    assert [line.strip() for line in lines if line.strip() in ("n:", "a:", "- 1", "- 2")]
    file = next(line for line in lines if line.endswith(".yaml"))
    assert not Path(file).exists()


async def test_a_process_is_signalled_and_stopped_by_events(robot: Robot) -> None:
    """`SignalProcess` and `ShutdownProcess`, for the processes that a function selects."""
    lines = await robot.run(
        """
        first := ExecuteProcess(cmd=['sh', '-c',
            'trap "exit 7" USR1; echo up; while :; do sleep 0.05; done']),
        RegisterEventHandler(OnProcessStart(target_action=first, on_start=[
            TimerAction(period=0.3, actions=[EmitEvent(event=SignalProcess(
                signal_number='SIGUSR1', process_matcher=matches_action(first)))])])),
        """
    )

    assert any("status 7" in line for line in lines)


async def test_components_that_are_aionode_classes_run_as_tasks(robot: Robot) -> None:
    """A container of them needs no process."""
    plan = robot.plan(
        """
        ComposableNodeContainer(name='c', namespace='', composable_node_descriptions=[
            ComposableNode(package='', plugin='aionode.examples.pubsub:Talker', name='talker'),
            ComposableNode(package='', plugin='aionode.examples.pubsub:Listener', name='ear',
                           namespace='robot')]),
        """
    )
    async with robot.system as system, asyncio.TaskGroup() as tasks:
        running = tasks.create_task(run_plan(plan, system))
        await until(lambda: len(system.status()) == 2)
        await system.ready()
        names = set(system.graph_node.get_node_names_and_namespaces())
        running.cancel()

    assert {("talker", "/"), ("ear", "/robot")} <= names


async def test_plugins_that_aionode_has_run_as_tasks(robot: Robot) -> None:
    """Components of ROS's packages that launch files load into containers, with parameters."""
    plan = robot.plan(
        """
        ComposableNodeContainer(name='c', namespace='', composable_node_descriptions=[
            ComposableNode(package='topic_tools', plugin='topic_tools::RelayNode',
                           parameters=[{'input_topic': 'chatter'}]),
            ComposableNode(package='teleop_twist_joy', plugin='teleop_twist_joy::TeleopTwistJoy',
                           remappings=[('cmd_vel', 'wheels')])]),
        """
    )
    async with robot.system as system, asyncio.TaskGroup() as tasks:
        running = tasks.create_task(run_plan(plan, system))
        await until(lambda: len(system.status()) == 2)
        await system.ready()
        names = {name for name, _ in system.graph_node.get_node_names_and_namespaces()}
        topics = {name for name, _ in system.graph_node.get_topic_names_and_types()}
        running.cancel()

    assert {"relay", "teleop_twist_joy_node"} <= names
    assert "/wheels" in topics


async def test_a_component_that_cannot_start_says_so_without_a_traceback(robot: Robot) -> None:
    """As the program does; the traceback would be of aionode's own lines."""
    lines = await robot.run(
        """
        ComposableNodeContainer(name='c', namespace='', composable_node_descriptions=[
            ComposableNode(package='vesc_driver', plugin='vesc_driver::VescDriver')]),
        """
    )

    assert "error: parameter 'port' is missing; it names a device: /dev/ttyACM0" in lines
    assert not any("Traceback" in line for line in lines)


async def test_a_managed_node_may_be_activated_as_it_starts(robot: Robot) -> None:
    """With `autostart`, once it answers."""
    plan = robot.plan(
        """
        LifecycleNode(executable='sh', arguments=['-c', 'sleep 1000'], name='arm', namespace='/',
                      autostart=True),
        """
    )
    async with robot.system as system, asyncio.TaskGroup() as tasks:
        running = tasks.create_task(run_plan(plan, system))
        async with LifecycleNode("arm", context=system.context) as arm:  # in place of the program
            await until(lambda: arm.lifecycle_state.label == "active")
        running.cancel()


async def test_the_states_of_a_managed_node_are_events(robot: Robot) -> None:
    """As in ROS's lifecycle demo: it is configured, and activated once it is inactive."""
    plan = robot.plan(
        """
        arm := LifecycleNode(executable='sh', arguments=['-c', 'sleep 1000'], name='arm',
                             namespace='/'),
        RegisterEventHandler(OnStateTransition(target_lifecycle_node=arm, goal_state='inactive',
            entities=[LogInfo(msg='is inactive'), EmitEvent(event=ChangeState(
                lifecycle_node_matcher=matches_action(arm),
                transition_id=Transition.TRANSITION_ACTIVATE))])),
        RegisterEventHandler(OnStateTransition(target_lifecycle_node=arm, goal_state='active',
            entities=[Shutdown(reason='it moves')])),
        LifecycleTransition(lifecycle_node_names=['/arm'],
                            transition_ids=[Transition.TRANSITION_CONFIGURE]),
        """,
        imports="""
        from launch_ros.event_handlers import OnStateTransition
        from launch_ros.events.lifecycle import ChangeState
        from lifecycle_msgs.msg import Transition
        """,
    )
    async with robot.system as system, LifecycleNode("arm", context=system.context):
        await run_plan(plan, system)

    lines = robot.lines()
    assert lines.index("is inactive") < lines.index("shutdown: it moves")


async def test_a_container_of_another_program_is_asked_to_load_its_nodes(robot: Robot) -> None:
    """By the service of ROS's containers, one after another; the log contains the answers."""
    plan = robot.plan(
        """
        LoadComposableNodes(target_container='/c', composable_node_descriptions=[
            ComposableNode(package='robot', plugin='robot::Camera', name='eye', namespace='head',
                           parameters=[{'rate': 5.0}], remappings=[('image', 'picture')]),
            ComposableNode(package='robot', plugin='robot::Nothing')]),
        """
    )
    asked = []

    def load(request: LoadNode.Request, response: LoadNode.Response) -> LoadNode.Response:
        asked.append(request)
        response.success = request.plugin_name == "robot::Camera"
        response.full_node_name = "/head/eye" if response.success else ""
        response.error_message = "" if response.success else "no such plugin"
        return response

    async with robot.system as system, Node("c", context=system.context) as container:
        container.create_service(LoadNode, "/c/_container/load_node", load)
        await run_plan(plan, system)

    assert [(item.node_name, item.node_namespace) for item in asked] == [("eye", "/head"), ("", "")]
    assert (list(asked[0].remap_rules), asked[0].parameters[0].value.double_value) == (
        ["image:=picture"],
        5.0,
    )
    assert robot.lines()[:2] == [
        "/c: loaded /head/eye",
        "/c: cannot load robot::Nothing: no such plugin",
    ]


async def test_a_launch_continues_while_its_only_process_is_restarted(robot: Robot) -> None:
    """On request; the event handlers are called for both runs."""
    plan = robot.plan(
        """
        only := ExecuteProcess(cmd=['sleep', '1000'], name='only'),
        RegisterEventHandler(OnProcessStart(target_action=only, on_start=[LogInfo(msg='begun')])),
        """
    )
    async with robot.system as system, asyncio.TaskGroup() as tasks:
        running = tasks.create_task(run_plan(plan, system))
        await until(lambda: robot.lines().count("begun") == 1)
        await system.restart("only-1")
        await until(lambda: robot.lines().count("begun") == 2 or running.done())
        assert not running.done()
        running.cancel()


async def test_a_program_that_changes_is_restarted(robot: Robot) -> None:
    """With `watch`; even one that has ended, such as a program that was saved half written."""
    programs = [Path(robot.files.write(name, "exit 3")) for name in ("ends.sh", "stays.sh")]
    plan = robot.plan(
        f"""
        ExecuteProcess(cmd=['sh', {str(programs[0])!r}], name='ending'),
        ExecuteProcess(cmd=['sh', {str(programs[1])!r}], name='other'),
        """
    )
    async with robot.system as system, asyncio.TaskGroup() as tasks:
        running = tasks.create_task(run_plan(plan, system, watch=True))
        await until(lambda: [item.state for item in system.status().values()] == ["failed"] * 2)
        os.utime(programs[0], (0, 0))
        await until(lambda: system.status()["ending-1"].restarts)
        assert system.status()["other-2"].restarts == 0
        running.cancel()


async def test_a_command_runs_once_all_is_ready(robot: Robot) -> None:
    """One example is systemd-notify."""
    mark = robot.files.folder / "ready"
    async with robot.system as system, asyncio.TaskGroup() as tasks:
        plan = robot.plan("ExecuteProcess(cmd=['sleep', '1000']),")
        running = tasks.create_task(run_plan(plan, system, once_ready=f"touch {mark}"))
        await until(mark.exists)
        running.cancel()


async def test_the_command_ends_with_the_launch(robot: Robot) -> None:
    """Nothing is left behind."""
    mark = robot.files.folder / "ready"
    async with robot.system as system, asyncio.TaskGroup() as tasks:
        plan = robot.plan("ExecuteProcess(cmd=['sleep', '1000']),")
        command = f"echo $$ > {mark}; exec sleep 1000"
        running = tasks.create_task(run_plan(plan, system, once_ready=command))
        await until(lambda: mark.exists() and mark.read_text().strip())
        running.cancel()

    with pytest.raises(ProcessLookupError):
        os.kill(int(mark.read_text()), 0)


async def test_what_a_process_writes_is_an_event(robot: Robot) -> None:
    """The two streams are distinguished, everything arrives before the exit, and it is logged."""
    lines = await robot.run(
        """
        first := ExecuteProcess(cmd=['sh', '-c', 'echo out; echo err >&2; printf rest']),
        RegisterEventHandler(OnProcessIO(
            target_action=first,
            on_stdout=lambda event: LogInfo(msg=f'1 {event.text!r}'),
            on_stderr=lambda event: LogInfo(msg=f'2 {event.text!r}'))),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[LogInfo(msg='over')])),
        """
    )

    told = [line for line in lines if line[:2] in ("1 ", "2 ")]
    assert "2 b'err\\n'" in told
    assert "".join(line[4:-1] for line in told if line[0] == "1") == "out\\nrest"
    assert lines.index("over") > max(map(lines.index, told))
    assert {"out", "err", "rest"} <= set(lines)


async def test_the_output_of_a_process_can_be_kept(robot: Robot) -> None:
    """Functions in the file get it from the action."""
    lines = await robot.run(
        """
        first := ExecuteProcess(cmd=['echo', 'hello'], cached_output=True, log_cmd=True),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=lambda event, context: [
            LogInfo(msg=f'kept {event.action.get_stdout()!r} {event.action.get_stderr()!r}')])),
        """
    )

    assert "kept 'hello\\n' ''" in lines
    assert "process details: cmd='echo hello'" in lines


async def test_the_completion_of_an_action_is_an_event(robot: Robot) -> None:
    """A process completes when it ends, a timer when it has fired; others complete at once."""
    lines = await robot.run(
        """
        *[RegisterEventHandler(OnExecutionComplete(
            target_action=action, on_completion=[LogInfo(msg=f'{name} is complete')]))
          for name, action in ACTIONS.items()],
        *ACTIONS.values(),
        """,
        imports="""
        ACTIONS = {
            'process': ExecuteProcess(cmd=['sh', '-c', 'echo running']),
            'timer': TimerAction(period=0.01, actions=[LogInfo(msg='fired')]),
            'setting': SetLaunchConfiguration('a', 'b'),
            'never': LogInfo(msg='none', condition=IfCondition('false')),
        }
        """,
    )

    assert lines.index("running") < lines.index("process is complete")
    assert lines.index("fired") < lines.index("timer is complete")
    assert "setting is complete" in lines
    assert "never is complete" not in lines


async def test_a_coroutine_runs_beside_the_processes(robot: Robot) -> None:
    """Whatever it adds to its context is executed at once, and the launch waits for its end."""
    lines = await robot.run(
        "OpaqueCoroutine(coroutine=work, args=['word']),",
        imports="""
        import asyncio
        async def work(context, word):
            LogInfo(msg=f'{word} first').execute(context)
            await asyncio.sleep(0.01)
            await context.emit_event(ShutdownEvent(reason='the work is done'))
            await asyncio.Event().wait()
        """,
    )

    assert lines.index("word first") < lines.index("shutdown: the work is done")


async def test_a_coroutine_that_fails_is_one_error_with_its_line(robot: Robot) -> None:
    """A function that fails is one, too."""
    with pytest.raises(LaunchFileError, match=r"a\.launch\.py:\d+: OpaqueCoroutine: broken"):
        await robot.run(
            "OpaqueCoroutine(coroutine=work, ignore_context=True),",
            imports="""
            async def work():
                raise ValueError("broken")
            """,
        )


async def test_a_process_is_ended_as_its_time_limits_say(robot: Robot) -> None:
    """A launch configuration applies to all; the exit code is that of Python's library."""
    await robot.run(
        """
        SetLaunchConfiguration('sigkill_timeout', '0.1'),
        first := ExecuteProcess(
            cmd=['sh', '-c', 'trap "" INT TERM; echo up; while :; do sleep 0.05; done'],
            sigterm_timeout='0.1'),
        RegisterEventHandler(OnProcessIO(target_action=first, on_stdout=lambda event: [
            EmitEvent(event=ShutdownProcess(process_matcher=matches_action(first)))])),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=lambda event, context: [
            LogInfo(msg=f'code {event.returncode}')])),
        """
    )

    assert "code -9" in robot.lines()


async def test_a_process_has_the_environment_that_the_file_gives_it(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An unset variable is missing; and all processes are in the domain of the system."""
    monkeypatch.setenv("GONE", "1")
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    lines = await robot.run(
        """
        UnsetEnvironmentVariable('GONE'),
        ExecuteProcess(cmd=['sh', '-c', 'echo "gone: $GONE" "domain: $ROS_DOMAIN_ID"']),
        """
    )

    assert f"gone:  domain: {robot.system.context.domain_id}" in lines


async def test_a_process_may_print_to_a_terminal(robot: Robot) -> None:
    """With `emulate_tty`; its lines end like others."""
    lines = await robot.run(
        """
        ExecuteProcess(cmd=['sh', '-c', 'test -t 1 && echo yes'], emulate_tty=True),
        ExecuteProcess(cmd=['sh', '-c', 'test -t 1 || echo no']),
        """
    )

    assert {"yes", "no"} <= set(lines)


async def test_nothing_begins_at_a_shutdown(robot: Robot) -> None:
    """Everything is ending, so a timer or a coroutine would never be done."""
    lines = await robot.run(
        """
        RegisterEventHandler(OnShutdown(on_shutdown=[
            TimerAction(period=0.0, actions=[LogInfo(msg='late')]),
            OpaqueCoroutine(coroutine=work), LogInfo(msg='good bye')])),
        """,
        imports="""
        async def work(context):
            raise ValueError
        """,
    )

    assert lines[-1] == "good bye"


async def test_an_error_in_an_event_handler_ends_the_launch(robot: Robot) -> None:
    """It is an error of the launch file, with its line."""
    with pytest.raises(LaunchFileError, match="'nope' does not exist"):
        await robot.run(
            """
            first := ExecuteProcess(cmd=['true']),
            ExecuteProcess(cmd=['sleep', '1000']),
            RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[
                LogInfo(msg=LaunchConfiguration('nope'))])),
            """
        )


async def test_a_file_may_describe_its_system_itself(robot: Robot) -> None:
    """Without the names of launch."""
    path = robot.files.write(
        "robot.py",
        """
        async def main(system):
            system.process("hello", ["echo", "from main"])
        """,
    )
    async with robot.system as system:
        await run_plan(Plan(path), system)

    assert "from main" in robot.lines()


def test_a_program_may_run_launch_descriptions_itself(files: Files) -> None:
    """With `LaunchService`, which another thread may stop."""
    program = files.write(
        "program.py",
        HEAD
        + """
import sys, threading
from launch import LaunchDescription, LaunchService
service = LaunchService(argv=sys.argv[1:])
say = ExecuteProcess(cmd=['echo', 'hello'])
more = LaunchDescription([ExecuteProcess(cmd=['echo', 'more'])])
service.include_launch_description(LaunchDescription([
    say,
    RegisterEventHandler(OnProcessExit(target_action=say, on_exit=lambda event, context: [
        OpaqueFunction(function=lambda _: threading.Thread(target=stop).start())])),
]))
def stop():
    service.include_launch_description(more)
    service.emit_event(ShutdownEvent(reason='enough'))
status = service.run(shutdown_when_idle=False)
service.include_launch_description(LaunchDescription([LogInfo(msg=LaunchConfiguration('nope'))]))
print('status', status, service.run())
""",
    )
    done = fork_server.run(["-m", "aionode.rclpy", str(program)], env=os.environ, timeout=50)

    assert "| hello\n" in done.stdout, done.stderr
    assert "shutdown: enough" in done.stdout
    assert done.stdout.endswith("status 0 1\n")
    assert "program.py" in done.stderr
    assert "'nope' does not exist" in done.stderr


def test_the_command_starts_nothing_of_a_bad_file(files: Files) -> None:
    """The error is one line, and the first process has left no mark."""
    mark = files.folder / "started"
    path = files.write(
        "bad.launch.xml",
        f"""<launch>
        <executable cmd="touch {mark}"/>
        <executable cmd="echo $(var nope)"/>
        </launch>""",
    )
    done = fork_server.run(["-m", "aionode", "launch", str(path)], env=os.environ, timeout=50)

    assert done.returncode != 0
    assert done.stderr.startswith(f"{path}:3: ExecuteProcess: launch configuration 'nope'")
    assert len(done.stderr.splitlines()) == 1
    assert not mark.exists()


@pytest.mark.slow
@pytest.mark.one_loop
def test_the_robot_of_the_examples_starts_and_leaves_nothing() -> None:
    """One command, four processes, a table; Ctrl-C ends it in order."""
    command = [sys.executable, "-m", "aionode", "launch", str(ROOT / "examples/robot.launch.py")]
    lines: list[str] = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        while not any("I heard" in line for line in lines):
            line = process.stdout.readline()
            assert line, lines
            lines.append(line)
        process.send_signal(signal.SIGINT)
        lines += process.stdout.read().splitlines()

    assert process.returncode in (0, 130)
    running = [line.partition("running, process ")[2].strip() for line in lines]
    pids = [pid for pid in running if pid]
    assert len(pids) == 4, lines
    assert not [pid for pid in pids if Path(f"/proc/{pid}").exists()]


@pytest.mark.parametrize("watch", [False, True])
async def test_nothing_holds_a_launch_whose_guardian_is_killed(robot: Robot, watch: bool) -> None:
    """Neither a timer that is due in an hour nor a process that is to be restarted.

    Processes end by the usual signals, and event handlers see the shutdown.
    """
    plan = robot.plan(
        """
        ExecuteProcess(cmd=['sh', '-c', 'trap "echo good bye; exit" INT; echo up; while :; do '
            'sleep 0.01; done'], respawn=True, name='driver'),
        TimerAction(period=3600.0, actions=[LogInfo(msg='late')]),
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg='seen')])),
        """
    )
    async with asyncio.timeout(30.0), robot.system, asyncio.TaskGroup() as tasks:
        work = tasks.create_task(run_plan(plan, robot.system, watch=watch))
        await until(lambda: "up" in robot.lines())
        guardian().kill()
        await work

    assert {"seen", "good bye"} <= set(robot.lines())
