"""Completion in the real shells."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.support.peers import isolated_environment

pexpect = pytest.importorskip("pexpect", reason="pseudo-terminals are of Unix")

BIN = Path(sys.executable).parent
PATIENCE_S = 30.0

SHELLS = {
    "bash": ["bash", "--norc", "--noprofile", "-i"],
    "zsh": ["zsh", "-f", "-i"],
    "fish": ["fish", "--no-config", "--interactive"],
}
BEFORE = {
    "bash": 'PS1="ready> "; eval "$(aionode completion bash)"',
    "zsh": 'PS1="ready> "; autoload -U compinit; compinit -D -u; eval "$(aionode completion zsh)"',
    "fish": "function fish_prompt; echo 'ready> '; end; aionode completion fish | source",
}

pytestmark = [
    pytest.mark.filterwarnings("ignore:This process .* is multi-threaded"),
    pytest.mark.skipif(not (BIN / "aionode").exists(), reason="aionode is not installed here"),
]


@pytest.fixture
def child(shell: str, tmp_path: Path) -> Iterator[Any]:
    """A shell that completes the commands of aionode."""
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    program, *arguments = SHELLS[shell]
    env = {**os.environ, **isolated_environment(), "HOME": str(tmp_path), "TERM": "dumb"}
    env["PATH"] = f"{BIN}{os.pathsep}{env['PATH']}"
    child = pexpect.spawn(program, arguments, env=env, encoding="utf-8", timeout=PATIENCE_S)
    try:
        child.sendline(BEFORE[shell])
        child.sendline("echo set up | tr a-z A-Z")
        child.expect("SET UP")
        yield child
    finally:
        child.close(force=True)


@pytest.mark.slow
@pytest.mark.parametrize("shell", SHELLS)
def test_a_type_is_completed_in_two_steps(child: Any) -> None:
    """First the package, without a space after the slash, then the name: a single word."""
    child.send("aionode interface show std_sr\t")
    child.expect("std_srvs/")
    child.send("srv/Tri\t")
    child.expect("srv/Trigger")
    child.send("\r")
    child.expect("bool success")


@pytest.mark.slow
@pytest.mark.parametrize("shell", SHELLS)
def test_values_are_completed_as_one_word(child: Any) -> None:
    """They contain blanks, commas and quotes; the command gets them as they are in YAML."""
    child.send("aionode topic pub -1 -w 0 /a std_msgs/msg/Header \t")
    child.expect("frame_id")
    child.send("\r")
    child.expect("publishing #1: std_msgs.msg.Header")


@pytest.mark.stress
@pytest.mark.parametrize("shell", SHELLS)
def test_an_option_is_completed(child: Any) -> None:
    """Its end is unique, so the shell adds it without a list."""
    child.send("aionode interface packages --only-m\t")
    child.expect("--only-msgs")
    child.send("\r")
    child.expect("geometry_msgs")


@pytest.mark.parametrize("shell", SHELLS)
def test_a_folder_is_completed(child: Any, tmp_path: Path) -> None:
    """Click leaves folders and files to the shell, which knows them."""
    (tmp_path / "robot_interfaces").mkdir()
    child.sendline(f"cd '{tmp_path}'")
    child.send("aionode interface package std_srvs --interfaces robot_in\t")
    child.expect("robot_interfaces")
    child.send("\r")
    child.expect("std_srvs/srv/Trigger")


@pytest.mark.stress
@pytest.mark.parametrize("shell", SHELLS)
def test_what_nothing_completes_is_left_as_it_is(child: Any) -> None:
    """The shell neither reports an error of the script nor replaces the word."""
    child.send("aionode interface package no_such_pack\t")
    child.send("\r")
    child.expect("Unknown package 'no_such_pack'")
