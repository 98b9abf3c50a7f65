"""The modules that generate_parameter_library would generate, without a build."""

from __future__ import annotations

import math
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import pytest

import rclpy
from aionode.rclpy._check import check
from generate_parameter_library_py.parameters import classes_of
from generate_parameter_library_py.python_validators import ParameterValidators
from rclpy.exceptions import InvalidParameterValueException, ParameterUninitializedException
from rclpy.node import Node
from rclpy.parameter import Parameter
from tests.support.peers import isolated_environment

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

DESCRIBED = """\
gripper:
  speed:
    type: double
    default_value: 1
    description: "metres a second"
    validation:
      gt<>: [0.0]
      lt_eq<>: [2.0]
  mode:
    type: string
    default_value: "soft"
    validation:
      one_of<>: [["soft", "hard"]]
  tool: {type: string}
  origin: {type: double_array_fixed_3, default_value: [0, 0.5]}
  serial: {type: int, default_value: 7, read_only: true, validation: {bounds<>: [1, 9]}}
  unused: {type: none}
  joints: {type: string_array, default_value: ["left"]}
  pid:
    rate: {type: double, default_value: .nan}
    __map_joints:
      p: {type: double, default_value: 3.0, validation: {gt_eq<>: 0.0}}
      limits:
        high: {type: int, default_value: 5}
"""


@pytest.fixture
def make(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Makes a node with some parameters, and the listener of a description."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    rclpy.init(args=[])

    def made(described: str = DESCRIBED, /, **given: Any) -> tuple[Any, Any]:
        overrides: list[Any] = [
            Parameter(name.replace("__", "."), value=value) for name, value in given.items()
        ]
        node = Node("gripper", parameter_overrides=overrides)
        return node, classes(tmp_path, described).ParamListener(node)

    yield made
    rclpy.try_shutdown()


def classes(folder: Path, described: str) -> Any:
    """Return the classes of a description."""
    file = folder / "parameters.yaml"
    file.write_text(described)
    return classes_of(file, "")["gripper"]


def test_parameters_are_declared_and_have_their_values(make: Any) -> None:
    """Defaults are of their type; those without one have to be given."""
    node, listener = make(tool="cup", speed=1.5)
    params = listener.get_params()

    assert (params.speed, params.mode, params.tool, params.serial) == (1.5, "soft", "cup", 7)
    assert params.origin == [0.0, 0.5]
    assert math.isnan(params.pid.rate)
    assert params.pid.get_entry("left").p == 3.0
    assert params.pid.left.limits.high == 5
    assert node.get_parameter("pid.left.limits.high").value == 5
    assert not hasattr(params, "unused")
    with pytest.raises(ParameterUninitializedException):
        make()


def test_descriptors_have_texts_and_ranges(make: Any) -> None:
    """The open end of a range is the next number, as in the original."""
    node, _ = make(tool="cup")

    speed = node.describe_parameter("speed")
    assert speed.description == "metres a second"
    assert speed.floating_point_range[0].from_value == sys.float_info.epsilon
    assert speed.floating_point_range[0].to_value == 2.0
    serial = node.describe_parameter("serial")
    assert serial.read_only
    assert (serial.integer_range[0].from_value, serial.integer_range[0].to_value) == (1, 9)


def test_a_value_that_is_not_valid_is_refused(make: Any) -> None:
    """At the start by an exception, later by the node's answer, and then nothing changes."""
    with pytest.raises(InvalidParameterValueException, match="is not in the set"):
        make(tool="cup", mode="rude")
    node, listener = make(tool="cup")
    said: list[Any] = []
    listener.set_user_callback(said.append)

    (answer,) = node.set_parameters([Parameter("mode", value="rude")])

    assert not answer.successful
    assert "is not in the set" in answer.reason
    assert (listener.get_params().mode, said) == ("soft", [])


def test_a_change_makes_the_parameters_old_and_is_told(make: Any) -> None:
    """The program has a copy."""
    node, listener = make(tool="cup")
    params = listener.get_params()
    said: list[Any] = []
    listener.set_user_callback(said.append)
    assert not listener.is_old(params)

    node.set_parameters([Parameter("speed", value=2.0)])
    listener.clear_user_callback()
    node.set_parameters([Parameter("pid.left.p", value=4.0)])

    assert listener.is_old(params)
    assert (params.speed, [each.speed for each in said]) == (1.0, [2.0])
    assert listener.get_params().pid.left.p == 4.0


def test_new_entries_of_a_map_are_declared_when_the_program_asks(make: Any) -> None:
    """The keys of the map are a parameter that changes."""
    node, listener = make(tool="cup")
    node.set_parameters([Parameter("joints", value=["left", "right"])])
    listener.refresh_dynamic_parameters()
    node.set_parameters([Parameter("pid.right.p", value=1.25)])

    params = listener.get_params()
    assert (params.pid.left.p, params.pid.right.p) == (3.0, 1.25)


def test_parameters_are_set_by_a_dict(make: Any) -> None:
    """As controllers do it that have their values from elsewhere."""
    _, listener = make(tool="cup")

    listener.set_params_from_dict({"speed": 0.5, "pid": {"left": {"p": 9.0}}})

    params = listener.get_params()
    assert (params.speed, params.pid.left.p) == (0.5, 9.0)


@pytest.mark.parametrize(
    ("described", "text"),
    [
        ("gripper: {a: {type: colour}}", "gripper.a: no type 'colour'"),
        ("gripper: {a: {type: int, defualt: 3}}", "gripper.a: 'defualt' is not known"),
        ("gripper: {a: {default_value: 3}}", "gripper.a: it has no 'type'"),
        (
            "gripper: {a: {type: int, default_value: x}}",
            "gripper.a: the default 'x' is not of type int",
        ),
        ("gripper: {a: {type: int_array, default_value: 3}}", "is not of type int_array"),
        ("gripper: {a: {type: int, validation: {odd<>: null}}}", "no validator 'odd<>'"),
        ("gripper: 5", "gripper: neither"),
        ("{a: {}, b: {}}", "not below one name"),
        ("gripper: [", "parameters.yaml: "),
    ],
)
def test_a_wrong_description_is_an_import_error_with_its_place(
    tmp_path: Path, described: str, text: str
) -> None:
    """The module that it describes is imported, so that is what fails."""
    with pytest.raises(ImportError) as caught:
        classes(tmp_path, described)

    assert text in str(caught.value)


def test_validators_say_what_is_wrong() -> None:
    """Each of them returns an empty text for a value that fits."""
    checks = ParameterValidators
    for name, value, arguments in (
        ("lt", 3, [3]),
        ("gt", 3, [3]),
        ("lt_eq", 4, [3]),
        ("gt_eq", 2, [3]),
        ("not_empty", [], []),
        ("one_of", 3, [[1, 2]]),
        ("unique", [1, 1], []),
        ("subset_of", [1, 3], [[1, 2]]),
        ("fixed_size", [1], [2]),
        ("size_gt", [1], [1]),
        ("size_lt", [1], [1]),
        ("element_bounds", [1, 5], [1, 4]),
        ("lower_element_bounds", [1], [2]),
        ("upper_element_bounds", [3], [2]),
        ("bounds", 5, [1, 4]),
    ):
        wrong = getattr(checks, name)(Parameter("a", value=value), *arguments)
        assert "a" in wrong, name
    assert checks.bounds(Parameter("a", value=4), 1, 4) == ""
    assert checks.unique(Parameter("a", value=[1, 2])) == ""


@pytest.mark.processes
@pytest.mark.parametrize("build", [pytest.param("cmake", marks=pytest.mark.slow), "python"])
def test_a_program_imports_the_module_of_its_workspace(tmp_path: Path, build: str) -> None:
    """Found by the rule that would generate it, with validators of the package."""
    package = tmp_path / "arm"
    (package / "arm").mkdir(parents=True)
    (package / "package.xml").write_text(
        "<package format='3'><name>arm</name><version>1.0.0</version>"
        f"<export><build_type>ament_{build}</build_type></export></package>"
    )
    (package / "arm/parameters.yaml").write_text(
        "gripper:\n  speed:\n    type: int\n    default_value: 3\n"
        '    validation:\n      "custom_validators::odd": null\n'
    )
    (package / "arm/checks.py").write_text(
        "def odd(param):\n    return '' if param.value % 2 else 'not odd'\n"
    )
    if build == "cmake":
        (package / "CMakeLists.txt").write_text(
            "project(arm)\ngenerate_parameter_module(arm_parameters arm/parameters.yaml "
            "${PROJECT_NAME}.checks)  # a comment\n"
        )
    else:
        (package / "setup.py").write_text(
            "import sys\nname = 'arm_parameters'\nif len(sys.argv) > 1:\n"
            "    where = 'arm/parameters.yaml'\n"
            "    generate_parameter_module(name, where, validation_module='arm.checks')\n"
        )
    program = package / "arm/mover.py"
    program.write_text(
        "import rclpy\nfrom rclpy.parameter import Parameter\n"
        "from arm.arm_parameters import gripper\n"
        "rclpy.init()\nnode = rclpy.create_node('mover')\n"
        "listener = gripper.ParamListener(node)\nprint(listener.get_params().speed)\n"
        "print(node.set_parameters([Parameter('speed', value=4)])[0].reason)\n"
    )

    done = subprocess.run(
        [sys.executable, "-m", "aionode.rclpy", str(program)],
        env=isolated_environment(),
        capture_output=True,
        text=True,
        check=False,
        timeout=50,
    )

    assert done.stdout.splitlines() == ["3", "not odd"], done.stderr
    text, is_whole = check([str(program)])
    assert is_whole, text
