"""Packages beside launch whose classes launch files use."""

from __future__ import annotations

import sys
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest
import yaml

from aionode.errors import LaunchFileError

if TYPE_CHECKING:
    from tests.launch.conftest import Files

SOURCE = """
nav:
  ros__parameters: {speed: 1.0, mode: slow, deep: {speed: 2.0, list: [1, 2]}}
"""


def rewritten(files: Files, arguments: str) -> Any:
    """Return the content of the copy that RewrittenYaml creates of a file."""
    source = files.write("source.yaml", SOURCE)
    (record,) = files.python(
        f"SetLaunchConfiguration('x', '3.5'), LogInfo(msg=RewrittenYaml('{source}', {arguments}))",
        imports="from nav2_common.launch import RewrittenYaml",
    )
    return yaml.safe_load(Path(record["log"]).read_text())


@pytest.mark.parametrize(
    ("arguments", "changed"),
    [
        ("{'mode': 'fast'}", {"mode": "fast"}),
        ("{'speed': LaunchConfiguration('x')}, convert_types=True", {"speed": 3.5, "deep": 3.5}),
        ("{'nav.ros__parameters.deep.speed': '4'}, convert_types=True", {"deep": 4}),
        ("{'nav.ros__parameters.deep.list.1': 'true'}", {"list": [1, True]}),
        ("{'nav.ros__parameters.new.one': 'FALSE'}", {"new": {"one": False}}),
        ("{'other.one': '1'}", {}),
        ("{}, value_rewrites={'slow': ['f', 'ast']}", {"mode": "fast"}),
    ],
)
def test_a_yaml_file_is_rewritten(files: Files, arguments: str, changed: dict[str, Any]) -> None:
    """By the name of a key, its whole path, or a value; paths of parameters are added."""
    expected = yaml.safe_load(SOURCE)
    parameters = expected["nav"]["ros__parameters"]
    deep = parameters["deep"]
    deep["speed"] = changed.pop("deep", deep["speed"])
    deep["list"] = changed.pop("list", deep["list"])
    parameters.update(changed)

    assert rewritten(files, arguments) == expected


def test_a_rewritten_yaml_gets_a_root_and_other_keys(files: Files) -> None:
    """The root is the namespace of a robot."""
    content = rewritten(files, "{}, root_key='robot', key_rewrites={'nav': 'planner'}")

    assert set(content["robot"]) == {"planner"}


def test_an_empty_root_key_changes_nothing(files: Files) -> None:
    """A robot without a namespace has none."""
    assert rewritten(files, "{}, root_key=''") == yaml.safe_load(SOURCE)


@pytest.mark.parametrize(
    ("substitution", "text"),
    [
        ("HasNodeParams(f, 'nav')", "True"),
        ("HasNodeParams(f, 'other')", "False"),
        ("LaunchConfigAsBool('on')", "True"),
        ("FileContent(ReplaceString(f, {'slow': LaunchConfiguration('on')}))", "mode: Yes"),
        ("FileContent(ReplaceString(f, {'slow': 'x'}, IfCondition('false')))", "mode: slow"),
    ],
)
def test_the_other_substitutions_of_nav2_common(files: Files, substitution: str, text: str) -> None:
    """They read the file when they are evaluated."""
    source = files.write("source.yaml", SOURCE)
    (record,) = files.python(
        f"SetLaunchConfiguration('on', 'Yes'), LogInfo(msg={substitution})",
        imports=f"from nav2_common.launch import *\nf = {source!r}",
    )

    assert text in record["log"]


def test_the_poses_of_several_robots_are_read(
    files: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the command line, as in Jazzy, or from a launch argument, as in Kilted."""
    text = "one={x: 1.0, yaw: 0.5}; two={y: 2.0}"
    monkeypatch.setattr(sys, "argv", ["aionode", "launch", "file", f"robots:={text}"])
    parse = "f'{len(ParseMultiRobotPose(\"robots\").value())}'"
    records = files.python(
        f"DeclareLaunchArgument('robots', default_value={text!r}), LogInfo(msg={parse}), "
        "OpaqueFunction(function=lambda context: [LogInfo(msg=str(ParseMultiRobotPose("
        "LaunchConfiguration('robots')).perform(context)['two']))])",
        imports="from nav2_common.launch import ParseMultiRobotPose",
    )

    assert records[0]["log"] == "2"
    pose = {"x": 0.0, "y": 2.0, "z": 0.0, "roll": 0.0, "pitch": 0.0, "yaw": 0.0}
    assert yaml.safe_load(records[1]["log"]) == pose


BOMB = "a0: &a0 [x, x]\n" + "".join(
    f"a{n + 1}: &a{n + 1} [{', '.join([f'*a{n}'] * 9)}]\n" for n in range(8)
)


@pytest.mark.parametrize(("content", "says"), [("a: [", "parsing"), (BOMB, "more than 80000")])
def test_a_parameter_file_that_is_no_yaml_is_named(files: Files, content: str, says: str) -> None:
    """With the mistake, even if a few lines expand to billions of values."""
    source = files.write("source.yaml", content)

    with pytest.raises(LaunchFileError, match=rf"source.yaml: cannot be read as YAML: .*{says}"):
        files.python(
            f"LogInfo(msg=RewrittenYaml({source!r}, {{}}))",
            imports="from nav2_common.launch import RewrittenYaml",
        )


def test_parameters_are_built_from_the_files_of_a_package(
    files: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With xacro's output for a description."""
    document = SimpleNamespace(toxml=lambda: "<robot/>")
    xacro = SimpleNamespace(process_file=lambda path, mappings: document)
    monkeypatch.setitem(sys.modules, "xacro", xacro)
    files.write("src/bot/package.xml", "<package><name>bot</name></package>")
    files.write("src/bot/config/a.yaml", "speed: 1.5\n")
    files.write("src/bot/bot.xacro", "")
    (record,) = files.plan(
        "src/bot/a.launch.py",
        """
        from launch import LaunchDescription
        from launch.actions import LogInfo
        from launch_param_builder import ParameterBuilder

        def generate_launch_description():
            builder = ParameterBuilder("bot").yaml("config/a.yaml", "ns").parameter("n", 1)
            builder.xacro_parameter("robot", "bot.xacro").file_parameter("text", "config/a.yaml")
            return LaunchDescription([LogInfo(msg=repr(builder.to_dict()))])
        """,
    )

    assert record["log"] == repr(
        {"ns": {"speed": 1.5}, "n": 1, "robot": "<robot/>", "text": "speed: 1.5\n"}
    )


def test_a_package_of_the_workspace_comes_before_that_of_aionode(
    files: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may be newer, or modified."""
    for name in [name for name in sys.modules if name.partition(".")[0] == "nav2_common"]:
        monkeypatch.delitem(sys.modules, name)
    files.write("src/nav2_common/package.xml", "<package><name>nav2_common</name></package>")
    files.write("src/nav2_common/nav2_common/__init__.py", "")
    files.write("src/nav2_common/nav2_common/launch.py", "TEXT = 'own'")
    try:
        (record,) = files.plan(
            "src/nav2_common/a.launch.py",
            """
            from launch import LaunchDescription
            from launch.actions import LogInfo
            from nav2_common.launch import TEXT

            def generate_launch_description():
                return LaunchDescription([LogInfo(msg=TEXT)])
            """,
        )
    finally:
        for name in [name for name in sys.modules if name.partition(".")[0] == "nav2_common"]:
            del sys.modules[name]

    assert record["log"] == "own"


def test_an_own_substitution_is_exposed_to_files_in_xml(files: Files) -> None:
    """A Python file may define it and include the other."""
    files.write("b.launch.xml", '<launch><log message="$(shout hello)"/></launch>')
    (record,) = files.python(
        "IncludeLaunchDescription([ThisLaunchFileDir(), '/b.launch.xml'])",
        imports="""
from launch import Substitution
from launch.frontend import expose_substitution

@expose_substitution("shout")
class Shout(Substitution):
    def __init__(self, word):
        self.word = word

    @classmethod
    def parse(cls, data):
        return cls, {"word": data[0]}

    def perform(self, context):
        return "".join(part.perform(context) for part in self.word).upper()
""",
    )

    assert record["log"] == "HELLO"


MANAGER = "--controller-manager controller_manager"


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            "load_controller_launch_description('arm', '/arm.yaml')",
            f"arm {MANAGER} --param-file /arm.yaml",
        ),
        (
            "controllers_spawner_launch_description_from_dict({'arm': ['/a', '/b']}, ['-u'])",
            f"arm {MANAGER} --param-file /a --param-file /b -u",
        ),
        (
            "load_controller_launch_description('arm', controller_type='t/T')",
            f"arm {MANAGER} --controller-type t/T",
        ),
        (
            "spawner_launch_description({'a': {'inactive': True}, 'b': {'param_file': '/b'}})",
            "--controller a --inactive --controller b --param-file /b",
        ),
        (
            "spawner_launch_description({'a': {'load_only': True, 'ros_args': '-r b:=c'}})",
            "--controller a --load-only --controller-ros-args -r b:=c",
        ),
    ],
)
def test_controllers_are_spawned_by_the_functions_of_their_package(
    files: Files, call: str, words: str
) -> None:
    """With the arguments of the spawner."""
    records = files.python(
        f"*generate_{call}.entities", imports="from controller_manager.launch_utils import *"
    )
    (started,) = [each for each in records if "argv" in each]

    assert words in " ".join(filter(None, started["argv"]))
