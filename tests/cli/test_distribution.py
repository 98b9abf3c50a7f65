"""Commands beside a ROS 2 Humble robot: the setting they suggest, and answers once it is set."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator

import pytest

from tests.support import fork_server
from tests.support.peers import DOMAIN_ID, isolated_environment, raw_session

AIONODE = [sys.executable, "-m", "aionode"]
TYPE = "std_msgs::msg::dds_::String_"


@pytest.fixture(scope="module")
def env() -> Iterator[dict[str, str]]:
    """An environment with one publisher of Humble."""
    isolated = isolated_environment()
    port = isolated["AIONODE_MEETING_PORTS"].split(",")[0]
    with pytest.MonkeyPatch.context() as patch:
        for name, value in isolated.items():
            patch.setenv(name, value)
        with raw_session(listen=f"tcp/127.0.0.1:{port}") as session:
            place = f"@ros2_lv/{DOMAIN_ID}/{session.zid()}/0"
            liveliness = session.liveliness()
            publisher = f"%/%/robot/%chatter/{TYPE}/TypeHashNotSupported/::,10:,:,:,,"
            tokens = [
                liveliness.declare_token(f"{place}/{token}")
                for token in ("0/NN/%/%/robot", f"1/MP/{publisher}")
            ]
            yield {**os.environ, **isolated}
            del tokens  # kept until here: a token is withdrawn when it is collected


def run(env: dict[str, str], *arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """Return the result of a command."""
    return fork_server.run(["-m", "aionode", *arguments], env=env | variables, timeout=50)


@pytest.mark.slow
def test_a_command_says_that_the_robot_is_humble(env: dict[str, str]) -> None:
    """The graph is shown nevertheless."""
    done = run(env, "topic", "list")

    assert done.stdout == "/chatter\n"
    assert done.stderr == ("WARNING: a Humble robot is here: set ROS_DISTRO=humble to talk to it\n")


def test_a_command_that_speaks_humble_has_nothing_to_say(env: dict[str, str]) -> None:
    """The type is known by its name alone."""
    done = run(env, "topic", "info", "-v", "/chatter", ROS_DISTRO="humble")

    assert "Topic type: std_msgs/msg/String" in done.stdout
    assert done.stderr == ""


def test_the_doctor_calls_it_a_problem(env: dict[str, str]) -> None:
    """Nothing else would explain why a listener receives nothing."""
    done = run(env, "doctor")

    assert (
        "problem: ROS_DISTRO: a Humble robot is here\n  -> set ROS_DISTRO=humble to talk to it"
        in done.stdout
    )
    assert done.returncode == 1
