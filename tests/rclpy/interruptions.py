"""rclpy programs that signals and finalizers interrupt: ``interruptions.py name``.

Each prints a line of JSON, which `test_interruptions.py` checks. They run in separate processes,
because signal handlers belong to the main thread, and a hang must not affect anything else.
"""

from __future__ import annotations

import gc
import json
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from time import monotonic
from types import FrameType
from typing import Any

from rcl_interfaces.srv import ListParameters
from std_msgs.msg import Int32

import rclpy
from rclpy._impl import uninterrupted
from rclpy._impl.errors import RCLError
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

PATIENCE_S = 10.0
PUBLISHED = 10_000
MANY_PLACES = 10
OWN_CODE = ("aionode/ros_packages", "aionode/_process/lendable_loop", "aionode/engine/")


class Interrupted(Exception):  # noqa: N818  # no error of the program
    """Raised by a handler."""


@contextmanager
def alarms(interval_s: float, handler: Callable[[int, Any], object]) -> Iterator[None]:
    """Call a handler repeatedly, each time some time after it has returned."""
    is_over = False

    def call(number: int, frame: FrameType | None) -> None:
        handler(number, frame)
        if not is_over:
            signal.setitimer(signal.ITIMER_REAL, interval_s)

    before = signal.signal(signal.SIGALRM, call)
    signal.setitimer(signal.ITIMER_REAL, interval_s)
    try:
        yield
    finally:
        is_over = True  # first: a call that is due runs after the next line
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@contextmanager
def server(name: str) -> Iterator[None]:
    """Serve requests in another context, over a link, and in another thread."""
    context = rclpy.Context()
    rclpy.init(context=context)
    node = rclpy.create_node(name, context=context)
    node.create_service(ListParameters, "ask", lambda request, response: response)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    thread = threading.Thread(target=spin, args=(executor,))
    thread.start()
    try:
        yield
    finally:
        context.shutdown()
        thread.join()


def spin(executor: SingleThreadedExecutor) -> None:
    """Spin until the context is shut down."""
    with suppress(rclpy.executors.ExternalShutdownException):
        executor.spin()


class Robot:
    """A node that publishes, listens to itself, and asks a server of another context."""

    def __init__(self) -> None:
        self.node = rclpy.create_node("robot")
        self.commands = self.node.create_publisher(Int32, "commands", 10)
        self.stops = self.node.create_publisher(Int32, "stops", 10)
        self.heard: list[int] = []
        self.node.create_subscription(Int32, "commands", lambda msg: self.heard.append(msg.data), 1)
        self.client = self.node.create_client(ListParameters, "ask")
        self.sent = 0

    def publish(self) -> int:
        """Publish the next command, and return its number."""
        self.sent += 1
        self.commands.publish(Int32(data=self.sent))
        return self.sent

    def is_well(self) -> bool:
        """Return whether a message and an answer arrive as if nothing had happened."""
        number = self.publish()
        ends_s = monotonic() + PATIENCE_S
        while number not in self.heard[-1:]:
            rclpy.spin_once(self.node, timeout_sec=0.1)
            if monotonic() > ends_s:
                return False
        return self.answers()

    def answers(self) -> bool:
        """Return whether the server answers."""
        try:
            return self.client.call(ListParameters.Request(), timeout_sec=PATIENCE_S) is not None
        except TimeoutError:
            return False


# Handlers that do something


def publishes() -> dict[str, Any]:
    """Publish in a handler while the main thread publishes."""
    robot = Robot()
    calls: list[None] = []

    def handler(number: int, frame: FrameType | None) -> None:
        calls.append(None)
        robot.stops.publish(Int32())

    with alarms(0.0005, handler):
        for _ in range(PUBLISHED):
            robot.publish()
    return {
        "handled": len(calls) > 10,
        "stops": robot.stops.handle.bare.published == len(calls),
        "commands": robot.commands.handle.bare.published,
    }


def asks() -> dict[str, Any]:
    """Call a server in a handler, while the main thread publishes, and while it spins."""
    robot = Robot()
    answers: list[bool] = []
    with server("asked"):
        robot.client.wait_for_service()

        def handler(number: int, frame: FrameType | None) -> None:
            answers.append(robot.answers())

        with alarms(0.02, handler):
            while len(answers) < 10:
                robot.publish()
            while len(answers) < 20:
                rclpy.spin_once(robot.node, timeout_sec=0.1)
    return {"answers": all(answers)}


def makes_entities() -> dict[str, Any]:
    """Create and destroy entities in a handler, while the main thread does that and publishes."""
    robot = Robot()
    made: list[None] = []

    def make() -> None:
        node = robot.node
        publisher = node.create_publisher(Int32, "commands", 10)
        subscription = node.create_subscription(Int32, "commands", lambda _: None, 10)
        publisher.publish(Int32())
        node.destroy_subscription(subscription)
        node.destroy_publisher(publisher)
        made.append(None)

    with alarms(0.01, lambda number, frame: make()):
        while len(made) < 60:
            robot.publish()
            make()
            rclpy.spin_once(robot.node, timeout_sec=0)
    return {"left": [len([*robot.node.publishers]), len([*robot.node.subscriptions])]}


# Something at each place where a handler may be called


class Interruption:
    """Does something at one place of the program: at the n-th call, or return of a C function.

    Those are the places at which Python calls signal handlers.
    """

    def __init__(self, place: int, action: Callable[[], object]) -> None:
        self.left = place
        self.action = action
        self.done = False

    def __enter__(self) -> None:
        sys.setprofile(self._count)

    def __exit__(self, *_: object) -> None:
        sys.setprofile(None)

    def _count(self, frame: FrameType, event: str, arg: object) -> None:
        if event not in {"call", "c_return"}:
            return
        if not any(part in frame.f_code.co_filename for part in OWN_CODE):
            return
        self.left -= 1
        if self.left == 0:
            sys.setprofile(None)
            self.done = True
            self.action()


def interrupt_everywhere(
    robot: Robot, work: Callable[[], object], action: Callable[[], object]
) -> str:
    """Do `work` until it was interrupted at each of its places.

    Returns:
        After which place nothing was heard or answered any more; or that all was well.
    """
    place = 0
    while True:
        place += 1
        interruption = Interruption(place, action)
        with suppress(Interrupted), interruption:
            work()
        if not interruption.done:
            return f"well at {MANY_PLACES} places" if place > MANY_PLACES else f"{place} places"
        if not robot.is_well():
            return f"sick after place {place}"


def fail(number: int, frame: FrameType | None) -> None:
    """Raise, like handlers of programs."""
    raise Interrupted


def fail_later(number: int, frame: FrameType | None) -> None:
    """Raise like rclpy's handler of Ctrl-C: except where an exception does harm."""
    if not uninterrupted.postpone(partial(fail_later, number, None)):
        raise Interrupted


def with_a_raising_handler(handler: Callable[[int, Any], object]) -> dict[str, Any]:
    """Let a handler raise at each place."""
    if handler is fail_later:
        uninterrupted.own_handlers.add(handler)
    before = signal.signal(signal.SIGUSR1, handler)
    raises = partial(signal.raise_signal, signal.SIGUSR1)
    try:
        return interrupt_everything(raises)
    finally:
        signal.signal(signal.SIGUSR1, before)


def with_a_finalizer(does: str) -> dict[str, Any]:
    """Let a finalizer publish, or call, at each place."""
    robots: list[Robot] = []

    class Dropped:
        def __init__(self) -> None:
            self.itself = self

        def __del__(self) -> None:
            if does == "publish":
                robots[-1].stops.publish(Int32())
            else:
                with suppress(RCLError):
                    robots[-1].client.call(ListParameters.Request(), timeout_sec=PATIENCE_S)

    def drop() -> None:
        Dropped()
        gc.collect()

    gc.collect()
    gc.freeze()
    gc.disable()
    return interrupt_everything(drop, robots)


def interrupt_everything(
    action: Callable[[], object], robots: list[Robot] | None = None
) -> dict[str, Any]:
    """Interrupt a program at each place; return the kinds of work that went wrong, and where."""
    robot = Robot()
    if robots is not None:
        robots.append(robot)
    with server("asked"):
        robot.client.wait_for_service()
        return {
            "publish": interrupt_everywhere(robot, robot.publish, action),
            "spin": interrupt_everywhere(
                robot, partial(rclpy.spin_once, robot.node, timeout_sec=0.005), action
            ),
            "ask": interrupt_everywhere(robot, robot.answers, action),
        }


PROGRAMS: dict[str, Callable[[], dict[str, Any]]] = {
    "publishes": publishes,
    "asks": asks,
    "makes_entities": makes_entities,
    "raises": partial(with_a_raising_handler, fail),
    "puts_itself_off": partial(with_a_raising_handler, fail_later),
    "finalizer_publishes": partial(with_a_finalizer, "publish"),
    "finalizer_asks": partial(with_a_finalizer, "ask"),
}


if __name__ == "__main__":
    rclpy.init(signal_handler_options=SignalHandlerOptions.ALL)
    result = PROGRAMS[sys.argv[1]]()
    rclpy.shutdown()
    print(json.dumps(result), flush=True)  # noqa: T201  # a program prints
