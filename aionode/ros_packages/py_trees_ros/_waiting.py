"""Waiting for servers while a tree is set up."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from py_trees_ros.exceptions import TimedOutError

__all__ = ["wait_for_server"]


def wait_for_server(
    behaviour: Any, wait: Callable[[float], bool], timeout_sec: float, kind: str, name: str
) -> None:
    """Wait for a server, and report the outcome in the log and as the behaviour's feedback.

    Args:
        behaviour: The behaviour that has the client.
        wait: Waits for at most a number of seconds, and returns whether the server is there.
        timeout_sec: Maximum time in seconds; 0 not to wait, and negative to wait again and again,
            with a warning each time.
        kind: ``action`` or ``service``.
        name: The server's name.

    Raises:
        TimedOutError: It does not become available in time.
    """
    log = behaviour.node.get_logger()
    is_there = timeout_sec == 0 or wait(abs(timeout_sec))
    waited_sec = -timeout_sec
    while not is_there and timeout_sec < 0:
        log.warning(
            f"waiting for {kind} server ... [{waited_sec}s][{name}][{behaviour.qualified_name}]"
        )
        is_there = wait(-timeout_sec)
        waited_sec -= timeout_sec
    if not is_there:
        behaviour.feedback_message = f"timed out waiting for the server [{name}]"
        log.error(f"{behaviour.feedback_message}[{behaviour.qualified_name}]")
        raise TimedOutError(behaviour.feedback_message)
    behaviour.feedback_message = f"... connected to {kind} server [{name}]"
    log.info(f"{behaviour.feedback_message}[{behaviour.qualified_name}]")
