"""LeRobot's plugin, by stubs with the signatures of LeRobot 0.6: ``make lerobot`` has the real one.

The robot is a node of another context, as its process would be.
"""

from __future__ import annotations

import asyncio
import copy
import importlib
import math
import sys
import threading
import types
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from aionode import Context, Node
from aionode.errors import ContractError, MessageError, StaleError
from aionode.image import from_numpy
from aionode.interfaces.sensor_msgs.msg import Image, JointState
from aionode.interfaces.std_msgs.msg import Float64MultiArray
from aionode.learn import Contract
from tests.learn.lerobot_stubs import described, differences

ROOT = Path(__file__).parents[2]

CONTRACT: dict[str, Any] = {
    "fps": 30,
    "observations": [
        {
            "feature": "observation.images.front",
            "topic": "/camera",
            "type": "sensor_msgs/msg/Image",
            "image": "color",
            "height": 4,
            "width": 6,
            "max_age": 1.0,
        },
        {
            "feature": "observation.state",
            "topic": "/joint_states",
            "type": "sensor_msgs/msg/JointState",
            "fields": ["position.shoulder", "velocity.shoulder"],
            "names": ["shoulder", "shoulder.vel"],
            "unit": "rad",
            "max_age": 1.0,
        },
    ],
    "actions": [
        {
            "feature": "action",
            "topic": "/arm/command",
            "type": "std_msgs/msg/Float64MultiArray",
            "fields": ["data.0"],
            "names": ["shoulder"],
            "unit": "rad/s",
            "lower": -1.0,
            "upper": 1.0,
            "stop": "zero",
        }
    ],
}


@pytest.fixture
def plugin(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    """The plugin beside the stubs; and its contract in a file."""
    before = set(sys.modules)
    monkeypatch.syspath_prepend(ROOT / "packages" / "lerobot_robot_aionode" / "src")
    monkeypatch.syspath_prepend(ROOT / "tests" / "learn" / "stubs")
    (tmp_path / "contract.yaml").write_text(yaml.safe_dump(CONTRACT))
    monkeypatch.chdir(tmp_path)
    yield importlib.import_module("lerobot_robot_aionode")
    for name in set(sys.modules) - before:
        if name.partition(".")[0] in {"lerobot", "lerobot_robot_aionode"}:
            del sys.modules[name]


class Arm:
    """A robot, what it got, and a leader."""

    def __init__(self, node: Node) -> None:
        self.node = node
        self.got: list[float] = []
        self.shown = 0
        self.changed = asyncio.Event()
        self.camera = node.create_publisher(Image, "/camera", 1)
        self.joints = node.create_publisher(JointState, "/joint_states", 1)
        self.leader = node.create_publisher(Float64MultiArray, "/leader/arm/command", 1)
        self.timer = node.create_timer(1 / 30, self.show)
        node.create_subscription(Float64MultiArray, "/arm/command", self.take, 10)

    def show(self) -> None:
        """Publish a picture and the joint."""
        stamp = self.node.get_clock().now().to_msg()
        state = JointState(name=["shoulder"], position=[0.5], velocity=[0.25])
        state.header.stamp = stamp
        self.joints.publish(state)
        self.shown += 1
        picture = from_numpy(np.full((4, 6, 3), self.shown % 250, np.uint8), "rgb8")
        picture.header.stamp = stamp
        self.camera.publish(picture)

    def take(self, command: Float64MultiArray) -> None:
        """Note a command."""
        self.got.append(float(command.data[0]))
        self.changed.set()

    async def until(self, condition: Callable[[], bool]) -> None:
        """Wait until what it got fulfils a condition."""
        async with asyncio.timeout(20):
            while not condition():
                self.changed.clear()
                await self.changed.wait()


@pytest.fixture
async def arm() -> AsyncIterator[Arm]:
    """A robot that shows something thirty times a second."""
    async with Context() as context, Node("arm", context=context) as node:
        yield Arm(node)


def made(plugin: Any, kind: str = "Robot", **options: Any) -> Any:
    """Return a device as LeRobot makes it: by the type of its configuration."""
    module = importlib.import_module(f"lerobot.{kind.lower()}s")
    known = getattr(module, f"{kind}Config").known
    config = known["aionode"](contract="contract.yaml", **options)
    return getattr(module, f"make_{kind.lower()}_from_config")(config)


def test_lerobot_finds_its_devices_by_name(plugin: Any) -> None:
    """By the type that is written on the command line, and by the name of the configuration."""
    assert isinstance(made(plugin), plugin.AionodeRobot)
    assert isinstance(made(plugin, "Teleoperator"), plugin.AionodeTeleoperator)


def test_features_are_known_before_it_is_connected(plugin: Any) -> None:
    """LeRobot makes the data set from them; its rollout takes only keys of these two endings."""
    robot = made(plugin)
    assert robot.observation_features == {
        "front": (4, 6, 3),
        "shoulder.pos": float,
        "shoulder.vel": float,
    }
    assert robot.action_features == {"shoulder.vel": float}
    assert len(robot.cameras) == 1
    assert not robot.is_connected


async def test_a_loop_of_lerobot_drives_a_robot(plugin: Any, arm: Arm) -> None:
    """As `record_loop` does: observe, ask the teleoperator, send."""

    def record() -> list[dict[str, Any]]:
        seen = []
        with made(plugin) as robot, made(plugin, "Teleoperator") as teleop:
            for _ in range(10):
                observation = robot.get_observation()
                sent = robot.send_action({**teleop.get_action(), "shoulder.vel": 9.0})
                seen.append({**observation, "sent": sent})
                threading.Event().wait(1 / 30)
        return seen

    rows = await asyncio.to_thread(record)

    assert all(row["shoulder.pos"] == 0.5 and row["shoulder.vel"] == 0.25 for row in rows)
    assert all(row["front"].shape == (4, 6, 3) for row in rows)
    assert all(row["front"].flags.writeable for row in rows)
    assert all(row["sent"] == {"shoulder.vel": 1.0} for row in rows)
    await arm.until(lambda: arm.got[-1:] == [0.0])
    assert set(arm.got) == {1.0, 0.0}


async def test_each_picture_is_observed_once(plugin: Any, arm: Arm) -> None:
    """However fast LeRobot's loop is: a picture that is there twice teaches to wait."""

    def record() -> list[int]:
        with made(plugin) as robot:
            return [int(robot.get_observation()["front"].max()) for _ in range(8)]

    pictures = await asyncio.to_thread(record)
    assert len(set(pictures)) == 8


async def test_a_pause_stops_the_robot_and_the_next_action_moves_it(plugin: Any, arm: Arm) -> None:
    """LeRobot encodes videos between two episodes, and sends nothing meanwhile."""
    robot = made(plugin)
    await asyncio.to_thread(robot.connect)
    try:
        await asyncio.to_thread(robot.send_action, {"shoulder.vel": 0.5})
        await arm.until(lambda: arm.got == [0.5, 0.0])
        await asyncio.to_thread(robot.send_action, {"shoulder.vel": 0.25})
        await arm.until(lambda: arm.got[:3] == [0.5, 0.0, 0.25])
    finally:
        await asyncio.to_thread(robot.disconnect)
    assert not robot.is_connected


async def test_a_command_that_is_no_number_is_refused(plugin: Any, arm: Arm) -> None:
    """A policy that diverged."""
    robot = made(plugin)
    await asyncio.to_thread(robot.connect)
    try:
        with pytest.raises(ContractError):
            await asyncio.to_thread(robot.send_action, {"shoulder.vel": math.nan})
        with pytest.raises(KeyError):
            await asyncio.to_thread(robot.send_action, {"elbow.vel": 0.0})
    finally:
        await asyncio.to_thread(robot.disconnect)


async def test_a_camera_that_freezes_is_an_error(plugin: Any, arm: Arm) -> None:
    """LeRobot would record the same picture on and on."""
    robot = made(plugin)
    await asyncio.to_thread(robot.connect)
    try:
        arm.timer.cancel()
        await arm.node.get_clock().sleep(1.2)
        with pytest.raises(StaleError, match="/camera"):
            await asyncio.to_thread(robot.get_observation)
    finally:
        await asyncio.to_thread(robot.disconnect)


async def test_a_node_that_has_ended_is_an_error_that_says_why(plugin: Any, arm: Arm) -> None:
    """A command that does not fit its field ends it, and LeRobot's loop would hang."""
    action = {**CONTRACT["actions"][0], "type": "std_msgs/msg/Int8", "fields": ["data"]}
    contract = {**CONTRACT, "actions": [{**action, "topic": "/gear", "lower": -1e9, "upper": 1e9}]}
    Path("contract.yaml").write_text(yaml.safe_dump(contract))
    robot = made(plugin)
    await asyncio.to_thread(robot.connect)
    await asyncio.to_thread(robot.send_action, {"shoulder.vel": 300.0})

    def observe() -> None:
        while True:
            robot.get_observation()

    with pytest.raises(ConnectionError) as caught:
        await asyncio.to_thread(observe)
    assert "its node has ended; connect again" in str(caught.value)
    assert isinstance(caught.value.__cause__, MessageError)
    assert not robot.is_connected
    await asyncio.to_thread(robot.disconnect)


async def test_a_teleoperator_has_the_commands_of_a_leader(plugin: Any, arm: Arm) -> None:
    """The newest one, within the limits, as LeRobot records it; in silence, a stop."""
    teleop = made(plugin, "Teleoperator")
    await asyncio.to_thread(teleop.connect)
    try:
        assert await asyncio.to_thread(teleop.get_action) == {"shoulder.vel": 0.0}
        await arm.leader.wait_for_subscribers()
        async with asyncio.timeout(20):
            arm.leader.publish(Float64MultiArray(data=[7.5]))
            while await asyncio.to_thread(teleop.get_action) != {"shoulder.vel": 1.0}:
                arm.leader.publish(Float64MultiArray(data=[7.5]))  # a command soon expires
            while await asyncio.to_thread(teleop.get_action) != {"shoulder.vel": 0.0}:
                pass
    finally:
        await asyncio.to_thread(teleop.disconnect)


async def test_a_teleoperator_that_holds_waits_for_its_leader(plugin: Any, arm: Arm) -> None:
    """There is nothing to hold before, and LeRobot asks as soon as it is connected."""
    contract = {**CONTRACT, "actions": [{**CONTRACT["actions"][0], "stop": "hold"}]}
    Path("contract.yaml").write_text(yaml.safe_dump(contract))
    teleop = made(plugin, "Teleoperator")
    timer = arm.node.create_timer(
        1 / 30, lambda: arm.leader.publish(Float64MultiArray(data=[0.75]))
    )
    await asyncio.to_thread(teleop.connect)
    try:
        timer.cancel()
        assert await asyncio.to_thread(teleop.get_action) == {"shoulder.vel": 0.75}
    finally:
        await asyncio.to_thread(teleop.disconnect)


async def test_a_rollout_may_have_one_action(
    plugin: Any, arm: Arm, monkeypatch: pytest.MonkeyPatch
) -> None:
    """LeRobot 0.6 takes the dimension of the batch off twice, and indexes what is left."""

    def make_robot_action(action: Any, features: dict[str, Any]) -> dict[str, float]:
        squeezed = action.squeeze(0)
        return {name: float(squeezed[index]) for index, name in enumerate(features["names"])}

    module = types.ModuleType("lerobot.rollout.inference.sync")
    vars(module)["make_robot_action"] = make_robot_action
    monkeypatch.setitem(sys.modules, module.__name__, module)
    robot = made(plugin)
    await asyncio.to_thread(robot.connect)
    await asyncio.to_thread(robot.disconnect)
    for action in ([0.5], [0.5, 0.25]):  # the same for several
        names = ["shoulder", "elbow"][: len(action)]
        given = vars(module)["make_robot_action"](np.array(action), {"names": names})
        assert given == dict(zip(names, action, strict=True))


def test_a_device_that_is_not_connected_says_so(plugin: Any) -> None:
    """By LeRobot's own error."""
    errors = importlib.import_module("lerobot.utils.errors")
    for device, ask in (
        (made(plugin), "get_observation"),
        (made(plugin, "Teleoperator"), "get_action"),
    ):
        with pytest.raises(errors.DeviceNotConnectedError):
            getattr(device, ask)()


def test_two_numbers_of_one_name_are_refused(plugin: Any) -> None:
    """LeRobot has one flat dict for all topics."""
    keys = importlib.import_module("lerobot_robot_aionode.keys")
    twice = {
        **CONTRACT["observations"][1],
        "topic": "/other",
        "fields": ["position.shoulder"],
        "names": ["shoulder.pos"],
    }
    contract = Contract.from_dict({**CONTRACT, "observations": [*CONTRACT["observations"], twice]})
    with pytest.raises(ValueError, match=r"shoulder.pos occurs twice"):
        keys.observation_keys(contract)


@pytest.mark.parametrize(
    ("group", "name", "wanted"),
    [
        ("observations", "observation.joints", "observation.state"),
        ("observations", "front", "observation.images.NAME"),
        ("actions", "action.arm", "action"),
    ],
)
def test_a_feature_that_lerobot_would_rename_is_refused(
    plugin: Any, group: str, name: str, wanted: str
) -> None:
    """A policy trained on the export of the same contract would look for it in vain."""
    contract = copy.deepcopy(CONTRACT)
    contract[group][-1 if wanted != "observation.images.NAME" else 0]["feature"] = name
    Path("contract.yaml").write_text(yaml.safe_dump(contract))
    with pytest.raises(ValueError, match=rf"^{name}: LeRobot's loops call it {wanted}"):
        _ = made(plugin).action_features


def test_stubs_that_differ_from_lerobot_are_told(plugin: Any) -> None:
    """These tests rely on what `make lerobot` compares with the real one."""
    stubs = described()
    assert differences(stubs, stubs) == []
    real = copy.deepcopy(stubs)
    robot = real["lerobot.robots.Robot"]["members"]
    robot["reset"] = {"parameters": {}, "abstract": True}
    del robot["calibrate"]
    robot["connect"]["parameters"]["port"] = ["POSITIONAL_OR_KEYWORD", False]
    robot["send_action"]["parameters"]["wait"] = ["KEYWORD_ONLY", True]
    real["lerobot.robots.make_robot_from_config"] = None
    places = [each.partition(": ")[0] for each in differences(stubs, real)]
    assert places == [
        "lerobot.robots.Robot.calibrate",
        "lerobot.robots.Robot.reset",
        "lerobot.robots.Robot.connect",
        "lerobot.robots.make_robot_from_config",
    ]
