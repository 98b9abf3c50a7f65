"""A ROS 2 robot as LeRobot sees it."""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from lerobot.robots import Robot
from lerobot.utils.errors import DeviceAlreadyConnectedError, DeviceNotConnectedError

from aionode.errors import LeaseExpiredError
from aionode.learn import Contract
from lerobot_robot_aionode.background import Background
from lerobot_robot_aionode.config import AionodeRobotConfig
from lerobot_robot_aionode.defects.one_action import let_one_action_drive
from lerobot_robot_aionode.keys import ACTION, action_keys, flat, observation_keys

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy.typing as npt

    from aionode import Node
    from aionode.learn import Action, Observations

__all__ = ["AionodeRobot"]


class Driver(Background):
    """Observes a robot and sends its actions.

    A pause of LeRobot's loop, as between two episodes, ends the lease: the robot stands still until
    the next action, which takes a new one.
    """

    def __init__(self, contract: Contract) -> None:
        super().__init__("lerobot_robot")
        self._contract = contract
        self._observations: Observations | None = None
        self._next: npt.NDArray[np.float64] | None = None
        self._has_next = asyncio.Event()

    def observe(self) -> dict[str, Any]:
        """Return the next observation that LeRobot has not had."""
        return flat(self._contract, self.ask(self._observed))

    async def _observed(self) -> dict[str, Any]:
        assert self._observations is not None  # noqa: S101  # it is ready
        async with contextlib.aclosing(self._observations.at()) as observations:
            return (await anext(observations)).values

    def send(self, action: npt.NDArray[np.float64]) -> None:
        """Send an action."""

        async def put() -> None:
            self._next = action
            self._has_next.set()

        self.ask(put)

    async def live(self, node: Node, ready: Callable[[], None]) -> None:
        """Observe and send."""
        async with self._contract.observe(node) as self._observations:
            await self._observed()
            ready()
            while True:
                await self._has_next.wait()
                try:
                    await self._drive(node)
                except LeaseExpiredError as error:
                    node.get_logger().info(f"the next action moves the robot again: {error}")

    async def _drive(self, node: Node) -> None:
        async with self._contract.act(node) as actor:
            while True:
                await self._has_next.wait()
                self._has_next.clear()
                assert self._next is not None  # noqa: S101  # set before the event
                actor.send(self._next)


class AionodeRobot(Robot):
    """Any ROS 2 robot that a contract describes."""

    config_class = AionodeRobotConfig
    name = "aionode"

    def __init__(self, config: AionodeRobotConfig) -> None:
        super().__init__(config)
        self.config = config
        self.contract = Contract.load(config.contract)
        self.cameras = {
            key: shape for key, shape in self.observation_features.items() if shape is not float
        }
        self._driver: Driver | None = None

    @property
    def observation_features(self) -> dict[str, Any]:
        """A float for each number, the shape of each picture."""
        return observation_keys(self.contract)

    @property
    def action_features(self) -> dict[str, Any]:
        """A float for each number."""
        return dict.fromkeys(action_keys(self.contract), float)

    @property
    def is_connected(self) -> bool:
        """Whether its node runs."""
        return self._driver is not None and self._driver.is_running

    def connect(self, calibrate: bool = True) -> None:  # noqa: ARG002  # as LeRobot has it
        """Start a node, and wait for the first observation.

        Raises:
            DeviceAlreadyConnectedError: it is connected.
            StaleError: a topic of the contract was not heard within 5 s, or is too old.
        """
        if self.is_connected:
            raise DeviceAlreadyConnectedError(f"{self} is already connected.")
        if len(action_keys(self.contract)) == 1:
            let_one_action_drive()
        driver = Driver(self.contract)
        driver.start()
        self._driver = driver

    @property
    def is_calibrated(self) -> bool:
        """Always: the robot's own driver does it."""
        return True

    def calibrate(self) -> None:
        """Do nothing."""

    def configure(self) -> None:
        """Do nothing."""

    def get_observation(self) -> dict[str, Any]:
        """Return the newest observation.

        Raises:
            DeviceNotConnectedError: it is not connected.
            StaleError: something is older than the contract allows.
        """
        return self._connected().observe()

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Send an action, and return what was sent: within the limits of the contract.

        Raises:
            DeviceNotConnectedError: it is not connected.
            ContractError: a number is not finite.
            KeyError: a number is missing.
        """
        driver = self._connected()
        keys = action_keys(self.contract)
        values = np.array([float(action[key]) for key in keys])
        parts = self.contract.split(ACTION, values)
        inside = np.concatenate([cast("Action", entry).clamped(part)[0] for entry, part in parts])
        driver.send(inside)
        return dict(zip(keys, inside.tolist(), strict=True))

    def disconnect(self) -> None:
        """Stop the robot, and end the node.

        Raises:
            DeviceNotConnectedError: it is not connected.
        """
        driver, self._driver = self._connected(), None
        driver.stop()

    def _connected(self) -> Driver:
        if self._driver is None:
            raise DeviceNotConnectedError(f"{self} is not connected. Run `.connect()` first.")
        return self._driver
