"""The tutorial's second terminal: real processes in real pseudo-terminals."""

from __future__ import annotations

import fcntl
import os
import re
import struct
import subprocess
import sys
import termios
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from click.shell_completion import BashComplete

from aionode import Context
from aionode.cli import main
from aionode.cli._main import root
from aionode.cli._support import completion
from aionode.engine.transport.link import available
from tests.support.fork_server import run, start
from tests.support.peers import isolated_environment

pexpect = pytest.importorskip("pexpect", reason="pseudo-terminals are of Unix")
fdspawn = pytest.importorskip("pexpect.fdpexpect").fdspawn

ROOT = Path(__file__).parents[2]
ROBOT = Path(__file__).with_name("robot.py")
AIONODE = [sys.executable, "-m", "aionode"]
STARTED_S = 40.0

pytestmark = pytest.mark.filterwarnings("ignore:This process .* is multi-threaded")


class Terminals:
    """Opens terminals that see the robot, and no other process on the machine."""

    def __init__(self) -> None:
        self.env = {
            **os.environ,
            **isolated_environment(),
            "AIONODE_LINK": "on",
            "TERM": "xterm",
            "COLUMNS": "200",
            "PYTHONUNBUFFERED": "1",
        }

    def open(self, *arguments: str) -> Any:
        """Start a command in its own terminal."""
        return pexpect.spawn(
            AIONODE[0],
            [*AIONODE[1:], *arguments],
            env=self.env,
            encoding="utf-8",
            timeout=STARTED_S,
            dimensions=(50, 200),
        )

    def shown(self, *arguments: str) -> tuple[str, int]:
        """Return the output of a command in a terminal, and its exit status."""
        terminal, tty = os.openpty()
        fcntl.ioctl(tty, termios.TIOCSWINSZ, struct.pack("4H", 50, 200, 0, 0))
        command = ["-m", "aionode", *arguments]
        process = start(command, env=self.env, stdin=tty, stdout=tty, stderr=tty)
        os.close(tty)
        reader = fdspawn(terminal, encoding="utf-8", timeout=STARTED_S)
        try:
            reader.expect(pexpect.EOF)
            status = process.wait(STARTED_S)
        finally:
            process.kill()
            reader.close()
        return reader.before.replace("\r\n", "\n"), status

    def run(self, *arguments: str, **env: str) -> subprocess.CompletedProcess[str]:
        """Run a command with its output in pipes."""
        return run(["-m", "aionode", *arguments], env=self.env | env, timeout=STARTED_S)


@pytest.fixture(scope="module")
def terminals() -> Iterator[Terminals]:
    """Terminals, and the robot's nodes running in one of them."""
    opened = Terminals()
    classes = ("Talker", "AddServer", "ParamNode", "Camera", "FibServer")
    robot = opened.open("run", *(f"{ROBOT}:{name}" for name in classes))
    robot.expect("the robot is ready")
    yield opened
    robot.sendintr()
    robot.expect(pexpect.EOF)
    robot.close()
    assert "Traceback" not in robot.before
    assert robot.exitstatus == 0


@pytest.fixture
def in_robot(terminals: Terminals, monkeypatch: pytest.MonkeyPatch) -> None:
    """The variables of a terminal, for commands that run in the tests' process.

    A separate process would import all of aionode for each.
    """
    for name, value in terminals.env.items():
        monkeypatch.setenv(name, value)


# What the tutorial types


def test_topic_list(terminals: Terminals) -> None:
    """The first answer has all topics; there is no daemon that has to discover them."""
    assert terminals.shown("topic", "list") == (
        "/chatter\n/parameter_events\n/rosout\n/stamped\n",
        0,
    )


def test_node_list(terminals: Terminals) -> None:
    """Four nodes, although in one process."""
    assert terminals.shown("node", "list") == (
        "/add_server\n/fib_server\n/param_node\n/talker\n",
        0,
    )


def test_a_type_that_only_the_robot_has_can_be_shown(terminals: Terminals) -> None:
    """It is written in Python there, and the node that uses it describes it."""
    assert terminals.shown("interface", "show", "robot_msgs/msg/Words") == ("string text\n", 0)


def test_topic_info(terminals: Terminals) -> None:
    """Type and counts."""
    assert terminals.shown("topic", "info", "/chatter") == (
        "Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 0\n",
        0,
    )


def test_topic_echo_once(terminals: Terminals) -> None:
    """One message, then the prompt again."""
    assert terminals.shown("topic", "echo", "--once", "/chatter") == ("data: Hello\n---\n", 0)


@pytest.mark.slow
def test_topic_plot_draws_until_ctrl_c(terminals: Terminals) -> None:
    """In colours and dots, repeatedly in the same place; Ctrl-C is its normal end."""
    command = terminals.open("topic", "plot", "/stamped.header.stamp.nanosec", "-w", "2")
    for _ in range(3):
        command.expect("[\u2801-\u28ff]")
        command.expect(r"/stamped\.header\.stamp\.nanosec: [0-9.e+]+")
    command.sendintr()
    command.expect(pexpect.EOF)
    command.close()

    assert "Traceback" not in command.before
    assert command.exitstatus == 0


def test_service_call(terminals: Terminals) -> None:
    """The output of the tutorial, word for word."""
    request = ("example_interfaces/srv/AddTwoInts", "{a: 42, b: 58}")

    text, status = terminals.shown("service", "call", "/add_two_ints", *request)

    assert status == 0
    assert text == (
        "requester: making request: example_interfaces.srv.AddTwoInts_Request(a=42, b=58)\n"
        "\n"
        "response:\n"
        "example_interfaces.srv.AddTwoInts_Response(sum=100)\n"
        "\n"
    )


def test_parameters_are_set_and_read_back(terminals: Terminals) -> None:
    """A value of the wrong type is refused, with status 1."""
    node = "/param_node"

    assert terminals.shown("param", "get", node, "name") == ("String value is: bob\n", 0)
    assert terminals.shown("param", "set", node, "speed", "2.5") == (
        "Set parameter successful\n",
        0,
    )
    assert terminals.shown("param", "get", node, "speed") == ("Double value is: 2.5\n", 0)
    text, status = terminals.shown("param", "set", node, "name", "5")
    assert text.startswith("Setting parameter failed: Wrong parameter type, expected 'Type.STRING'")
    assert status == 1


def test_an_action_goal_is_sent(terminals: Terminals) -> None:
    """Feedback on the way, the result at the end."""
    goal = ("/fibonacci", "example_interfaces/action/Fibonacci", "{order: 3}")

    text, status = terminals.shown("action", "send_goal", "-f", *goal)

    assert status == 0
    assert text.count("Feedback:") == 2
    assert text.endswith("\nGoal finished with status: SUCCEEDED\n")


def test_what_one_terminal_publishes_another_one_shows(terminals: Terminals) -> None:
    """``--once`` waits for the subscription, so that nothing is lost."""
    listener = terminals.open("topic", "echo", "/golden", "std_msgs/msg/String")
    listener.expect("does not appear to be published yet")

    text, status = terminals.shown(
        "topic", "pub", "-1", "/golden", "std_msgs/msg/String", "data: hi"
    )
    listener.expect("data: hi\r\n---\r\n")
    listener.sendintr()
    listener.expect(pexpect.EOF)
    listener.close()

    assert "publishing #1: std_msgs.msg.String(data='hi')" in text
    assert (status, listener.exitstatus) == (0, 0)


# Ctrl-C

ADD = "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"


@pytest.mark.parametrize(
    ("arguments", "when", "status"),
    [
        ("topic echo /chatter", "data: Hello", 0),
        pytest.param("topic hz /chatter", "average rate: ", 0, marks=pytest.mark.stress),
        pytest.param("topic hz /chatter /stamped", "min_delta", 0, marks=pytest.mark.slow),
        pytest.param("topic bw /chatter", "/s from", 0, marks=pytest.mark.slow),
        pytest.param("topic delay /stamped", "average delay: ", 0, marks=pytest.mark.stress),
        pytest.param(
            "topic pub /out std_msgs/msg/String", "publishing #1", 0, marks=pytest.mark.stress
        ),
        ("topic pub -1 /out std_msgs/msg/String", "Waiting for at least 1", 130),
        pytest.param(
            "topic hz /unknown", "does not appear to be published yet", 0, marks=pytest.mark.stress
        ),
        (f"service call /unknown {ADD}", "waiting for service to become available", 130),
        pytest.param(
            f"action send_goal /fibonacci {FIBONACCI}", "Goal accepted", 0, marks=pytest.mark.slow
        ),
        pytest.param(
            f"action send_goal /unknown {FIBONACCI}",
            "Waiting for an action server",
            130,
            marks=pytest.mark.stress,
        ),
        ("router -l tcp/127.0.0.1:0", "Router is listening", 0),
        pytest.param("gateway --port 0", "Gateway is listening", 0, marks=pytest.mark.slow),
    ],
)
def test_ctrl_c_ends_a_command_without_a_traceback(
    arguments: str, when: str, status: int, terminals: Terminals
) -> None:
    """0 where Ctrl-C is the normal end, 130 where work was left undone."""
    child = terminals.open(*arguments.split())
    child.expect_exact(when)
    child.sendintr()
    child.expect(pexpect.EOF)
    child.close()

    assert "Traceback" not in child.before
    assert child.exitstatus == status
    if "Goal" in when:
        assert "Canceling goal...\r\nGoal canceled.\r\n" in child.before
        assert "Goal finished with status: CANCELED\r\n" in child.before


def test_a_reader_that_goes_away_is_no_error(terminals: Terminals) -> None:
    """``| head`` is a common way to look at a topic."""
    command = f"{' '.join(AIONODE)} topic echo /chatter | head -n 1; echo ${{PIPESTATUS[0]}}"

    done = subprocess.run(
        ["bash", "-c", command],
        env=terminals.env,
        capture_output=True,
        text=True,
        timeout=STARTED_S,
        check=True,
    )

    assert (done.stdout, done.stderr) == ("data: Hello\n0\n", "")


# Bad input


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["topic", "info", "/chater"], "Unknown topic '/chater'. Did you mean '/chatter'?"),
        (["topic", "echo", "/chater"], "Could not determine the type for the passed topic"),
        (["topic", "echo", "no blanks"], "Invalid topic name 'no blanks'"),
        (["topic", "pub", "/a", "std_msgs/msg/Strin"], "did you mean std_msgs/msg/String?"),
        (["topic", "pub", "/a", "std_msgs/msg/Int8", "{data: 300}"], "-128 to 127"),
        (["topic", "pub", "/a", "std_msgs/msg/String", "{data: "], "not valid YAML"),
        (["service", "call", "/add_two_ints", ADD, "{c: 1}"], "has a, b"),
        (["param", "get", "/param_node", "nope"], "Parameter not set: no parameter 'nope'"),
        (["param", "get", "/nope", "name"], "Node not found: '/nope'"),
        (["node", "info", "/nope"], "Unable to find node '/nope'"),
    ],
)
@pytest.mark.usefixtures("in_robot")
def test_bad_input_is_one_line_on_stderr(
    arguments: list[str], says: str, capfd: pytest.CaptureFixture[str]
) -> None:
    """It says what was given, where, and what is expected; status 1; no traceback."""
    status = main(arguments)

    stdout, stderr = capfd.readouterr()
    assert status == 1
    assert stdout == ""
    *waiting, line = stderr.splitlines()
    assert all(text.startswith("Waiting for discovery") for text in waiting)  # a busy machine
    assert says in line


@pytest.mark.usefixtures("in_robot")
def test_a_command_in_a_program_has_a_context_of_its_own(
    capfd: pytest.CaptureFixture[str],
) -> None:
    """The default one has the environment of its first use, and belongs to the program."""
    with Context.as_default(Context(transport="local")):
        assert main(["topic", "type", "/chatter"]) == 0

    assert capfd.readouterr().out == "std_msgs/msg/String\n"


def test_an_invalid_domain_is_an_error(terminals: Terminals) -> None:
    """The environment is input too."""
    done = terminals.run("topic", "list", ROS_DOMAIN_ID="many")

    assert done.returncode == 1
    assert re.fullmatch(r"ROS_DOMAIN_ID: 'many' given; .*\n", done.stderr)


# The shell and other programs


LINEAR = ["twist.linear", "twist.linear.x", "twist.linear.y", "twist.linear.z"]


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["topic", "info", "/ch"], ["/chatter"]),
        (["topic", "pub", "/chatter", ""], ["std_msgs/msg/String"]),
        (["topic", "echo", "/chatter", "std_s"], ["std_srvs/"]),
        (["topic", "pub", "/unknown", "std_m"], ["std_msgs/"]),
        (["service", "call", "/add_two_ints", ""], [ADD]),
        (["action", "send_goal", "/fibonacci", "ex"], [FIBONACCI]),
        (["param", "get", "/param_node", "s"], ["speed", "start_type_description_service"]),
        (["param", "describe", "param_node", "name", "sp"], ["speed"]),
        (["param", "get", "/unknown", ""], []),
        (["topic", "pub", "/chatter", "std_msgs/msg/String", ""], ['{data: ""}']),
        (["topic", "pub", "/_words", "robot_msgs/msg/Words", ""], ['{text: ""}']),
        (["topic", "pub", "/chatter", "std_msgs/msg/Nope", ""], []),
        (["service", "call", "/add_two_ints", ADD, ""], ["{a: 0, b: 0}"]),
        (["action", "send_goal", "/fibonacci", FIBONACCI, ""], ["{order: 0}"]),
        (["topic", "echo", "/stamped", "--field", "twist.l"], LINEAR),
        (["topic", "echo", "--field", ""], []),
        (["lifecycle", "set", "/_camera", ""], ["configure", "shutdown"]),
        (["lifecycle", "set", "/unknown", ""], []),
    ],
)
@pytest.mark.usefixtures("in_robot")
def test_the_shell_is_offered_what_is_on_the_network(
    words: list[str],
    offered: list[str],
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The current names; after a name, its types or parameters.

    `test_shells.py` lets real shells ask, in separate processes.
    """
    if offered:  # nobody waits for it, and machines are busy
        monkeypatch.setattr(completion, "ANSWER_S", STARTED_S)
    shell = BashComplete(root, {}, "aionode", "_AIONODE_COMPLETE")

    *before, incomplete = words
    completions = shell.get_completions(before, incomplete)

    assert [(completion_item.type, completion_item.value) for completion_item in completions] == [
        ("plain", name) for name in offered
    ]
    assert capfd.readouterr() == ("", "")


def test_programs_get_one_record_for_each_line(terminals: Terminals) -> None:
    """Nothing else is on stdout."""
    done = terminals.run("topic", "list", "--json")

    assert done.stdout.splitlines()[0] == (
        '{"name":"/chatter","types":["std_msgs/msg/String"],"publishers":1,"subscriptions":0}'
    )


@pytest.mark.slow
def test_the_doctor_finds_a_sound_robot_sound(terminals: Terminals) -> None:
    """It sees all nodes of the other process, and no router; late timers are of a busy machine."""
    text, status = terminals.shown("doctor")

    problems = [line for line in text.splitlines() if line.startswith("problem:")]
    assert [line for line in problems if "after its input has arrived" not in line] == [], text
    assert (status == 0, "0 problem(s)" in text) == (not problems, not problems), text
    assert "Nodes: 4\n" in text
    assert "none" in text


@pytest.mark.slow
@pytest.mark.skipif(not available(), reason="links are of Linux")
def test_the_doctor_shows_the_route_of_a_pair(terminals: Terminals) -> None:
    """As seen from a process without links."""
    listener = terminals.open("run", f"{ROOT}/examples/listener.py:Listener")
    try:
        listener.expect("I heard: Hello")
        linked = terminals.run("doctor", "/chatter", AIONODE_LINK="off")
    finally:
        listener.sendintr()
        listener.expect(pexpect.EOF)
        listener.close()
    alone = terminals.run("doctor", "/chatter")

    assert "Pairs of linked processes: 1\n  /talker -> /listener on /chatter: link" in linked.stdout
    assert "Pairs of linked processes: 0\n\n" in alone.stdout


@pytest.mark.slow
def test_the_doctor_sees_nodes_of_another_domain(terminals: Terminals) -> None:
    """The most common reason why no node is found, with a remedy that can be typed."""
    done = terminals.run("doctor", ROS_DOMAIN_ID="41")

    assert done.returncode == 0  # a hint that it may be meant
    # Programs of other tests may be in others.
    assert re.search(r"Other domains here: .*\b42\b", done.stdout)
    assert "no other node in domain 41, but there are programs in domain 42" in done.stdout
    assert "-> set ROS_DOMAIN_ID=42" in done.stdout
