"""rclpy programs run unmodified: by `aionode run` and ``python -m aionode.rclpy``."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support import fork_server
from tests.support.peers import isolated_environment

PROGRAM = """\
import sys

import helper
from std_msgs.msg import String


class Failure(Exception):
    pass


def work(how):
    if how == "fail":
        raise Failure("on purpose")
    if how == "interrupt":
        raise KeyboardInterrupt
    if how == "exit":
        sys.exit(7)


print(__name__, __file__, sys.argv, String(data=helper.TEXT))
if __name__ == "__main__":
    work(sys.argv[-1])
"""

SHADOW = "shadow"
"""The folder with an rclpy that hides one of ROS."""

TRACEBACK = """\
Traceback (most recent call last):
  File "{folder}/program.py", line 22, in <module>
    work(sys.argv[-1])
  File "{folder}/program.py", line 13, in work
    raise Failure("on purpose")
Failure: on purpose
"""


WITHOUT_SHUTDOWN = """\
import threading

import rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor

rclpy.init()
node = rclpy.create_node("forgetful")
executor = SingleThreadedExecutor()
executor.add_node(node)
pool = MultiThreadedExecutor(2)
called = threading.Event()
node.create_timer(0.001, called.set)
"""


PUBLISHING_HANDLER = """\
import logging
from std_msgs.msg import String

publisher = node.create_publisher(String, "log", 10)


class Handler(logging.Handler):
    def emit(self, record):
        publisher.publish(String(data=record.getMessage()))
        called.set()


def work():
    while True:
        logging.error("hello")


logging.getLogger().addHandler(Handler())
threading.Thread(target=work, daemon=True).start()
assert called.wait(10)
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a program, and a module that it imports."""
    (tmp_path / "program.py").write_text(PROGRAM)
    (tmp_path / "helper.py").write_text("TEXT = 'hi'\n")
    # Found before a ROS rclpy that may be installed here, about which a log line would be printed;
    # `aionode.rclpy` itself replaces both.
    shadow = tmp_path / SHADOW / "rclpy"
    shadow.mkdir(parents=True)
    (shadow / "__init__.py").write_text("raise ImportError('not the rclpy of aionode')\n")
    return tmp_path


def run(
    folder: Path, *command: str, module: str = "aionode.rclpy", fresh: bool = False
) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder."""
    path = (folder / SHADOW, Path(__file__).parents[2])
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, path))}
    return fork_server.run(["-m", module, *command], env=env, timeout=50, cwd=folder, fresh=fresh)


@pytest.mark.parametrize(
    ("module", "command"),
    [
        ("aionode.rclpy", ("program.py",)),
        ("aionode", ("run", "program.py")),
        ("aionode", ("run", "--rclpy", "program.py")),
    ],
)
def test_a_program_runs_as_python_runs_it(folder: Path, module: str, command: list[str]) -> None:
    """Its name, its full path, its arguments, its neighbours and its exit status are its own."""
    done = run(folder, *command, "--ros-args", "exit", module=module)

    assert done.returncode == 7
    assert done.stdout == (
        f"__main__ {folder}/program.py ['program.py', '--ros-args', 'exit'] "
        "std_msgs.msg.String(data='hi')\n"
    )
    assert done.stderr == ""


@pytest.mark.parametrize("command", [("old.py",), ("-m", "old")])
def test_the_builtins_of_a_program_are_a_module(folder: Path, command: tuple[str, ...]) -> None:
    """In `__main__` alone, as in Python; programs look there for names of other versions."""
    (folder / "old.py").write_text("import rclpy\nprint(hasattr(__builtins__, 'input'))\n")

    done = run(folder, *command)

    assert (done.stdout, done.stderr) == ("True\n", "")


def test_annotations_of_a_program_are_objects(folder: Path) -> None:
    """As Python evaluates them, unless the program imports `annotations` from `__future__`."""
    (folder / "noted.py").write_text(
        "import rclpy\ndef f(x: int): ...\nprint(f.__annotations__['x']('7') + 1)\n"
    )

    done = run(folder, "noted.py")

    assert (done.stdout, done.stderr) == ("8\n", "")


@pytest.mark.parametrize(
    "spin",
    [
        "executor.spin_once(timeout_sec=10)",
        "threading.Thread(target=executor.spin, daemon=True).start()",
        "threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()",
        "pool.add_node(node)\nthreading.Thread(target=pool.spin, daemon=True).start()",
    ],
)
def test_a_program_that_ends_without_shutdown_says_nothing(folder: Path, spin: str) -> None:
    """Python ends its objects in any order; a daemon thread that spins is not told."""
    (folder / "forgetful.py").write_text(f"{WITHOUT_SHUTDOWN}{spin}\nassert called.wait(10)\n")

    done = run(folder, "forgetful.py", fresh=True)

    assert (done.returncode, done.stderr) == (0, "")


def test_a_thread_that_publishes_until_the_end_gets_no_error(folder: Path) -> None:
    """A logging handler that publishes holds a lock that Python needs at the end."""
    (folder / "talkative.py").write_text(f"{WITHOUT_SHUTDOWN}{PUBLISHING_HANDLER}")

    done = run(folder, "talkative.py", fresh=True)

    assert (done.returncode, done.stderr) == (0, "")


def test_a_program_runs_at_once_in_the_process_of_the_command(folder: Path) -> None:
    """Without the modules of the command line, which take as long to load as a small program."""
    (folder / "own.py").write_text(
        "import sys, rclpy\nprint(sys.argv, [n for n in sys.modules if n in ('click', 'runpy')])\n"
    )

    done = run(folder, "run", "own.py", "--help", module="aionode", fresh=True)

    assert done.stdout == "['own.py', '--help'] ['runpy']\n"


@pytest.mark.parametrize("command", [("aionode", "run"), ("aionode.rclpy",)])
def test_python_that_leaves_the_current_folder_out_keeps_its_path(
    folder: Path, command: tuple[str, ...]
) -> None:
    """With ``-P``, the first entry is not that of a program."""
    (folder / "elsewhere").mkdir()
    (folder / "elsewhere" / "other.py").write_text("TEXT = 'found'\n")
    (folder / "own.py").write_text("import rclpy, other, helper\nprint(other.TEXT, helper.TEXT)\n")
    path = os.pathsep.join([str(folder / "elsewhere"), str(Path(__file__).parents[2])])

    done = subprocess.run(
        [sys.executable, "-P", "-m", *command, "own.py"],
        env={**os.environ, "PYTHONPATH": path},
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=50,
        check=False,
    )

    assert (done.stdout, done.stderr) == ("found hi\n", "")


def test_a_module_runs_as_python_runs_it(folder: Path) -> None:
    """It runs like ``python -m``, with the whole path in its arguments."""
    done = run(folder, "run", "-m", "program", "exit", module="aionode")

    assert done.returncode == 7
    path = str(folder / "program.py")
    assert done.stdout.startswith(f"__main__ {path} ['{path}', 'exit']")


def test_a_function_of_a_module_is_called_as_by_the_executable_of_a_package(folder: Path) -> None:
    """Its result is the exit status; a package names such functions in its setup.py."""
    (folder / "robot").mkdir()
    (folder / "robot" / "__init__.py").write_text("")
    (folder / "robot" / "mover.py").write_text(
        "import sys\n\n\ndef main():\n    print(__name__, sys.argv[1:])\n    return 5\n"
    )

    done = run(folder, "run", "-m", "robot.mover:main", "fast", module="aionode")

    assert (done.stdout, done.stderr, done.returncode) == ("robot.mover ['fast']\n", "", 5)


def test_a_module_that_only_defines_main_does_not_end_as_if_it_had_run(folder: Path) -> None:
    """Modules of packages rarely call it themselves."""
    (folder / "mover.py").write_text('"""Moves."""\n\nimport rclpy\n\n\ndef main():\n    pass\n')

    done = run(folder, "run", "-m", "mover", module="aionode")

    assert done.returncode == 2
    assert done.stderr == (
        "aionode.rclpy: mover defines main() and does not call it; -m mover:main does\n"
    )


def test_an_executable_of_an_installed_package_runs_by_its_path(folder: Path) -> None:
    """It is a Python file without an extension, which only imports the package."""
    (folder / "mover").write_text("#!/usr/bin/python3\nimport sys, helper\nsys.exit(helper.TEXT)\n")

    done = run(folder, "run", "./mover", module="aionode")

    assert (done.stderr, done.returncode) == ("hi\n", 1)


TALKER = """\
import sys

from ament_index_python.packages import get_package_share_directory
from my_tools.words import WORDS


def main():
    print(WORDS, sys.argv[1:], get_package_share_directory("my_robot"))
    return 3
"""


def test_an_executable_of_a_package_runs_without_a_build(folder: Path) -> None:
    """Its package has its data, and imports from the other packages of the workspace."""
    for name in ("my_robot", "my_tools"):
        package = folder / "src" / name
        (package / name).mkdir(parents=True)
        (package / "package.xml").write_text(f"<package><name>{name}</name></package>")
        (package / name / "__init__.py").write_text("")
    robot = folder / "src" / "my_robot"
    robot.joinpath("my_robot", "talker.py").write_text(TALKER)
    robot.joinpath("setup.py").write_text(
        "setup(entry_points={'console_scripts': ['talker = my_robot.talker:main']})\n"
    )
    folder.joinpath("src", "my_tools", "my_tools", "words.py").write_text("WORDS = 'hi'\n")

    done = run(folder, "run", "my_robot", "talker", "-x", module="aionode")

    assert (done.stdout, done.stderr, done.returncode) == (f"hi ['-x'] {robot}\n", "", 3)


def test_a_program_imports_the_python_projects_of_its_workspace(folder: Path) -> None:
    """They need no installation, and none of their setup files is executed."""
    for name, text in {
        "examples/say.py": "import rclpy\nfrom words.greetings import HI\nprint(HI)\n",
        "src/words/setup.py": "raise SystemExit('executed')\nsetup(package_dir={'': 'python'})\n",
        "src/words/python/words/__init__.py": "",
        "src/words/python/words/greetings.py": "from marks import MARK\nHI = 'hi' + MARK\n",
        "src/marks/pyproject.toml": "[project]\nname = 'marks'\n",
        "src/marks/src/marks/__init__.py": "MARK = '!'\n",
        ".git/HEAD": "",
    }.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)

    checked = run(folder, "--check", "examples/say.py")
    done = run(folder, "run", "examples/say.py", module="aionode")

    assert (done.stdout, done.stderr, done.returncode) == ("hi!\n", "", 0)
    assert checked.returncode == 0, checked.stdout


def test_a_program_that_only_defines_main_does_not_end_as_if_it_had_run(folder: Path) -> None:
    """It is the module of an executable, which calls the function."""
    (folder / "mover.py").write_text("import rclpy\n\n\ndef main():\n    pass\n")

    done = run(folder, "mover.py")

    assert done.returncode == 2
    assert "mover.py defines main() and does not call it" in done.stderr


def test_a_module_that_is_not_there_is_named_with_what_is_close(folder: Path) -> None:
    """The error also names the places that were searched."""
    done = run(folder, "-m", "progam")

    assert done.returncode == 2
    assert done.stderr == (
        f"aionode.rclpy: No module named progam, looked for in {folder}, PYTHONPATH; "
        "did you mean program?\n"
    )


def test_a_traceback_shows_the_program_alone(folder: Path) -> None:
    """The runner's frames do not interest the program's author."""
    done = run(folder, "program.py", "fail")

    assert done.returncode == 1
    lines = [line for line in done.stderr.splitlines() if "^^" not in line]  # not in Python 3.13
    assert lines == TRACEBACK.format(folder=folder).splitlines()


NAMES = """\
import inspect
import pickle

import rclpy
from rclpy._rclpy_pybind11 import RCLError

with rclpy.init():
    node = rclpy.create_node("node")
    print(type(node), RCLError, rclpy.node.ParameterDescriptor.__module__)
    assert pickle.loads(pickle.dumps(type(node))) is type(node)
    assert inspect.getsource(type(node)).startswith("class Node")
    node.get_parameter("no")
"""


def test_classes_and_errors_are_shown_by_their_names_in_rclpy(folder: Path) -> None:
    """Modules that come with others are included, such as that of Node with `create_node`."""
    (folder / "program.py").write_text(NAMES)

    done = run(folder, "program.py")

    names = "<class 'rclpy.node.Node'> <class 'rclpy._rclpy_pybind11.RCLError'>"
    assert done.stdout == f"{names} rcl_interfaces.msg._parameter_descriptor\n"
    error = done.stderr.splitlines()[-1]
    assert error.startswith("rclpy.exceptions.ParameterNotDeclaredException: ")


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX's")
def test_an_interrupt_that_is_not_caught_ends_by_its_signal(folder: Path) -> None:
    """A shell stops a loop of programs only if it sees the signal."""
    done = run(folder, "program.py", "interrupt")

    assert done.returncode == -2
    assert "_program.py" not in done.stderr
    assert done.stderr.endswith("KeyboardInterrupt\n")


def test_a_program_that_python_cannot_read_is_shown_as_usual(folder: Path) -> None:
    """The place of the error, and nothing else."""
    (folder / "bad.py").write_text("def work(:\n")

    done = run(folder, "bad.py")

    assert done.returncode == 1
    assert done.stderr.startswith(f'  File "{folder}/bad.py", line 1\n')


@pytest.mark.parametrize(
    ("command", "problem"),
    [
        (("nothing.py",), "aionode.rclpy: can't open file 'nothing.py': No such file or directory"),
        (("-m", "nothing.inside"), "aionode.rclpy: No module named nothing"),
        pytest.param(
            *(("-m", "nothing"), "aionode.rclpy: No module named nothing"),
            marks=pytest.mark.stress,
        ),
        (("-m", "helper:no name"), "aionode.rclpy: helper:no name is not MODULE:FUNCTION"),
        (("--interfaces", "nothing", "program.py"), "aionode.rclpy: nothing: no such folder"),
        (("--nothing",), "usage: python -m aionode.rclpy"),
        pytest.param((), "usage: python -m aionode.rclpy", marks=pytest.mark.stress),
    ],
)
def test_what_cannot_run_is_reported_in_one_line(
    folder: Path, command: tuple[str, ...], problem: str
) -> None:
    """The error is like Python's, with its exit status."""
    done = run(folder, *command)

    assert done.returncode == 2
    assert done.stderr.startswith(problem)


def test_messages_of_the_user_are_given_by_an_option(folder: Path) -> None:
    """The folder of a workspace, without a build."""
    (folder / "run_msgs" / "msg").mkdir(parents=True)
    (folder / "run_msgs" / "msg" / "Score.msg").write_text("float32 value 0.5\n")
    (folder / "own.py").write_text("from run_msgs.msg import Score\nprint(Score())\n")

    done = run(folder, "run", "--rclpy", "--interfaces", ".", "own.py", module="aionode")

    assert done.stdout == "run_msgs.msg.Score(value=0.5)\n"


def test_nothing_is_imported_that_a_program_does_not_use(folder: Path) -> None:
    """Content filters and the packages beside rclpy cost nothing before their first use."""
    (folder / "own.py").write_text("import sys, rclpy.node\nprint(list(sys.modules))\n")

    loaded = run(folder, "own.py", fresh=True).stdout

    assert "aionode.rclpy._finder" in loaded
    for package in ("cv_bridge", "message_filters", "ros2_numpy", "tf_transformations"):
        assert f"'{package}'" not in loaded
    for module in ("'cv2'", "'aionode.content_filter'", "rclpy._check'", "rclpy.missing'"):
        assert module not in loaded


@pytest.mark.slow
def test_a_node_spins_without_numpy(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first message with an array loads it; rclpy's own types have some, too."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    (folder / "own.py").write_text(
        "import sys, rclpy\n"
        "from sensor_msgs.msg import Imu\n"
        "rclpy.init()\n"
        "node = rclpy.create_node('own')\n"
        "rclpy.spin_once(node, timeout_sec=0)\n"
        "print('numpy' in sys.modules)\n"
        "print(repr(Imu(linear_acceleration_covariance=range(9)).orientation_covariance[:2]))\n"
    )

    done = run(folder, "own.py", fresh=True)

    assert (done.stdout, done.stderr) == ("False\narray([0., 0.])\n", "")


def test_the_packages_of_ros_are_imported_without_collecting_garbage(folder: Path) -> None:
    """Collections would find none; afterwards they happen as before."""
    (folder / "own.py").write_text(
        "import gc\n"
        "phases = []\n"
        "gc.callbacks.append(lambda phase, info: phases.append(phase))\n"
        "import rclpy.node\n"
        "print(phases, gc.isenabled())\n"
    )

    assert run(folder, "own.py", fresh=True).stdout == "[] True\n"


def test_a_missing_package_of_ros_says_what_to_do(folder: Path) -> None:
    """At the end of the traceback, and below a cause, too."""
    (folder / "own.py").write_text("import rclpy\nfrom plansys2_msgs.msg import Plan\n")

    done = run(folder, "own.py")

    *_, error, hint = done.stderr.splitlines()
    assert done.returncode == 1
    assert error == "ModuleNotFoundError: No module named 'plansys2_msgs'"
    assert hint.startswith("aionode.rclpy: plansys2_msgs is a package of messages that aionode")
    assert "aionode run --interfaces FOLDER PROGRAM" in hint


def test_a_folder_of_messages_beside_the_program_is_no_package(folder: Path) -> None:
    """Python takes it for a package without modules, and misses the class, not the package."""
    (folder / "run_msgs" / "msg").mkdir(parents=True)
    (folder / "own.py").write_text("from run_msgs.msg import Score\n")

    done = run(folder, "own.py")

    assert done.stderr.splitlines()[-1].startswith("aionode.rclpy: run_msgs is a package of mess")


def test_a_name_that_a_package_of_aionode_does_not_have_is_shown_as_usual(folder: Path) -> None:
    """Equally named messages of another package are no reason for advice."""
    (folder / "own.py").write_text("from std_msgs.msg import Strin\n")

    assert run(folder, "own.py").stderr.splitlines()[-1].startswith("ImportError: cannot import")


def test_what_programs_import_is_listed_and_nothing_runs(folder: Path) -> None:
    """What is missing shows before anything moves."""
    (folder / "own.py").write_text("from slam_msgs.msg import Costmap\nprint('runs')\n")

    done = run(folder, "run", "--check", "program.py", "own.py", module="aionode")

    assert done.returncode == 1
    assert [line[:32] for line in done.stdout.splitlines()] == [
        "program.py",
        "  helper        beside the program"[:32],
        "  std_msgs.msg  aionode",
        "own.py",
        "  slam_msgs.msg  missing: slam_msgs"[:32],
    ]
    assert run(folder, "--check", "program.py").returncode == 0


@pytest.mark.parametrize("command", [("--check",), ("--check", "-m", "program")])
def test_a_check_without_files_is_refused(folder: Path, command: tuple[str, ...]) -> None:
    """A module would have to be imported to be found."""
    done = run(folder, "run", *command, module="aionode")

    assert done.returncode == 2
    assert "--check takes files and folders" in done.stderr
