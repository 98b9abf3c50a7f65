"""Waitables: custom entities that executors wait for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar

if TYPE_CHECKING:
    from rclpy._impl.wait_set import WaitSet
    from rclpy.callback_groups import CallbackGroup
    from rclpy.task import Future

__all__ = ["NumberOfEntities", "Waitable"]

T = TypeVar("T")


class NumberOfEntities:
    """The number of handles of each kind that a waitable adds to a wait set."""

    __slots__ = (
        "num_clients",
        "num_events",
        "num_guard_conditions",
        "num_services",
        "num_subscriptions",
        "num_timers",
    )

    def __init__(
        self,
        num_subs: int = 0,
        num_gcs: int = 0,
        num_timers: int = 0,
        num_clients: int = 0,
        num_services: int = 0,
        num_events: int = 0,
    ) -> None:
        self.num_subscriptions = num_subs
        self.num_guard_conditions = num_gcs
        self.num_timers = num_timers
        self.num_clients = num_clients
        self.num_services = num_services
        self.num_events = num_events

    def _counts(self) -> tuple[int, ...]:
        return (
            self.num_subscriptions,
            self.num_guard_conditions,
            self.num_timers,
            self.num_clients,
            self.num_services,
            self.num_events,
        )

    def __add__(self, other: NumberOfEntities) -> NumberOfEntities:
        sums = (a + b for a, b in zip(self._counts(), other._counts(), strict=True))
        return type(self)(*sums)

    def __iadd__(self, other: NumberOfEntities) -> Self:
        for name in self.__slots__:
            setattr(self, name, getattr(self, name) + getattr(other, name))
        return self

    def __repr__(self) -> str:
        return f"<{type(self).__name__}({', '.join(map(str, self._counts()))})>"


class Waitable(Generic[T]):
    """The base class of entities made of handles that an executor waits for.

    Attributes:
        callback_group: Its group.
    """

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        self.callback_group.add_entity(self)
        self._executor_event = False
        self._futures: list[Future[Any]] = []

    def __enter__(self) -> None:
        """Keep its handles in use."""
        raise NotImplementedError("Must be implemented by subclass")

    def __exit__(self, *_: object) -> None:
        """Release its handles."""
        raise NotImplementedError("Must be implemented by subclass")

    def add_future(self, future: Future[Any]) -> None:
        """Make the executor run the done callbacks of `future`."""
        self._futures.append(future)

    def remove_future(self, future: Future[Any]) -> None:
        """Undo `add_future`."""
        self._futures.remove(future)

    def is_ready(self, wait_set: WaitSet) -> bool:
        """Return whether one of its handles is ready."""
        raise NotImplementedError("Must be implemented by subclass")

    def take_data(self) -> T:
        """Take what is ready, so that it is no longer ready."""
        raise NotImplementedError("Must be implemented by subclass")

    async def execute(self, taken_data: T) -> None:
        """Do the work, with the result of `take_data`."""
        raise NotImplementedError("Must be implemented by subclass")

    def get_num_entities(self) -> NumberOfEntities:
        """Return the number of handles that it adds."""
        raise NotImplementedError("Must be implemented by subclass")

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Add its handles."""
        raise NotImplementedError("Must be implemented by subclass")
