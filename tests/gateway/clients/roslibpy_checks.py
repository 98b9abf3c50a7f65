"""The checks of roslibpy as programs use it, against robot.py: ``python roslibpy_checks.py PORT``.

It runs in its own environment, which has roslibpy but not aionode.
"""

from __future__ import annotations

import sys
import threading

import roslibpy

FIBONACCI = "example_interfaces/action/Fibonacci"


class Answers:
    """Waits for the arguments of a callback."""

    def __init__(self) -> None:
        self.values: list[object] = []
        self._arrived = threading.Event()

    def take(self, value: object = None) -> None:
        """Record an answer."""
        self.values.append(value)
        self._arrived.set()

    def first(self) -> object:
        """Return the first answer."""
        assert self._arrived.wait(10), "no answer in 10 s"
        return self.values[0]


def check_topics(ros: roslibpy.Ros) -> None:
    """Messages arrive, and the client's messages reach the robot."""
    answers = Answers()
    topic = roslibpy.Topic(ros, "/chatter", "std_msgs/String")
    topic.subscribe(answers.take)
    topic.publish(roslibpy.Message({"data": "hello"}))
    assert answers.first() == {"data": "hello"}
    topic.unsubscribe()


def check_services(ros: roslibpy.Ros) -> None:
    """Calls are answered, including those that fail; a client may serve."""
    add = roslibpy.Service(ros, "/add_two_ints", "example_interfaces/AddTwoInts")
    assert add.call(roslibpy.ServiceRequest({"a": 1, "b": 2}), timeout=10) == {"sum": 3}
    failed = Answers()
    nothing = roslibpy.Service(ros, "/none", "x/Y")
    nothing.call(roslibpy.ServiceRequest(), Answers().take, failed.take)
    assert "/none" in str(failed.first())
    own = roslibpy.Service(ros, "/own", "std_srvs/Trigger")
    own.advertise(lambda _, response: response.update(success=True) or True)
    while "/own" not in ros.get_services():
        pass
    answers = Answers()
    roslibpy.Service(ros, "/own", "std_srvs/Trigger").call(roslibpy.ServiceRequest(), answers.take)
    assert answers.first() == {"success": True, "message": ""}
    own.unadvertise()


def check_actions(ros: roslibpy.Ros) -> None:
    """A goal has feedback and a result, and can be canceled."""
    client = roslibpy.ActionClient(ros, "/fibonacci", FIBONACCI)
    result, feedback = Answers(), Answers()
    client.send_goal(roslibpy.Goal({"order": 3}), result.take, feedback.take, result.take)
    assert "[0, 1, 1, 2]" in str(result.first())
    assert len(feedback.values) == 2
    canceled, begun = Answers(), Answers()
    goal = client.send_goal(roslibpy.Goal({"order": 50}), canceled.take, begun.take, canceled.take)
    begun.first()
    client.cancel_goal(goal)
    assert "CANCELED" in str(canceled.first())


def check_robot(ros: roslibpy.Ros) -> None:
    """The robot is described; parameters are read and set."""
    assert ros.get_time().secs > 0
    assert "/rosout" in ros.get_topics()
    assert ros.get_topic_type("/listener") == "std_msgs/msg/String"
    assert "/add_two_ints_server" in ros.get_nodes()
    parameter = roslibpy.Param(ros, "/add_two_ints_server:use_sim_time")
    parameter.set(True)
    assert parameter.get() is True
    parameter.set(False)
    assert "/add_two_ints_server:use_sim_time" in ros.get_params()


def main(port: int) -> None:
    """Run all checks."""
    ros = roslibpy.Ros("127.0.0.1", port)
    ros.run()
    for check in (check_topics, check_services, check_actions, check_robot):
        check(ros)
        sys.stdout.write(f"ok      {check.__name__}\n")
        sys.stdout.flush()
    ros.terminate()


if __name__ == "__main__":
    main(int(sys.argv[1]))
