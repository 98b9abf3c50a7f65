"""Whatever publishes commands, as a teleoperator of LeRobot."""

from __future__ import annotations

import asyncio
import contextlib
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from lerobot.teleoperators import Teleoperator
from lerobot.utils.errors import DeviceAlreadyConnectedError, DeviceNotConnectedError

from aionode.errors import StaleError
from aionode.learn import Contract
from aionode.qos import qos_profile_sensor_data
from lerobot_robot_aionode.background import Background
from lerobot_robot_aionode.config import AionodeTeleoperatorConfig
from lerobot_robot_aionode.keys import action_keys

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import numpy.typing as npt

    from aionode import Node
    from aionode.learn import Action

__all__ = ["AionodeTeleoperator"]

START_S = 5.0
"""How long the leader may take to be heard at first."""


class Listener(Background):
    """Remembers the newest command for each topic of a contract.

    Args:
        contract: The contract.
        topics: On which topic the commands for a topic of the contract come.
    """

    def __init__(self, contract: Contract, topics: Mapping[str, str]) -> None:
        super().__init__("lerobot_teleoperator")
        self._topics = {
            each.topic: topics.get(each.topic, f"/leader{each.topic}") for each in contract.actions
        }
        self._actions = contract.actions
        self._newest: dict[str, tuple[int, Any]] = {}
        self._heard = asyncio.Event()
        self._now_ns: Callable[[], int] = int

    async def live(self, node: Node, ready: Callable[[], None]) -> None:
        """Listen; it is ready once there is something to hold, wherever the stop is to hold."""
        self._now_ns = node.get_clock().now_ns
        for action in {each.topic: each for each in self._actions}.values():
            take = partial(self._take, action.topic)
            topic = self._topics[action.topic]
            node.create_subscription(action.message_type, topic, take, qos_profile_sensor_data)
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(START_S):
                while self._silent():
                    self._heard.clear()
                    await self._heard.wait()
        if silent := self._silent():
            raise StaleError(dict.fromkeys(silent), {})
        ready()
        await asyncio.Event().wait()

    def _silent(self) -> list[str]:
        """Return the topics without which there would be nothing to send."""
        return [
            self._topics[each.topic]
            for each in self._actions
            if each.topic not in self._newest and each.stop_message() is None
        ]

    def _take(self, topic: str, message: Any) -> None:
        self._newest[topic] = (self._now_ns(), message)
        self._heard.set()

    def values(self) -> npt.NDArray[Any]:
        """Return the numbers of all commands, as the robot gets them."""

        async def values() -> npt.NDArray[Any]:
            return np.concatenate([self._of(each) for each in self._actions])

        return self.ask(values)

    def _of(self, action: Action) -> npt.NDArray[Any]:
        heard_ns, command = self._newest.get(action.topic, (0, None))
        if command is None or self._now_ns() - heard_ns > action.lease_sec * 1e9:
            command = action.stop_message(command)
        inside, _ = action.clamped(action.value(command))  # LeRobot records what comes from here
        return inside


class AionodeTeleoperator(Teleoperator):
    """A leader arm, a gamepad, a keyboard, a page: whatever publishes commands of the contract."""

    config_class = AionodeTeleoperatorConfig
    name = "aionode"

    def __init__(self, config: AionodeTeleoperatorConfig) -> None:
        super().__init__(config)
        self.config = config
        self.contract = Contract.load(config.contract)
        self._listener: Listener | None = None

    @property
    def action_features(self) -> dict[str, Any]:
        """A float for each number."""
        return dict.fromkeys(action_keys(self.contract), float)

    @property
    def feedback_features(self) -> dict[str, Any]:
        """None."""
        return {}

    @property
    def is_connected(self) -> bool:
        """Whether its node runs."""
        return self._listener is not None and self._listener.is_running

    def connect(self, calibrate: bool = True) -> None:  # noqa: ARG002  # as LeRobot has it
        """Start a node, and wait for the leader's first command if the stop is to hold it.

        Raises:
            DeviceAlreadyConnectedError: it is connected.
            StaleError: the leader was not heard within 5 s.
        """
        if self.is_connected:
            raise DeviceAlreadyConnectedError(f"{self} is already connected.")
        listener = Listener(self.contract, self.config.topics)
        listener.start()
        self._listener = listener

    @property
    def is_calibrated(self) -> bool:
        """Always."""
        return True

    def calibrate(self) -> None:
        """Do nothing."""

    def configure(self) -> None:
        """Do nothing."""

    def get_action(self) -> dict[str, Any]:
        """Return the newest command; without a new one for `lease_sec`, what stops the robot.

        It is within the limits of the contract: LeRobot records it as it is.

        Raises:
            DeviceNotConnectedError: it is not connected.
            ContractError: a number of the command is not finite.
            MessageError: the command lacks a number (a ValueError).
        """
        values = self._connected().values()
        return dict(zip(action_keys(self.contract), values.tolist(), strict=True))

    def send_feedback(self, feedback: dict[str, Any]) -> None:
        """Do nothing."""

    def disconnect(self) -> None:
        """End the node.

        Raises:
            DeviceNotConnectedError: it is not connected.
        """
        listener, self._listener = self._connected(), None
        listener.stop()

    def _connected(self) -> Listener:
        if self._listener is None:
            raise DeviceNotConnectedError(f"{self} is not connected. Run `.connect()` first.")
        return self._listener
