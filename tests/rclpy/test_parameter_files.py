"""Parameter files, as `rclpy.parameter.parameter_dict_from_yaml_file` reads them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

from rclpy.parameter import parameter_dict_from_yaml_file

if TYPE_CHECKING:
    from pathlib import Path

Read = Callable[..., dict[str, int]]


@pytest.fixture
def read(tmp_path: Path) -> Read:
    """Read the integers in a file with this text."""

    def values(text: str, **options: Any) -> dict[str, int]:
        file = tmp_path / "params.yaml"
        file.write_text(text)
        found = parameter_dict_from_yaml_file(str(file), **options)
        return {name: message.value.integer_value for name, message in found.items()}

    return values


def test_the_namespace_is_prepended_as_it_is(read: Read) -> None:
    """No dot is added."""
    text = "n: {ros__parameters: {a: 1, b: {c: 2}}}"

    assert read(text, target_nodes=["n"], namespace="x.") == {"x.a": 1, "x.b.c": 2}


@pytest.mark.parametrize(
    "text",
    [
        "/arm/n: {ros__parameters: {a: 1}}",
        "/arm: {n: {ros__parameters: {a: 1}}}",
        "arm: {n: {ros__parameters: {a: 1}}}",
    ],
)
def test_a_node_in_a_namespace_is_found(read: Read, text: str) -> None:
    """In a section of its own, or in that of its namespace."""
    assert read(text, target_nodes=["/arm/n"]) == {"a": 1}


def test_all_sections_of_a_node_count(read: Read) -> None:
    """With a leading slash and without."""
    text = "/n: {ros__parameters: {a: 1, b: 1}}\nn: {ros__parameters: {b: 2}}"

    assert read(text, target_nodes=["n"]) == {"a": 1, "b": 2}


def test_sections_of_other_nodes_may_be_anything(read: Read) -> None:
    """Only those of the node are read."""
    assert read("other: 3\nn: {ros__parameters: {a: 1}}", target_nodes=["n"]) == {"a": 1}


def test_a_section_adds_to_the_nested_parameters_of_the_wildcard(read: Read) -> None:
    """As the command line does; it replaces only those of the same full name."""
    text = "/**: {ros__parameters: {a: {b: 1, c: 1}}}\nn: {ros__parameters: {a: {c: 2}}}"

    assert read(text, use_wildcard=True, target_nodes=["n"]) == {"a.b": 1, "a.c": 2}


def test_a_file_without_the_node_is_refused(read: Read) -> None:
    """With rclpy's words."""
    with pytest.raises(RuntimeError, match="does not contain any valid parameters"):
        read("n: {ros__parameters: {a: 1}}", target_nodes=["m"])
