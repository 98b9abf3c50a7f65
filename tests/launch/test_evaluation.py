"""What Python launch files start."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from aionode.errors import LaunchFileError
from aionode.launch import Plan
from aionode.launch.plan import Process, Watch
from tests.launch.conftest import BODY, HEAD

if TYPE_CHECKING:
    from tests.launch.conftest import Files


def commands(records: list[dict[str, Any]]) -> list[list[Any]]:
    """Return the command lines."""
    return [record["argv"] for record in records if "argv" in record]


def test_a_node_gets_its_name_parameters_and_remappings_in_ros_order(files: Files) -> None:
    """The same command line as ROS's launch builds, so that any node understands it."""
    records = files.python(
        """
        GroupAction([
            PushRosNamespace('robot'),
            SetParameter('use_sim_time', True),
            SetRemap('scan', 'laser'),
            Node(executable='talker', name='t', arguments=['--fast'],
                 ros_arguments=['--log-level', 'debug'],
                 parameters=[{'a': 1, 'b': {'c': [1, 2]}}], remappings=[('chatter', '/c')]),
        ]),
        Node(executable='listener'),
        """
    )

    assert commands(records) == [
        [
            "talker", "--fast", "--ros-args", "--log-level", "debug",
            "--ros-args", "-r", "__node:=t", "-r", "__ns:=/robot",
            "-p", "use_sim_time:=True",
            "--params-file", {"/robot/t": {"ros__parameters": {"a": 1, "b.c": [1, 2]}}},
            "-r", "scan:=laser", "-r", "chatter:=/c",
        ],
        ["listener", "--ros-args"],
    ]  # fmt: skip


def test_a_group_keeps_what_it_sets(files: Files) -> None:
    """Namespaces, arguments and the environment end with the group, unless it is not scoped."""
    records = files.python(
        """
        SetLaunchConfiguration('x', '1'),
        GroupAction([SetLaunchConfiguration('x', '2'), SetEnvironmentVariable('INNER', 'yes')]),
        GroupAction([SetLaunchConfiguration('y', '3')], scoped=False),
        ExecuteProcess(cmd=['echo', LaunchConfiguration('x'), LaunchConfiguration('y')]),
        """
    )

    assert commands(records) == [["echo", "1", "3"]]
    assert "INNER" not in records[0]["env"]


def test_only_the_process_gets_a_variable(files: Files, monkeypatch: pytest.MonkeyPatch) -> None:
    """A launch file changes the processes that it starts, and not the process that reads it."""
    monkeypatch.setenv("PATHS", "a")
    records = files.python(
        """
        AppendEnvironmentVariable('PATHS', 'b'),
        AppendEnvironmentVariable('PATHS', 'c', prepend=True),
        ExecuteProcess(cmd=['env'], additional_env={'MORE': EnvironmentVariable('PATHS')}),
        """
    )

    assert records[0]["env"] == {"PATHS": "c:a:b", "MORE": "c:a:b"}
    assert subprocess.os.environ["PATHS"] == "a"  # type: ignore[attr-defined]  # as the process sees it


@pytest.mark.parametrize(
    ("substitution", "text"),
    [
        ("PathJoinSubstitution(['/a', 'b', 'c.yaml'])", "/a/b/c.yaml"),
        ("PathSubstitution('/a') / 'b'", "/a/b"),
        ("PythonExpression([\"'\", LaunchConfiguration('x'), \"' == '5'\"])", "True"),
        ("PythonExpression(['round(pi, 2)'])", "3.14"),
        ("EnvironmentVariable('NOT_THERE', default_value='d')", "d"),
        ("LaunchConfiguration('none', default=['a', 'b'])", "ab"),
        ("EqualsSubstitution(LaunchConfiguration('x'), 5.0)", "true"),
        ("NotEqualsSubstitution('a', 'b')", "true"),
        ("AndSubstitution('true', NotSubstitution('true'))", "false"),
        ("OrSubstitution('false', '1')", "true"),
        ("AnySubstitution('false', 'false')", "false"),
        ("AllSubstitution('true', 'true')", "true"),
        ("IfElseSubstitution('true', 'a', 'b')", "a"),
        ("Command(['printf hello'])", "hello"),
        ("TextSubstitution(text='t')", "t"),
        ("StringJoinSubstitution(['a', 'b'], delimiter='-')", "a-b"),
        ("FileContent([ThisLaunchFileDir(), '/text'])", "content"),
        ("[FindExecutable(name='no'), '']", "/bin/no"),
        ("LaunchLogDir()", "/logs"),
        ("EqualsSubstitution(AnonName('a'), AnonName('a'))", "true"),
        ("IfElseSubstitution(EqualsSubstitution(None, ''), if_value='a')", "a"),
        ("EnvironmentVariable('HOME_OF_LOGS')", "/logs"),
    ],
)
def test_a_substitution_becomes_a_text(
    files: Files, substitution: str, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each kind, as evaluated by ROS's launch."""
    monkeypatch.setenv("ROS_LOG_DIR", "/logs")
    monkeypatch.setenv("HOME_OF_LOGS", "/logs")
    monkeypatch.setattr("shutil.which", lambda name, path: f"/bin/{name}")
    files.write("text", "content")
    records = files.python(
        f"SetLaunchConfiguration('x', '5'), ExecuteProcess(cmd=['echo', {substitution}]),"
    )

    assert commands(records) == [["echo", text]]


def test_a_condition_leaves_an_action_out(files: Files) -> None:
    """For all kinds of conditions."""
    records = files.python(
        """
        DeclareLaunchArgument('sim', default_value='true'),
        ExecuteProcess(cmd=['a'], condition=IfCondition(LaunchConfiguration('sim'))),
        ExecuteProcess(cmd=['b'], condition=UnlessCondition(LaunchConfiguration('sim'))),
        ExecuteProcess(cmd=['c'], condition=LaunchConfigurationEquals('sim', 'true')),
        ExecuteProcess(cmd=['d'], condition=LaunchConfigurationNotEquals('sim', 'true')),
        """
    )

    assert commands(records) == [["a"], ["c"]]


def test_an_included_file_gets_its_arguments_and_knows_its_place(files: Files) -> None:
    """It may be in another language; the including file then has its own folder again."""
    files.write(
        "sub/inner.launch.xml",
        """
        <launch>
          <arg name="robot"/>
          <executable cmd="echo $(var robot) $(dirname)"/>
        </launch>
        """,
    )
    records = files.python(
        """
        IncludeLaunchDescription([ThisLaunchFileDir(), '/sub/inner.launch.xml'],
                                 launch_arguments={'robot': 'r1'}.items()),
        ExecuteProcess(cmd=['echo', ThisLaunchFileDir()]),
        """
    )

    folder = str(files.folder)
    assert commands(records) == [["echo", "r1", f"{folder}/sub"], ["echo", folder]]


def test_timers_and_event_handlers_are_part_of_the_plan(files: Files) -> None:
    """Each says when it does what, even nested ones."""
    records = files.python(
        """
        first := Node(executable='talker', name='talker'),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[
            TimerAction(period=2.5, actions=[ExecuteProcess(cmd=['next'])]),
            EmitEvent(event=ShutdownEvent(reason='over')),
        ])),
        RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: None)),
        """
    )

    assert [(record["when"], record.get("argv")) for record in records[1:]] == [
        (["at the exit of talker", "after 2.5 s"], ["next"]),
        (["at the exit of talker"], None),
        (["at the shutdown"], None),
    ]


def test_what_belongs_to_an_event_is_named_before_it_happens(files: Files) -> None:
    """The tutorial of event handlers logs the reason of a shutdown."""
    records = files.python(
        """
        RegisterEventHandler(OnShutdown(on_shutdown=[
            LogInfo(msg=['asked to end: ', LocalSubstitution('event.reason')])])),
        """
    )

    assert records[0]["log"] == "asked to end: <event.reason>"


def test_an_opaque_function_sees_the_context_and_returns_actions(files: Files) -> None:
    """It is called while the file is evaluated, with everything set before it."""
    records = files.python(
        "SetLaunchConfiguration('x', '5'), OpaqueFunction(function=more, args=['word']),",
        imports="""
        def more(context, word):
            value = LaunchConfiguration('x').perform(context)
            return [ExecuteProcess(cmd=['echo', value, word])]
        """,
    )

    assert commands(records) == [["echo", "5", "word"]]


def test_loops_make_actions_for_each_number_and_each_set_of_values(files: Files) -> None:
    """A function gets them by their names."""
    records = files.python(
        """
        SetLaunchConfiguration('robots', '{name: a, id: 1}; {name: b}'),
        ForLoop('2', function=lambda i: [ExecuteProcess(cmd=['echo', str(i)])]),
        ForEach(LaunchConfiguration('robots'), function=lambda name, id=0: [
            ExecuteProcess(cmd=['echo', name, str(id)])]),
        """
    )

    assert [argv[1:] for argv in commands(records)] == [["0"], ["1"], ["a", "1"], ["b", "0"]]


def test_a_class_is_in_a_module_of_its_own_as_well(files: Files) -> None:
    """As in ROS's launch, where editors find it first."""
    records = files.python(
        "ExecuteProcess(cmd=['echo', Joined(['/a', 'b'])], on_exit=Shutdown()),",
        imports="""
        from launch.actions.shutdown_action import Shutdown
        from launch.event_handlers.on_shutdown import OnShutdown
        from launch.substitutions.path_join_substitution import PathJoinSubstitution as Joined
        from launch_ros.actions.composable_node_container import ComposableNodeContainer
        """,
    )

    assert records[-1]["argv"] == ["echo", "/a/b"]


def test_a_parameter_has_the_type_that_yaml_gives_its_text(files: Files) -> None:
    """Unless `ParameterValue` specifies one."""
    records = files.python(
        """
        SetLaunchConfiguration('x', '5'),
        Node(executable='n', parameters=[{
            'number': LaunchConfiguration('x'),
            'text': ParameterValue(LaunchConfiguration('x'), value_type=str),
            'float': ParameterValue(LaunchConfiguration('x'), value_type=float),
            'mixed': [1, 2.5],
        }]),
        """
    )

    assert commands(records)[0][-1] == {
        "/**": {
            "ros__parameters": {"number": 5, "text": "5", "float": 5.0, "mixed": [1.0, 2.5]},
        }
    }


def test_an_executable_is_found_in_its_package(files: Files, package: Path) -> None:
    """Below a prefix of AMENT_PREFIX_PATH, as ROS's tools install it."""
    records = files.python(
        "Node(package='robot', executable='driver', arguments=[FindPackageShare('robot')]),"
    )

    assert records[0]["name"] == "driver-1"
    assert records[0]["argv"][:2] == [
        str(package / "lib/robot/driver"),
        str(package / "share/robot"),
    ]


def test_an_executable_of_a_workspace_is_found_without_a_build(files: Files) -> None:
    """It may be the first word of a command; its name stays the same in any case."""
    files.write("src/robot/package.xml", "<package><name>robot</name></package>")
    files.write("src/robot/robot/__init__.py", "")
    files.write(
        "src/robot/setup.py",
        """
        from setuptools import setup
        setup(entry_points={"console_scripts": ["driver = robot.driver:main"]})
        """,
    )
    records = files.python(
        """
        Node(package='robot', executable='driver'),
        ExecuteProcess(cmd=[ExecutableInPackage(package='robot', executable='driver'), '-v']),
        ExecuteProcess(cmd=['ls', FindPackageShare('robot').find('robot')]),
        """
    )

    assert [record["name"] for record in records] == ["driver-1", "driver-2", "ls-3"]
    assert "robot.driver:main" in records[0]["argv"]
    assert records[1]["argv"][-2:] == ["robot.driver:main", "-v"]
    assert records[2]["argv"][1] == str(files.folder / "src" / "robot")


def test_parameter_files_are_handed_over_or_read_for_a_component(
    files: Files, package: Path
) -> None:
    """A node reads its files itself; a container gets the values for its node."""
    files.write(
        "a.yaml",
        """
        /**: {ros__parameters: {all: 1, rate: 1.0}}
        robot:
          eye: {ros__parameters: {rate: 2.0, lens: {size: 3}}}
        other: {ros__parameters: {rate: 4.0}}
        """,
    )
    files.write("b.yaml", "{eye: {ros__parameters: {robot: $(var robot)}}}")
    records = files.python(
        """
        SetLaunchConfiguration('robot', 'r1'),
        SetParametersFromFile([ThisLaunchFileDir(), '/a.yaml']),
        SetParameter('shared', 5),
        Node(executable='n', name='eye', parameters=[
            ParameterFile([ThisLaunchFileDir(), '/b.yaml'], allow_substs=True),
            Parameter('own', 'word'), '/nope.yaml']),
        LoadComposableNodes(target_container='c', composable_node_descriptions=[
            ComposableNode(package='robot', plugin='robot::Eye', name='eye', namespace='robot',
                           parameters=[{'rate': 3.0}])]),
        LogInfo(msg=Shared('shared')),
        """,
        imports="from launch_ros.substitutions import Parameter as Shared\n"
        "from launch_ros.descriptions import Parameter",
    )

    folder = str(files.folder)
    assert records[0]["log"] == "there is no parameter file /nope.yaml: the node starts without it"
    assert records[1]["argv"][4:] == [
        "--params-file", f"{folder}/a.yaml", "-p", "shared:=5",
        "--params-file", {"eye": {"ros__parameters": {"robot": "r1"}}},
        "-p", "own:=word\n...\n",  # as PyYAML writes it, in ROS, too
    ]  # fmt: skip
    assert records[2]["parameters"] == {"all": 1, "rate": 3.0, "lens.size": 3, "shared": 5}
    assert records[3]["log"] == "5"


def test_components_of_a_container_have_their_parameters(files: Files, package: Path) -> None:
    """A container of classes of aionode needs no process of its own."""
    (package / "lib" / "robot" / "component_container").write_text("#!/bin/sh\n")
    (package / "lib" / "robot" / "component_container").chmod(0o755)
    records = files.python(
        """
        ComposableNodeContainer(name='c', namespace='', package='robot',
            executable='component_container', composable_node_descriptions=[
                ComposableNode(package='robot', plugin='robot::Talker', name='t',
                               parameters=[{'a': 1}], remappings=[('x', 'y')])]),
        ComposableNodeContainer(name='d', namespace='', composable_node_descriptions=[
            ComposableNode(package='robot', plugin='robot.nodes:Talker', name='t')]),
        """
    )

    assert [record.get("plugin") for record in records] == [
        None,
        "robot::Talker",
        "robot.nodes:Talker",
    ]
    assert (records[1]["parameters"], records[1]["remappings"]) == ({"a": 1}, ["x:=y"])


def test_the_arguments_of_a_file_can_be_listed(files: Files) -> None:
    """Including those of groups and of included files."""
    inner = files.write("inner.launch.yaml", "launch:\n- arg: {name: speed, default: '1.0'}\n")
    plan = Plan(
        files.write(
            "outer.launch.xml",
            f"""
            <launch>
              <arg name="robot" description="Which one"><choice value="a"/><choice value="b"/></arg>
              <include file="{inner}"/>
            </launch>
            """,
        )
    )

    assert [(argument.name, argument.default, argument.choices) for argument in plan.declared] == [
        ("robot", None, ("a", "b")),
        ("speed", "'1.0'", None),
    ]


BAD = {
    "from launch.actions import Nonsense": (1, "launch.actions has no Nonsense; it has: Action"),
    "import os\nos.environ['NOT_THERE']": (
        2,
        "the environment has no 'NOT_THERE', which the file ",
    ),
    "{}['not_there']": (1, "KeyError: 'not_there'"),
    "import not_there_at_all": (1, "no module not_there_at_all"),
    "import launch.nothing": (1, "launch is from aionode here, which does not have launch.nothin"),
    "def generate_launch_description(:": (1, "not valid Python"),
    "x = 1": (None, "has neither generate_launch_description() nor"),
    "def generate_launch_description():\n    return 5": (None, "return a LaunchDescription"),
    "from launch.actions import LogInfo\nLogInfo()": (
        2,
        "missing 1 required keyword-only argument",
    ),
}


@pytest.mark.parametrize("text", BAD)
def test_a_bad_file_is_one_error_with_its_line(files: Files, text: str) -> None:
    """Such an error comes before anything is started."""
    line, problem = BAD[text]
    with pytest.raises(LaunchFileError) as caught:
        Plan(files.write("bad.launch.py", text))

    assert caught.value.line == line
    assert problem in caught.value.problem


BAD_ENTITIES = {
    "ExecuteProcess(cmd=['a', LaunchConfiguration('nope')])": "'nope' does not exist here",
    "Node(package='nope', executable='x')": "nope",
    "DeclareLaunchArgument('x')": "'x' is required and has no default; add x:=VALUE",
    "DeclareLaunchArgument('x', default_value='c', choices=['a', 'b'])": "use one of a, b",
    "ExecuteProcess(cmd=['a'], condition=IfCondition('maybe'))": "use true, 1, false or 0",
    "Node(executable='n', parameters=[{'a': []}])": "parameter 'a'",
    "Node(executable='n', name='no/name')": "no/name",
    "IncludeLaunchDescription('missing.launch.py')": "missing.launch.py",
    "ExecuteProcess(cmd=['a'], respwan=1)": "ExecuteProcess has no 'respwan'; is it 'respawn'",
    "Node(executable='a', nonsense=True)": "Node has no 'nonsense'; it has: ",
    "LaunchConfiguration('a', defualt='b')": "LaunchConfiguration has no 'defualt'; is it",
    "RegisterEventHandler(OnProcessExit(on_exti=[]))": "OnProcessExit needs on_exit=",
    "RegisterEventHandler(OnProcessExit(on_exit=[Node(package='nope', executable='')]))": "nope",
    "TimerAction(period=1.0, actions=[LogInfo(msg=LaunchConfiguration('nope'))])": "'nope' does",
    "ExecuteProcess(cmd=['a'], sigterm_timeout='x')": "sigterm_timeout: 'x' is not a float",
    "ForLoop('x', function=print)": "length is 'x'; use a whole number",
    "ForEach('[a]', function=print)": "'[a]' is not a set of values",
    "OpaqueCoroutine(coroutine=print)": "use an async function",
    "OpaqueFunction(function=lambda context: context.asyncio_loop)": "no running event loop",
    "5": "5",
}


@pytest.mark.parametrize("entity", BAD_ENTITIES)
def test_a_bad_entity_is_one_error_with_its_line(files: Files, entity: str) -> None:
    """The line is that of the entity, which is not where the error is noticed."""
    with pytest.raises(LaunchFileError) as caught:
        files.python(f"LogInfo(msg='fine'),\n{entity},")

    assert BAD_ENTITIES[entity] in str(caught.value)
    if entity != "5":
        assert caught.value.path.endswith(("a.launch.py", "missing.launch.py"))
        assert caught.value.line is not None


def test_what_is_done_later_is_checked_and_printed_without_doing_it(files: Files) -> None:
    """Functions and commands run when their time has come; names keep their numbers."""
    plan = Plan(
        files.write(
            "a.launch.py",
            HEAD
            + BODY.format(
                entities="""
        TimerAction(period=1.0, actions=[ExecuteProcess(cmd=['later']), handler := (
            RegisterEventHandler(OnProcessStart(on_start=[
                LogInfo(msg=Command('false')), LogInfo(msg=LaunchConfiguration('nope'))])))]),
        TimerAction(period=1.0, actions=[OpaqueFunction(function=lambda context: 1 / 0)]),
        ExecuteProcess(cmd=['now']),
        """
            ),
        )
    )

    assert [step.name for step in plan.steps if isinstance(step, Process)] == ["now-1"]
    records = list(plan.records())
    assert [record["name"] for record in records if "name" in record] == ["later-2", "now-1"]
    assert [record["calls"] for record in records if "calls" in record] == [
        "Command()",
        "OpaqueFunction(<lambda>)",
    ]
    assert list(plan.records()) == records


@pytest.mark.processes
@pytest.mark.parametrize("command", ["'xacro '", "FindExecutable(name='xacro'), ' '"])
def test_a_command_in_python_finds_the_packages_of_the_workspace(
    command: str, files: Files, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """PyPI's xacro asks ament's index for packages, even if it is not on the PATH."""
    scripts = tmp_path / "bin"
    scripts.mkdir()
    python = scripts / "python"
    python.symlink_to(sys.executable)
    xacro = scripts / "xacro"
    xacro.write_text(
        f"#!{python}\nimport sys\n"
        "from ament_index_python.packages import get_package_share_directory as share\n"
        "print(share(sys.argv[1]), end='')\n"
    )
    xacro.chmod(0o755)
    monkeypatch.setattr("sysconfig.get_path", lambda _: str(scripts))
    monkeypatch.setattr("sys.executable", str(python))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    files.write("src/bot/package.xml", "<package><name>bot</name></package>")
    file = files.write(
        "src/bot/a.launch.py",
        HEAD + BODY.format(entities=f"LogInfo(msg=Command([{command}, 'bot']))"),
    )

    (record,) = Plan(file, {}).records()

    assert record["log"] == str(tmp_path / "src" / "bot")


@pytest.mark.parametrize("action", ["Command(['xacro ', 'a'])", "FindExecutable(name='xacro')"])
def test_a_missing_xacro_has_its_remedy(
    action: str, files: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Most robot descriptions need it, and it is one extra away."""
    monkeypatch.setattr("shutil.which", lambda name, path: None)

    with pytest.raises(
        LaunchFileError, match=r"'xacro' not found .* 'aionode\[xacro\]' installs it"
    ):
        files.python(f"LogInfo(msg={action})")


def test_a_xacro_of_another_python_has_its_remedy(
    files: Files, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """That Python has no ROS packages, and xacro's error does not say which Python it is."""
    xacro = tmp_path / "xacro"
    xacro.write_text("#!/bin/sh\necho \"No module named 'ament_index_python'\" >&2; exit 2\n")
    xacro.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))

    with pytest.raises(LaunchFileError, match=r"another Python: pip install 'aionode\[xacro\]'"):
        files.python("LogInfo(msg=Command(['xacro ', 'a']))")


def test_an_event_handler_that_registers_itself_is_checked_once(files: Files) -> None:
    """Whatever it does, it does again at the next event."""
    plan = Plan(
        files.write(
            "a.launch.py",
            HEAD
            + """
again = RegisterEventHandler(EventHandler(matcher=bool))
again.event_handler = OnProcessExit(on_exit=[again], handle_once=True)
"""
            + BODY.format(entities="again"),
        )
    )

    assert any(isinstance(step, Watch) for step in plan.steps)


def test_an_argument_that_is_misspelt_is_noted(files: Files) -> None:
    """Others may be read though nobody has declared them, as in ROS's launch."""
    records = files.python(
        """
        DeclareLaunchArgument('speed', default_value='1'),
        LogInfo(msg=LaunchConfiguration('other')),
        """,
        sped="2",
        other="3",
    )

    assert [record["log"] for record in records] == [
        "argument 'sped' is not one of the file; is it 'speed'?",
        "3",
    ]


def test_a_file_that_includes_itself_is_an_error(files: Files) -> None:
    """It would never end."""
    with pytest.raises(LaunchFileError, match="include itself"):
        files.plan("a.launch.xml", '<launch><include file="$(filename)"/></launch>')


def test_files_that_include_others_twice_end(files: Files, monkeypatch: pytest.MonkeyPatch) -> None:
    """Twenty such files are a million, although none includes itself."""
    monkeypatch.setattr("aionode.launch._evaluation.MAX_ENTITIES", 500)
    last = 18
    for number in range(last):
        include = f'<include file="$(dirname)/{number + 1}.launch.xml"/>'
        files.write(f"{number}.launch.xml", f"<launch>{include * 2}</launch>")
    files.write(f"{last}.launch.xml", "<launch/>")

    with pytest.raises(LaunchFileError, match="more than 500 entities") as caught:
        list(Plan(str(files.folder / "0.launch.xml"), {}).records())

    assert caught.value.path.endswith(".launch.xml")


@pytest.mark.parametrize("stream", ["", " >&2"])
def test_a_command_that_writes_without_end_is_an_error(files: Files, stream: str) -> None:
    """It filled the memory."""
    with pytest.raises(LaunchFileError, match="writes more than 16777216 bytes"):
        files.python(f"LogInfo(msg=Command('sh -c \"exec yes{stream}\"'))")


def test_substitutions_are_nested_to_a_limit(files: Files) -> None:
    """Python's own limit would be hit deep in the reader."""
    text = "$(env " * 500 + "A" + ")" * 500
    with pytest.raises(LaunchFileError, match="nested deeper than 100"):
        files.plan("a.launch.xml", f'<launch><arg name="x" default="{text}"/></launch>')


NAMES = """
from launch import InvalidLaunchFileError, LaunchIntrospector, SomeEntitiesType
from launch.events.process.process_exited import ProcessExited
from launch.events.process.process_matchers import matches_name
from launch.frontend import Entity, Parser
from launch.frontend.entity import Entity as SameEntity
from launch.frontend.parser import Parser as SameParser
from launch.invalid_launch_file_error import InvalidLaunchFileError as SameError
from launch.launch_description_sources import (
    InvalidFrontendLaunchFileError,
    get_launch_description_from_any_launch_file,
    get_launch_description_from_frontend_launch_file,
    get_launch_description_from_python_launch_file,
)
from launch.launch_description_sources.python_launch_file_utilities import (
    InvalidPythonLaunchFileError,
)
from launch.launch_introspector import format_entities
from launch.logging import launch_config
from launch.some_entities_type import SomeEntitiesType_types_tuple
from launch.substitutions.boolean_substitution import NotSubstitution
from launch.utilities import isclassinstance
from launch.utilities.class_tools_impl import is_a
from launch.utilities.typing_file_path import FilePath
"""


def test_launch_files_find_the_names_of_released_launch(files: Files) -> None:
    """In the modules in which ROS has them; a missing import ends the file."""
    imports = f"import logging\n{NAMES}"
    (record,) = files.python(
        "LogInfo(msg=str((SameEntity is Entity, SameParser is Parser, launch_config.level)))",
        imports=imports,
    )
    assert record["log"].startswith("(True, True, ")


@pytest.mark.parametrize(
    ("name", "text", "function"),
    [
        ("b.launch.xml", '<launch><log message="hi"/></launch>', "frontend"),
        ("b.launch.yaml", "launch: [log: {message: hi}]", "frontend"),
        ("b.launch.yaml", "launch: [log: {message: hi}]", "any"),
        (
            "b.py",
            (
                "from launch import *\nfrom launch.actions import *\n"
                "def generate_launch_description(): return LaunchDescription([LogInfo(msg='hi')])\n"
            ),
            "python",
        ),
    ],
)
def test_a_launch_file_reads_another_one_by_itself(
    files: Files, name: str, text: str, function: str
) -> None:
    """Helpers of launch files and their tests do, without `IncludeLaunchDescription`."""
    path = files.write(name, text)
    (record,) = files.python(
        f"*get_launch_description_from_{function}_launch_file({path!r}).entities", imports=NAMES
    )
    assert record["log"] == "hi"


def test_a_parser_reads_a_text(files: Files) -> None:
    """As in tests of XML launch files."""
    (record,) = files.python(
        "*(lambda root, parser: parser.parse_description(root).entities)("
        "*Parser.load(io.StringIO('<launch><log message=\"hi\"/></launch>')))",
        imports=f"import io\n{NAMES}",
    )
    assert record["log"] == "hi"


@pytest.mark.parametrize(
    ("function", "error"),
    [
        ("frontend", "InvalidFrontendLaunchFileError"),
        ("python", "InvalidPythonLaunchFileError"),
        ("any", "InvalidLaunchFileError"),
    ],
)
def test_a_file_that_is_no_launch_file_has_launchs_error(
    files: Files, function: str, error: str
) -> None:
    """Programs catch it."""
    path = files.write("b.launch.txt", "nothing")
    body = f"get_launch_description_from_{function}_launch_file({path!r})"
    with pytest.raises(LaunchFileError, match=error):
        files.python(f"*{body}.entities", imports=NAMES)


def test_an_introspector_shows_a_description_as_a_tree(files: Files) -> None:
    """The earliest launch files print it."""
    (record,) = files.python(
        "LogInfo(msg=LaunchIntrospector().format_launch_description(LaunchDescription(["
        "LogInfo(msg='hi'), RegisterEventHandler(OnProcessExit(on_exit=[LogInfo(msg='end')]))])))",
        imports=NAMES,
    )
    assert record["log"].splitlines()[1:] == [
        "├── LogInfo('hi')",
        "├── RegisterEventHandler:",
        "│   ├── OnProcessExit(exit of any process)",
        "│   │   ├── LogInfo('end')",
    ]


def test_reading_a_launch_file_leaves_no_file_beside_it(files: Files) -> None:
    """The folder may be read-only, or under version control."""
    files.python("LogInfo(msg='x'),")

    assert [file.name for file in files.folder.iterdir()] == ["a.launch.py"]


@pytest.mark.processes
def test_names_of_launch_are_found_by_programs(tmp_path: Path) -> None:
    """An rclpy program, such as a helper of launch files, may import them as well."""
    program = tmp_path / "program.py"
    program.write_text("import rclpy, launch, launch_ros.actions\nprint(launch.__name__)\n")
    done = subprocess.run(
        [sys.executable, "-m", "aionode.rclpy", str(program)],
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.stdout.strip() == "launch", done.stderr


@pytest.mark.parametrize(
    "later",
    [
        "TimerAction(period=1.0, actions=[{}])",
        "RegisterEventHandler(OnProcessExit(on_exit=[{}]))",
        "RegisterEventHandler(OnProcessStart(on_start=[{}]))",
        "RegisterEventHandler(OnShutdown(on_shutdown=[{}]))",
        "GroupAction(scoped=False, actions=[TimerAction(period=1.0, actions=[{}])])",
        "TimerAction(period=1.0, actions=[TimerAction(period=1.0, actions=[{}])])",
    ],
)
def test_what_is_done_later_sees_arguments_that_are_declared_after_it(
    files: Files, later: str
) -> None:
    """It is evaluated when it happens, and in its own scope."""
    log = "LogInfo(msg=[LaunchConfiguration('speed'), EnvironmentVariable('COLOR')])"
    plan = files.python(
        f"""
        {later.format(log)},
        GroupAction([SetLaunchConfiguration('speed', 'of a group')]),
        SetEnvironmentVariable('COLOR', 'red'),
        DeclareLaunchArgument('speed', default_value='0.5 '),
        """
    )

    assert [record["log"] for record in plan if "log" in record] == ["0.5 red"]


def test_what_a_group_does_later_keeps_what_the_group_has_set(files: Files) -> None:
    """Anything that the file sets afterwards is outside its scope."""
    plan = files.python(
        """
        GroupAction([SetLaunchConfiguration('side', 'left'), TimerAction(period=1.0, actions=[
            LogInfo(msg=LaunchConfiguration('side'))])]),
        SetLaunchConfiguration('side', 'right'),
        """
    )

    assert [record["log"] for record in plan] == ["left"]


def test_a_launch_file_defines_dataclasses(files: Files) -> None:
    """Their annotations are objects, as Python evaluates them."""
    plan = files.python(
        "LogInfo(msg=str(fields(Robot)[0].type('7') + 1)),",
        imports="from dataclasses import dataclass, fields\n@dataclass\nclass Robot:\n    x: int\n",
    )

    assert [record["log"] for record in plan] == ["8"]


def test_a_launch_file_uses_functions_of_another_file(files: Files) -> None:
    """As in many robots; a failure in it is reported with its place."""
    lib = files.write("lib.py", "def text():\n    return 'from lib'\n")
    broken = files.write("broken.py", "\n1 / 0\n")

    plan = files.python(f"LogInfo(msg=load_python_launch_file_as_module({lib!r}).text()),")
    assert [record["log"] for record in plan] == ["from lib"]
    with pytest.raises(LaunchFileError, match=r"broken\.py:2: ZeroDivisionError"):
        files.python(f"load_python_launch_file_as_module({broken!r}),")
