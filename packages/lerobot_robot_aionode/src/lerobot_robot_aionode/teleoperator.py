"""Whatever publishes commands, as a teleoperator of LeRobot."""

from __future__ import annotations

import asyncio
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
        self._limits_ns = {
            each.topic: round(contract.max_age(each) * 1e9) for each in contract.actions
        }
        self._actions = contract.actions
        self._newest: dict[str, tuple[int, Any]] = {}
        self._now_ns: Callable[[], int] = int

    async def live(self, node: Node, ready: Callable[[], None]) -> None:
        """Listen."""
        self._now_ns = node.get_clock().now_ns
        for action in {each.topic: each for each in self._actions}.values():
            take = partial(self._take, action.topic)
            topic = self._topics[action.topic]
            node.create_subscription(action.message_type, topic, take, qos_profile_sensor_data)
        ready()
        await asyncio.Event().wait()

    def _take(self, topic: str, message: Any) -> None:
        self._newest[topic] = (self._now_ns(), message)

    def values(self) -> npt.NDArray[Any]:
        """Return the numbers of all commands; without a new one, those of what stops the robot.

        Raises:
            StaleError: nothing was heard of a topic that holds its last command.
        """
        return self.ask(lambda: np.concatenate([self._of(each) for each in self._actions]))

    def _of(self, action: Action) -> npt.NDArray[Any]:
        heard_ns, command = self._newest.get(action.topic, (0, None))
        limit_ns = self._limits_ns[action.topic]
        if command is None or self._now_ns() - heard_ns > limit_ns:
            command = action.stop_message(command)
        if command is None:
            topic = self._topics[action.topic]
            raise StaleError({topic: None}, {topic: limit_ns / 1e9})
        return action.value(command)


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
        """Start a node.

        Raises:
            DeviceAlreadyConnectedError: it is connected.
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
        """Return the newest command; without a new one, what stops the robot.

        Raises:
            DeviceNotConnectedError: it is not connected.
            StaleError: there is nothing to hold yet.
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
