"""``aionode launch`` without starting anything."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from aionode.cli import main
from tests.support import fork_server

FILE = """
<launch>
  <arg name="speed" default="0.5" description="in m/s"/>
  <executable cmd="echo $(var speed)"><env name="COLOR" value="red"/></executable>
</launch>
"""


@pytest.fixture
def file(tmp_path: Path) -> str:
    """Return a launch file."""
    path = tmp_path / "a.launch.xml"
    path.write_text(FILE, encoding="utf-8")
    return str(path)


def test_it_prints_what_it_would_start(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    """For readers, with the values of this call."""
    assert main(["launch", file, "speed:=0.8", "--print"]) == 0

    assert capsys.readouterr().out == "echo-1: echo 0.8\n    COLOR=red\n"


def test_an_argument_without_its_colon_is_no_file_of_a_package(
    file: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """The first word is an existing file, so the second one is an argument."""
    assert main(["launch", file, "speed=0.8"]) == 1
    assert "'speed=0.8': expected NAME:=VALUE" in capsys.readouterr().err


def test_it_prints_what_happens_later(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """When it happens, what containers load, and values known only then."""
    path = tmp_path / "a.launch.yaml"
    path.write_text(
        """
launch:
- unset_env: {name: HOME}
- timer:
    period: 2.0
    children:
    - executable: {cmd: later, cwd: /tmp}
    - shutdown: {reason: over}
- log: {message: hello}
- load_composable_node:
    target: /c
    composable_node:
    - {pkg: p, plugin: 'p::Eye', name: eye, namespace: /a, param: [{name: x, value: 1}],
       remap: [{from: b, to: c}]}
"""
    )
    assert main(["launch", str(path), "--print"]) == 0

    assert capsys.readouterr().out.splitlines() == [
        "after 2 s: later-1: later",
        "    in /tmp",
        "    HOME is not set",
        "after 2 s: event launch.events.Shutdown",
        "log: hello",
        "/c gets p::Eye of p as /a/eye",
        "    b:=c",
        "    x: 1",
    ]


def test_it_prints_records(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    """For programs."""
    assert main(["launch", "--print", "--json", file]) == 0

    record = json.loads(capsys.readouterr().out)
    assert (record["argv"], record["env"]) == (["echo", "0.5"], {"COLOR": "red"})


def test_it_lists_arguments(file: str, capsys: pytest.CaptureFixture[str]) -> None:
    """With their descriptions and defaults."""
    assert main(["launch", file, "--show-args"]) == 0

    assert capsys.readouterr().out == "'speed':\n    in m/s\n    (default: '0.5')\n"


def test_it_finds_a_file_of_a_package(
    file: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A package of a workspace needs no build; for an unknown name, the error lists the files."""
    folder = Path(file).parent
    (folder / "package.xml").write_text("<package><name>robot</name></package>")
    monkeypatch.chdir(folder)

    assert main(["launch", "robot", "a.launch.xml", "--print"]) == 0
    assert main(["launch", "robot", "b.launch.xml", "--print"]) == 1
    assert "available: a.launch.xml" in capsys.readouterr().err


@pytest.mark.processes
@pytest.mark.parametrize(("options", "status"), [([], 3), (["--noninteractive"], 0)])
def test_its_exit_status_is_that_of_the_first_failure(
    tmp_path: Path, options: list[str], status: int
) -> None:
    """Unless the status of ros2 launch is requested, as by test frameworks.

    On request, the last words of each process are written to a file.
    """
    path = tmp_path / "a.launch.xml"
    path.write_text("""<launch><executable cmd="sh -c 'echo no device; exit 3'"/></launch>""")
    command = ["-m", "aionode", "launch", str(path), *options]
    command += ["--log-folder", str(tmp_path / "log")]

    assert fork_server.run(command, env=os.environ, timeout=50).returncode == status
    assert (tmp_path / "log" / "sh-1.log").read_text().endswith(" no device\n")


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["x=5"], "expected NAME:=VALUE"),
        (["--real"], "ROS 2's launch and launch_ros are not installed here"),
    ],
)
def test_what_it_cannot_do_is_one_line(
    file: str, words: list[str], text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nothing is started."""
    assert main(["launch", file, "speed:=1", *words]) == 1

    assert text in capsys.readouterr().err


def test_a_launch_file_runs_the_command_of_ros_by_its_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The command of aionode stands in for it where no ROS 2 is sourced."""
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    file = tmp_path / "spawn.launch.py"
    file.write_text(
        "from launch import LaunchDescription\n"
        "from launch.actions import ExecuteProcess\n"
        "from launch.substitutions import Command, FindExecutable\n"
        "def generate_launch_description():\n"
        "    prefix = Command('ros2 pkg prefix --share turtlesim')\n"
        "    ros2 = FindExecutable(name='ros2')\n"
        "    return LaunchDescription([ExecuteProcess(cmd=[ros2, 'bag', 'record', prefix])])\n"
    )

    assert main(["launch", str(file), "--print", "--json"]) == 0

    program, *rest = json.loads(capsys.readouterr().out)["argv"]
    assert "-m aionode" in Path(program).read_text(encoding="utf-8")
    assert rest[:2] == ["bag", "record"]
    assert rest[2].rstrip().endswith("_share/turtlesim")


@pytest.mark.processes
def test_a_launch_file_in_python_runs_xacro_by_its_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without an activated environment, and with the packages of the workspace."""
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    package = tmp_path / "arm"
    package.mkdir()
    (package / "package.xml").write_text(
        "<package format='3'><name>arm</name><version>1.0.0</version></package>"
    )
    (package / "arm.xacro").write_text(
        "<robot xmlns:xacro='http://ros.org/wiki/xacro' name='$(find arm)'/>"
    )
    file = package / "arm.launch.py"
    file.write_text(
        "import subprocess\nfrom launch import LaunchDescription\n"
        "from launch.actions import LogInfo\n"
        "def generate_launch_description():\n"
        f"    command = ['xacro', {str(package / 'arm.xacro')!r}]\n"
        "    text = subprocess.check_output(command, text=True)\n"
        "    return LaunchDescription([LogInfo(msg=text.splitlines()[-1])])\n"
    )

    assert main(["launch", str(file), "--print", "--workspace", str(tmp_path)]) == 0

    assert f'name="{package}"' in capsys.readouterr().out
    assert os.environ["PATH"] == "/usr/bin:/bin"


@pytest.mark.processes
def test_xacro_names_a_file_that_is_not_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """PyPI's xacro handles errors of a parser that it imports with the first file it reads."""
    file = tmp_path / "arm.launch.py"
    file.write_text(
        "from launch import LaunchDescription\n"
        "from launch.actions import LogInfo\n"
        "from launch.substitutions import Command\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([LogInfo(msg=Command('xacro /no/arm.urdf'))])\n"
    )

    assert main(["launch", str(file), "--print"]) == 1

    assert "No such file or directory: /no/arm.urdf" in capsys.readouterr().err


def test_copies_of_parameter_files_go_with_the_command(tmp_path: Path) -> None:
    """The command ends without exit handlers, and nothing else removes them."""
    source, temporary = tmp_path / "nav.yaml", tmp_path / "temporary"
    source.write_text("nav: {ros__parameters: {speed: 1.0}}")
    temporary.mkdir()
    file = tmp_path / "nav.launch.py"
    file.write_text(
        "from launch import LaunchDescription\n"
        "from launch.actions import LogInfo\n"
        "from nav2_common.launch import ReplaceString, RewrittenYaml\n"
        "def generate_launch_description():\n"
        f"    rewritten = RewrittenYaml({str(source)!r}, {{'speed': '2.0'}})\n"
        f"    replaced = ReplaceString({str(source)!r}, {{'nav': 'map'}})\n"
        "    return LaunchDescription([LogInfo(msg=rewritten), LogInfo(msg=replaced)])\n"
    )
    done = subprocess.run(
        [sys.executable, "-m", "aionode", "launch", "--print", str(file)],
        env=os.environ | {"TMPDIR": str(temporary)},
        capture_output=True,
        check=True,
        text=True,
    )

    assert done.stdout.count(str(temporary)) == 2
    assert list(temporary.glob("aionode_launch_*")) == []
