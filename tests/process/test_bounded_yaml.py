"""Tests that untrusted YAML is limited, and raises one kind of error, wherever it is read."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
import yaml

from aionode._process.bounded_yaml import VALUES_VARIABLE, composed_yaml, documents_in, loaded_yaml
from aionode.arguments import parse_arguments, read_parameter_file
from aionode.errors import CommandError, LaunchFileError, ParameterFileError, PolicyFileError
from aionode.gateway import Policy
from aionode.interfaces.std_msgs.msg import String
from aionode.launch._evaluation import load_description
from aionode.parameter import get_parameter_value
from launch.utilities.type_utils import coerce_to_type

BOMB = "a0: &a0 [x]\n" + "".join(
    f"a{at}: &a{at} [{', '.join([f'*a{at - 1}'] * 10)}]\n" for at in range(1, 11)
)
"""Ten lines that stand for ten billion values."""

HARMFUL = {
    "[" * 100_000: "nest",
    "- " * 5000: "nested deeper",
    "&a [*a]": "within its own value",
    "!!int ''": "cannot be read",
    "2001-99-99": "cannot be read",
    "9" * 5000: "a number of 5000 characters",
    "1" + ":59" * 50_000: "a number of",
    "[" + "x," * 90_000 + "]": VALUES_VARIABLE,
    "\ud800": "not text",
    BOMB: "counting the values of each alias",
}


@pytest.mark.parametrize("text", HARMFUL, ids=lambda text: repr(text[:12]))
@pytest.mark.parametrize("read", [loaded_yaml, documents_in])
def test_what_is_not_read_is_one_kind_of_error(read: object, text: str) -> None:
    """Callers catch `yaml.YAMLError`, whatever Python would have raised."""
    assert callable(read)
    with pytest.raises(yaml.YAMLError) as caught:
        read(text)
    assert HARMFUL[text] in str(caught.value)


def test_keys_that_are_merged_count_as_often_as_they_are_merged() -> None:
    """PyYAML copies them each time, which could take gigabytes."""
    text = "b: &b0 {k: v, l: w}\n"
    for at in range(1, 12):
        text += f"c{at}: &b{at} {{<<: [{', '.join([f'*b{at - 1}'] * 9)}]}}\n"
    with pytest.raises(yaml.YAMLError, match="counting the values"):
        composed_yaml(text)


@pytest.mark.slow
def test_the_variable_raises_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """The metadata of a bag with ten thousand files are long, but no attack."""
    monkeypatch.setenv(VALUES_VARIABLE, "100000")
    assert len(loaded_yaml("[" + "x," * 90_000 + "]")) == 90_000


def test_a_launch_file_has_the_same_limits(tmp_path: Path) -> None:
    """It may come from any repository."""
    for text in (BOMB, "launch: &a\n- group: *a\n", "launch:\n- let: {name: !!int ''}\n"):
        file = tmp_path / "x.launch.yaml"
        file.write_text(text)
        with pytest.raises(LaunchFileError, match="not valid YAML"):
            load_description(str(file))


def test_elements_of_a_launch_file_are_not_nested_without_end(tmp_path: Path) -> None:
    """Python's stack would overflow first."""
    file = tmp_path / "x.launch.xml"
    file.write_text("<launch>" + "<group>" * 5000 + "</group>" * 5000 + "</launch>")
    with pytest.raises(LaunchFileError, match="nested deeper"):
        load_description(str(file))


def test_a_text_that_is_beyond_the_limits_is_a_text() -> None:
    """It is treated like text that is not YAML, where a parameter or an argument is read."""
    assert coerce_to_type(BOMB) == BOMB
    assert get_parameter_value(BOMB).string_value == BOMB


def test_a_message_on_the_command_line_has_the_same_limits() -> None:
    """It may have been copied from anywhere."""
    from aionode.cli._support.yaml_messages import message_from_yaml

    with pytest.raises(CommandError, match="counting the values"):
        message_from_yaml(String, BOMB)


@pytest.mark.slow
def test_a_parameter_file_has_as_many_values_at_most(monkeypatch: pytest.MonkeyPatch) -> None:
    """The rules of rcl allow no aliases, but any number of values."""
    monkeypatch.setenv(VALUES_VARIABLE, "1000")
    with pytest.raises(ParameterFileError, match=VALUES_VARIABLE):
        list_of_rules("/**: {ros__parameters: {a: [" + "1," * 1000 + "1]}}")


def list_of_rules(text: str) -> None:
    """Read parameters as a file is read."""
    from aionode.arguments._parameter_yaml import parse_parameter_yaml

    parse_parameter_yaml(text)


def test_pipes_in_place_of_files_are_refused(tmp_path: Path) -> None:
    """Each would wait forever for a writer."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(ParameterFileError, match="pipe"):
        read_parameter_file(pipe)
    with pytest.raises(LaunchFileError, match="pipe"):
        load_description(str(pipe))
    with pytest.raises(PolicyFileError, match="pipe"):
        Policy.load(pipe)


def test_the_pipe_that_a_shell_hands_over_is_read() -> None:
    """``--params-file <(generate)`` passes one."""
    reading, writing = os.pipe()
    os.write(writing, b"/**: {ros__parameters: {a: 1}}")
    os.close(writing)
    try:
        arguments = parse_arguments(["--ros-args", "--params-file", f"/dev/fd/{reading}"])
    finally:
        os.close(reading)
    assert arguments.parameters_for("/x") == {"a": 1}
