"""Contracts: what a file may say, its errors, and the values of messages."""

from __future__ import annotations

import math
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from msgspec import structs

from aionode import image
from aionode.errors import ContractError, MessageError
from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.sensor_msgs.msg import Image, JointState, LaserScan
from aionode.learn import Contract, Observation, contract

TEXT = """\
task: pick the cube
fps: 30
observations:
  - feature: observation.images.front
    topic: /camera/image_raw
    type: sensor_msgs/msg/Image
    image: color
    height: 4
    width: 6
    max_age: 0.05
  - feature: observation.state
    topic: /joint_states
    type: sensor_msgs/msg/JointState
    fields: [position.shoulder, position.elbow]
    names: [shoulder, elbow]
    unit: rad
actions:
  - feature: action
    topic: /arm/command
    type: std_msgs/msg/Float64MultiArray
    fields: [data.0, data.1]
    lower: -1
    upper: [1, 2]
    stop: zero
"""


def loaded(tmp_path: Path, text: str = TEXT) -> Contract:
    """Return the contract of a text."""
    file = tmp_path / "contract.yaml"
    file.write_text(text)
    return Contract.load(file)


def test_a_contract_says_what_its_features_are(tmp_path: Path) -> None:
    """Recorder, converter and driver read the same."""
    read = loaded(tmp_path)
    features = read.features
    assert [(each.name, each.kind, each.shape) for each in features.values()] == [
        ("observation.images.front", "color", (4, 6, 3)),
        ("observation.state", "numbers", (2,)),
        ("action", "numbers", (2,)),
    ]
    assert features["observation.state"].labels == ("shoulder", "elbow")
    assert features["action"].labels == ("data.0", "data.1")
    assert read.main.topic == "/camera/image_raw"
    assert read.max_age(read.observations[1]) == pytest.approx(0.05)


def test_the_example_of_the_docstring_is_a_contract(tmp_path: Path) -> None:
    """It is what people begin with."""
    assert contract.__doc__ is not None
    text = textwrap.dedent(contract.__doc__.partition("::\n\n")[2].partition("\n\n")[0])
    assert loaded(tmp_path, text).main.shape == (480, 640, 3)


def test_a_contract_survives_its_plain_values(tmp_path: Path) -> None:
    """An episode carries its contract."""
    read = loaded(tmp_path)
    assert Contract.from_dict(read.to_dict()) == read


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("max_age: 0.05", "max_aeg: 0.05", "line 10: observations[0].max_aeg: no such key; did"),
        ("max_age: 0.05", "max_age: old", "line 10: observations[0].max_age: Expected `float`"),
        ("max_age: 0.05", "max_age: .nan", "line 10: observations[0].max_age: nan; use a number"),
        ("fps: 30", "fps: 30\nfps: 20", "line 3: fps: given twice"),
        ("fps: 30", "fps: 0", "line 2: fps: 0; use 1 to 1000"),
        ("fps: 30", "fps: 30\nreference: /camera/image", "did you mean /camera/image_raw?"),
        ("fps: 30", "fbs: 30", "line 2: fbs: no such key; did you mean fps?"),
        ("JointState", "JointStat", "line 13: observations[1].type: "),
        ("msg/JointState", "srv/SetCameraInfo", "line 13: observations[1].type: "),
        ("position.elbow", "positon.elbow", "line 14: observations[1].fields: 'positon.elbow': no"),
        ("position.elbow", "position", "it is an array, float64[]; name one element"),
        ("position.elbow", "header.frame_id", "it is string, not a number"),
        ("[shoulder, elbow]", "[shoulder]", "observations[1].names: 1 names for 2 numbers"),
        ("image: color", "", "observations[0].image: none; use color, mono or depth"),
        ("image: color", "image: colour", "observations[0].image: Invalid enum value 'colour'"),
        ("stop: zero", "stop: {dota: [0]}", "actions[0].stop: "),
        ("    stop: zero\n", "", "actions[0]: Object missing required field `stop`"),
        ("upper: [1, 2]", "upper: -2", "actions[0].lower: greater than upper"),
        ("upper: [1, 2]", "upper: [1]", "actions[0].upper: 1 limits for 2 numbers"),
        ("feature: action", "feature: a/b", "actions[0].feature: 'a/b'; use letters"),
        ("data.1", "data.one", "'one' is not an index"),
        ("task: pick the cube", "[", "not YAML"),
    ],
)
def test_an_error_names_the_line_and_what_fits(
    tmp_path: Path, old: str, new: str, expected: str
) -> None:
    """A contract is written by hand."""
    with pytest.raises(ContractError) as caught:
        loaded(tmp_path, TEXT.replace(old, new, 1))
    assert expected in str(caught.value)
    assert str(tmp_path) in str(caught.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    """As any other error of a contract."""
    with pytest.raises(ContractError, match=r"nothing\.yaml: cannot be read: No such file"):
        Contract.load(tmp_path / "nothing.yaml")


def test_joints_are_found_by_name_in_any_order(tmp_path: Path) -> None:
    """A driver may list its joints in another order after a restart."""
    state = loaded(tmp_path).observations[1]
    message = JointState(name=["elbow", "wrist", "shoulder"], position=[1.0, 2.0, 3.0])
    assert state.value(message).tolist() == [3.0, 1.0]


def test_a_message_without_a_joint_says_which(tmp_path: Path) -> None:
    """Two drivers that share a topic publish some joints each."""
    state = loaded(tmp_path).observations[1]
    with pytest.raises(MessageError, match=r"position.shoulder.*the names are elbow"):
        state.value(JointState(name=["elbow"], position=[1.0]))


def test_pictures_become_red_green_and_blue(tmp_path: Path) -> None:
    """As data sets have them."""
    front = loaded(tmp_path).observations[0]
    pixels = np.zeros((4, 6, 3), np.uint8)
    pixels[..., 0] = 200  # blue
    assert front.value(image.from_numpy(pixels, "bgr8"))[0, 0].tolist() == [0, 0, 200]


def test_a_picture_of_another_size_is_an_error(tmp_path: Path) -> None:
    """A camera was set to another mode."""
    front = loaded(tmp_path).observations[0]
    with pytest.raises(MessageError, match="8 by 4 pixels; the contract has 6 by 4"):
        front.value(image.from_numpy(np.zeros((4, 8, 3), np.uint8), "rgb8"))


@pytest.mark.parametrize(("dtype", "encoding"), [("uint16", "16UC1"), ("float32", "32FC1")])
def test_depths_are_metres(dtype: str, encoding: str) -> None:
    """Cameras give millimetres or metres."""
    read = Contract.from_dict(
        {
            "fps": 30,
            "observations": [
                {
                    "feature": "observation.depth",
                    "topic": "/depth",
                    "type": "sensor_msgs/msg/Image",
                    "image": "depth",
                    "height": 1,
                    "width": 2,
                }
            ],
            "actions": [
                {
                    "feature": "action",
                    "topic": "/cmd_vel",
                    "type": "geometry_msgs/msg/Twist",
                    "fields": ["linear.x"],
                    "stop": "zero",
                }
            ],
        }
    )
    given = np.array([[1500, 0]] if dtype == "uint16" else [[1.5, 0]], dtype)
    depths = read.observations[0].value(image.from_numpy(given, encoding))
    assert depths.tolist() == [[pytest.approx(1.5), 0.0]]


def test_the_time_is_that_of_the_header_or_of_arrival(tmp_path: Path) -> None:
    """A header without a time is one that nobody filled in."""
    front = loaded(tmp_path).observations[0]
    message = Image()
    assert front.time_of(message, 7) == 7
    message.header.stamp = Time(sec=2, nanosec=5)
    assert front.time_of(message, 7) == 2_000_000_005


JOINTS = "sensor_msgs/msg/JointState"
SCAN: dict[str, Any] = {
    "feature": "observation.scan",
    "topic": "/scan",
    "type": "sensor_msgs/msg/LaserScan",
    "fields": ["ranges.0", "ranges.1"],
}


@pytest.mark.parametrize("infinity", [12.0, 0.0])
def test_a_number_may_stand_for_infinity(infinity: float) -> None:
    """A scan has it for a beam that does not return; a mean of both would be no distance."""
    scan = Observation(**SCAN, infinity=infinity)
    assert scan.value(LaserScan(ranges=[1.5, math.inf])).tolist() == [1.5, infinity]
    assert not scan.is_interpolated


@pytest.mark.parametrize("number", [math.nan, -math.inf])
def test_nothing_stands_for_other_numbers_that_are_not_finite(number: float) -> None:
    """A beam that failed, or one that hit something too near, is no free space."""
    scan = Observation(**SCAN, infinity=12.0)
    with pytest.raises(MessageError, match=r"ranges\.1: .*, not finite"):
        scan.value(LaserScan(ranges=[1.5, number]))


def test_a_number_beyond_32_bits_is_not_infinity() -> None:
    """It is a broken message."""
    state = Observation(**SCAN | {"type": JOINTS, "fields": ["position.0"]}, infinity=12.0)
    with pytest.raises(MessageError, match="not finite"):
        state.value(JointState(position=[1e300]))


@pytest.mark.parametrize("infinity", [math.inf, math.nan, 1e300])
def test_what_stands_for_infinity_is_finite(infinity: float) -> None:
    """In 32 bits."""
    with pytest.raises(ValueError, match=r"infinity: .*; use a finite number"):
        Observation(**SCAN, infinity=infinity)


def test_a_zero_is_kept_in_a_contract(tmp_path: Path) -> None:
    """It may be a limit, or replace infinity; a bag has a copy of its contract."""
    given = loaded(tmp_path).to_dict()
    given["observations"][1]["infinity"] = 0.0
    given["actions"][0] |= {"lower": 0.0, "upper": 0.0}
    assert Contract.from_dict(given).to_dict() == given


def test_actions_are_clamped_and_counted(tmp_path: Path) -> None:
    """Limits hold whatever a policy says."""
    action = loaded(tmp_path).actions[0]
    values, clamped = action.clamped(np.array([-3.0, 1.5]))
    assert (values.tolist(), clamped) == ([-1.0, 1.5], 1)
    assert action.message(np.array([-3.0, 1.5])).data.tolist() == [-1.0, 1.5]


@pytest.mark.parametrize("values", [[float("nan"), 0.0], [1.0], [[1.0, 2.0]]])
def test_actions_that_are_no_numbers_are_refused(tmp_path: Path, values: Any) -> None:
    """A policy that diverged."""
    with pytest.raises(ContractError, match=r"use 2 finite numbers: data.0, data.1"):
        loaded(tmp_path).actions[0].message(np.array(values))


TRAJECTORY: dict[str, Any] = {
    "feature": "action",
    "topic": "/arm/trajectory",
    "type": "trajectory_msgs/msg/JointTrajectory",
    "fields": ["points[0].positions.elbow", "points.0.positions.wrist"],
    "template": {"points": [{"time_from_start": {"nanosec": 33_000_000}}]},
    "stop": "hold",
}


def test_a_trajectory_is_filled_with_its_joint_names(tmp_path: Path) -> None:
    """The template has what is not a number of the policy."""
    given = loaded(tmp_path).to_dict() | {"actions": [TRAJECTORY]}
    action = Contract.from_dict(given).actions[0]
    message = action.message(np.array([1.0, 2.0]), Time(sec=9))
    assert message.joint_names == ["elbow", "wrist"]
    assert message.points[0].positions.tolist() == [1.0, 2.0]
    assert message.points[0].time_from_start.nanosec == 33_000_000
    assert message.header.stamp.sec == 9
    assert action.value(message).tolist() == [1.0, 2.0]
    assert action.stop_message() is None
    assert action.stop_message(message) is message


def test_a_feature_may_come_from_several_topics(tmp_path: Path) -> None:
    """Arm and gripper often have topics of their own."""
    given = loaded(tmp_path).to_dict()
    gripper = {
        "feature": "action",
        "topic": "/gripper",
        "type": "std_msgs/msg/Float64",
        "fields": ["data"],
        "names": ["gripper"],
        "stop": {"data": 0.5},
    }
    read = Contract.from_dict(given | {"actions": [*given["actions"], gripper]})
    assert read.features["action"].labels == ("data.0", "data.1", "gripper")
    parts = read.split("action", np.array([1.0, 2.0, 3.0]))
    assert [(entry.topic, part.tolist()) for entry, part in parts] == [
        ("/arm/command", [1.0, 2.0]),
        ("/gripper", [3.0]),
    ]
    assert read.actions[1].stop_message().data == 0.5


def test_numbers_that_are_no_floating_point_numbers_are_held() -> None:
    """Between an open gripper and a closed one there is none."""
    closed = Observation(
        feature="observation.gripper",
        topic="/closed",
        type="std_msgs/msg/Bool",
        fields=("data",),
    )
    assert not closed.is_interpolated
    assert structs.replace(closed, resample="interpolate").is_interpolated
    assert structs.replace(closed, type="std_msgs/msg/Float32").is_interpolated
