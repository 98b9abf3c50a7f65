"""`py_trees_ros`: behaviours on nodes of rclpy, and trees that other programs watch."""

from __future__ import annotations

import operator
import re
import threading
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import pytest

py_trees = pytest.importorskip("py_trees")

import rclpy  # noqa: E402  # after what may be missing
from py_trees_ros import (  # noqa: E402
    action_clients,
    battery,
    blackboard,
    conversions,
    exceptions,
    publishers,
    service_clients,
    subscribers,
    transforms,
    trees,
    utilities,
)
from py_trees_ros.mock.dock import Dock  # noqa: E402
from py_trees_ros.programs import blackboard_watcher  # noqa: E402
from rclpy.executors import MultiThreadedExecutor  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402
from rosidl_generator_py import action_class, message_class, service_class  # noqa: E402
from tests.support.peers import isolated_environment  # noqa: E402

if TYPE_CHECKING:
    from pathlib import Path

Status: Any = py_trees.common.Status
Policy: Any = py_trees.common.ClearingPolicy
Board: Any = py_trees.blackboard.Blackboard
String = message_class("std_msgs/msg/String")
DockAction = action_class("py_trees_ros_interfaces/action/Dock")
SetBool = service_class("std_srvs/srv/SetBool")
Battery = message_class("sensor_msgs/msg/BatteryState")
Transform = message_class("geometry_msgs/msg/Transform")
Snapshot = message_class("py_trees_ros_interfaces/msg/BehaviourTree")
UNLATCHED = utilities.qos_profile_unlatched()


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A node of rclpy, without other participants, and an empty blackboard."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    Board.clear()
    Board.clients.clear()
    rclpy.init(args=[])
    yield rclpy.create_node("robot")
    rclpy.try_shutdown()


@pytest.fixture
def executor(node: Any) -> Iterator[Any]:
    """An executor of the node that runs servers beside clients."""
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    yield executor
    executor.shutdown()


def spin(executor: Any, until: Callable[[], bool]) -> None:
    """Run callbacks until something is so; the test's time limit ends it otherwise."""
    while not until():
        executor.spin_once(timeout_sec=0.05)


def set_up(behaviour: Any, node: Any) -> Any:
    """Return a behaviour that is set up."""
    behaviour.setup(node=node)
    return behaviour


def tick(behaviour: Any) -> Any:
    """Tick a behaviour once, and return its status."""
    behaviour.tick_once()
    return behaviour.status


def hear(behaviour: Any, *messages: Any) -> None:
    """Give messages to a subscriber, as its subscription does."""
    for message in messages:
        behaviour._callback(message)


class Waiting:
    """A server of the action `dock` that answers a goal when the test says so."""

    def __init__(self, node: Any) -> None:
        self.accept = threading.Event()
        self.executing: list[Any] = []
        self.cancelled: list[Any] = []
        self.node = node
        self.ended = threading.Event()
        self.server: Any = rclpy.action.ActionServer(
            node,
            DockAction,
            "dock",
            self.execute,
            goal_callback=self.decide,
            cancel_callback=lambda _: rclpy.action.CancelResponse.ACCEPT,
            callback_group=rclpy.callback_groups.ReentrantCallbackGroup(),
        )

    def decide(self, goal: Any) -> Any:
        """Accept a goal, when the test says so."""
        self.accept.wait()
        return rclpy.action.GoalResponse.ACCEPT

    def execute(self, handle: Any) -> Any:
        """Succeed with a goal to dock; wait with another one until it is cancelled."""
        self.executing.append(handle)
        while not handle.is_cancel_requested:
            if handle.request.dock:
                handle.succeed()
                return DockAction.Result()
            if self.ended.wait(0.01):
                return DockAction.Result()
        handle.canceled()
        self.cancelled.append(handle)
        return DockAction.Result()


def docking(node: Any, *, dock: bool = True) -> Any:
    """Return a behaviour that sends a goal."""
    return set_up(
        action_clients.FromConstant(
            "dock",
            DockAction,
            "dock",
            DockAction.Goal(dock=dock),
            generate_feedback_message=lambda msg: f"{msg.feedback.percentage_completed:.0f}",
        ),
        node,
    )


def test_a_goal_runs_until_its_end(node: Any, executor: Any) -> None:
    """As in the tutorials: the behaviour runs, shows feedback, and succeeds."""
    server = Dock(duration=0.5)
    executor.add_node(server.node)
    behaviour = docking(node)
    shown = set()

    def is_over() -> bool:
        shown.add(behaviour.feedback_message)
        return tick(behaviour) is not Status.RUNNING

    spin(executor, is_over)

    assert behaviour.status is Status.SUCCESS
    assert behaviour.feedback_message == "successfully completed"
    assert "feedback: 67" in shown
    server.shutdown()


def test_a_goal_is_cancelled_when_the_behaviour_is_interrupted(node: Any, executor: Any) -> None:
    """A higher priority takes over: the robot may not go on with the old task."""
    server = Waiting(node)
    server.accept.set()
    behaviour = docking(node, dock=False)
    tick(behaviour)
    spin(executor, lambda: bool(server.executing))
    spin(executor, lambda: behaviour.goal_handle is not None)

    behaviour.stop(Status.INVALID)
    spin(executor, lambda: "cancelled" in behaviour.feedback_message)
    spin(executor, lambda: bool(server.cancelled))


def test_a_goal_is_cancelled_when_the_tree_is_shut_down(node: Any, executor: Any) -> None:
    """As at Ctrl-C: upstream destroys the client, and the robot goes on."""
    server = Waiting(rclpy.create_node("server"))
    executor.add_node(server.node)
    server.accept.set()
    behaviour = docking(node, dock=False)
    tick(behaviour)
    spin(executor, lambda: bool(server.executing) and behaviour.goal_handle is not None)

    behaviour.shutdown()
    node.destroy_node()

    spin(executor, lambda: bool(server.cancelled))


def test_a_server_that_has_gone_is_named_once(
    node: Any, executor: Any, capfd: pytest.CaptureFixture[str]
) -> None:
    """The behaviour goes on waiting, as upstream, and somebody has to know for what."""
    server = Waiting(rclpy.create_node("server"))
    executor.add_node(server.node)
    server.accept.set()
    behaviour = docking(node, dock=False)
    tick(behaviour)
    spin(executor, lambda: bool(server.executing) and behaviour.goal_handle is not None)
    server.ended.set()
    server.server.destroy()
    capfd.readouterr()

    spin(executor, lambda: not behaviour.action_client.server_is_ready())
    statuses = [tick(behaviour) for _ in range(3)]

    assert statuses == [Status.RUNNING] * 3
    assert capfd.readouterr().err.count("no action server [dock], still waiting") == 1


def test_a_goal_that_is_accepted_after_the_interruption_is_cancelled(
    node: Any, executor: Any
) -> None:
    """Upstream forgets it, and the robot drives on with a task that nobody waits for."""
    server = Waiting(node)
    behaviour = docking(node, dock=False)
    tick(behaviour)

    behaviour.stop(Status.INVALID)
    server.accept.set()
    spin(executor, lambda: bool(server.cancelled))

    assert behaviour.goal_handle is None


def test_a_late_answer_does_not_count_for_the_next_goal(node: Any, executor: Any) -> None:
    """The behaviour is interrupted and ticked again before the server has answered."""
    server = Waiting(node)
    behaviour = set_up(action_clients.FromBlackboard("dock", DockAction, "dock", "goal"), node)
    Board.set("/goal", DockAction.Goal(dock=False))
    tick(behaviour)
    behaviour.stop(Status.INVALID)
    Board.set("/goal", DockAction.Goal(dock=True))
    tick(behaviour)

    server.accept.set()
    spin(executor, lambda: tick(behaviour) is not Status.RUNNING)

    assert behaviour.status is Status.SUCCESS


def test_without_a_goal_a_behaviour_fails(node: Any) -> None:
    """`FromBlackboard` waits for nobody to write one."""
    behaviour = set_up(
        action_clients.FromBlackboard(
            "dock", DockAction, "dock", key="goal", wait_for_server_timeout_sec=0.0
        ),
        node,
    )

    assert tick(behaviour) is Status.FAILURE
    assert behaviour.feedback_message == "no goal to send"


def test_a_server_that_is_not_there_is_an_error_after_a_time(node: Any) -> None:
    """The behaviour says which server is missing."""
    behaviour = action_clients.FromConstant(
        "dock", DockAction, "dock", DockAction.Goal(), wait_for_server_timeout_sec=0.01
    )

    with pytest.raises(exceptions.TimedOutError, match=r"waiting for the server \[dock\]"):
        behaviour.setup(node=node)


def test_behaviours_need_a_node(node: Any) -> None:
    """Upstream's text has a mistake in it, and raises another error."""
    behaviour = action_clients.FromConstant("dock", DockAction, "dock", DockAction.Goal())

    with pytest.raises(KeyError, match="didn't find 'node'"):
        behaviour.setup()


def test_the_fields_of_a_goal_come_from_the_blackboard(node: Any, executor: Any) -> None:
    """Each from its own key, when the behaviour starts."""
    server = Waiting(node)
    server.accept.set()
    behaviour = set_up(
        action_clients.AttributesFromBlackboard("dock", DockAction, "dock", {"dock": "/wanted"}),
        node,
    )
    Board.set("/wanted", value=True)

    spin(executor, lambda: tick(behaviour) is not Status.RUNNING)

    assert behaviour.status is Status.SUCCESS


def test_a_service_is_called_and_its_response_written(node: Any, executor: Any) -> None:
    """The request is on the blackboard, and so is the response."""

    def answer(request: Any, response: Any) -> Any:
        response.message = f"got {request.data}"
        return response

    node.create_service(SetBool, "power", answer)
    behaviour = set_up(
        service_clients.FromConstant(
            "power", SetBool, "power", SetBool.Request(data=True), key_response="said"
        ),
        node,
    )

    assert tick(behaviour) is Status.RUNNING
    spin(executor, lambda: tick(behaviour) is not Status.RUNNING)

    assert behaviour.status is Status.SUCCESS
    assert Board.get("/said").message == "got True"


def test_a_wrong_request_fails_and_is_no_error_of_the_tree(node: Any) -> None:
    """Whoever writes to the blackboard may not end the tree."""
    node.create_service(SetBool, "power", lambda request, response: response)
    behaviour = set_up(
        service_clients.FromBlackboard("power", SetBool, "power", key_request="asked"), node
    )
    Board.set("/asked", "on")

    assert tick(behaviour) is Status.FAILURE


@pytest.mark.parametrize(
    ("policy", "statuses"),
    [
        (Policy.ON_INITIALISE, [Status.RUNNING, Status.SUCCESS, Status.RUNNING]),
        (Policy.ON_SUCCESS, [Status.SUCCESS, Status.RUNNING, Status.RUNNING]),
        (Policy.NEVER, [Status.SUCCESS, Status.SUCCESS, Status.SUCCESS]),
    ],
)
def test_a_message_is_forgotten_as_the_policy_says(
    node: Any, policy: Any, statuses: list[Any]
) -> None:
    """A message comes before the first tick; with ON_INITIALISE, another one before the second."""
    behaviour = set_up(
        subscribers.WaitForData("wait", "/said", String, UNLATCHED, clearing_policy=policy), node
    )
    hear(behaviour, String())
    found = [tick(behaviour)]
    if policy is Policy.ON_INITIALISE:
        hear(behaviour, String())
    found += [tick(behaviour), tick(behaviour)]

    assert found == statuses


def test_a_field_is_compared(node: Any) -> None:
    """A mismatch is RUNNING or FAILURE, as configured; a wrong name fails."""

    def check(**options: Any) -> Any:
        behaviour = set_up(
            subscribers.CheckData(
                "check",
                "/power",
                Battery,
                UNLATCHED,
                clearing_policy=Policy.NEVER,
                expected_value=0.5,
                comparison_operator=operator.gt,
                **{"variable_name": "percentage", **options},
            ),
            node,
        )
        found = [tick(behaviour)]
        for percentage in (0.25, 0.75):
            hear(behaviour, Battery(percentage=percentage))
            found.append(tick(behaviour))
        return found, behaviour.feedback_message

    found, text = check()
    assert found == [Status.RUNNING, Status.RUNNING, Status.SUCCESS]
    assert text == "'percentage' comparison succeeded [v: 0.75][e: 0.5]"
    found, _ = check(fail_if_no_data=True, fail_if_bad_comparison=True)
    assert found == [Status.FAILURE, Status.FAILURE, Status.SUCCESS]
    assert check(variable_name="nothing")[1] == "variable name not found [nothing]"


def test_fields_are_written_to_the_blackboard(node: Any) -> None:
    """The message, or fields of it, and what is there before the first."""
    behaviour = set_up(
        subscribers.ToBlackboard(
            "save",
            "/pose",
            message_class("geometry_msgs/msg/PoseStamped"),
            UNLATCHED,
            blackboard_variables={"whole": None, "x": "pose.position.x"},
            initialise_variables={"x": -1.0},
            clearing_policy=Policy.NEVER,
        ),
        node,
    )
    assert Board.get("/x") == -1.0
    assert tick(behaviour) is Status.RUNNING
    pose = behaviour.topic_type()
    pose.pose.position.x = 2.5
    hear(behaviour, pose)

    assert tick(behaviour) is Status.SUCCESS
    assert (Board.get("/whole"), Board.get("/x")) == (pose, 2.5)


def test_an_event_counts_for_one_tick(node: Any) -> None:
    """A button that was pressed once is pressed once."""
    behaviour = set_up(
        subscribers.EventToBlackboard("button", "/stop", UNLATCHED, "stop_pressed"), node
    )
    found = []
    for message in (None, behaviour.topic_type(), None):
        if message is not None:
            hear(behaviour, message)
        tick(behaviour)
        found.append(Board.get("/stop_pressed"))

    assert found == [False, True, False]


def test_a_battery_is_low_until_it_is_well_above_the_threshold(node: Any) -> None:
    """Near the threshold, the warning does not come and go."""
    behaviour = set_up(battery.ToBlackboard("battery", "/battery", UNLATCHED, 30.0), node)
    warnings = []
    for percentage in (50.0, 31.0, 29.0, 34.0, 36.0):
        hear(behaviour, Battery(percentage=percentage))
        tick(behaviour)
        warnings.append(Board.get("/battery_low_warning"))

    assert warnings == [False, False, True, True, False]


def test_what_is_on_the_blackboard_is_published(node: Any, executor: Any) -> None:
    """A field of it, too; nothing there is a failure, another type an error."""
    heard: list[Any] = []
    node.create_subscription(String, "/said", heard.append, 10)
    behaviour = set_up(publishers.FromBlackboard("say", "/said", String, UNLATCHED, "text"), node)

    assert tick(behaviour) is Status.FAILURE
    Board.set("/text", String(data="hello"))
    assert tick(behaviour) is Status.SUCCESS
    spin(executor, lambda: bool(heard))
    assert heard[0].data == "hello"
    Board.set("/text", "hello")
    with pytest.raises(TypeError, match="not the required type"):
        tick(behaviour)


def test_transforms_go_from_the_blackboard_to_the_blackboard(node: Any, executor: Any) -> None:
    """Broadcast by one behaviour, found by the other one."""
    give = set_up(transforms.FromBlackboard("give", "given", "cup", "hand", False, UNLATCHED), node)
    take = set_up(transforms.ToBlackboard("take", "taken", "hand", "cup", UNLATCHED), node)
    assert (tick(give), tick(take)) == (Status.FAILURE, Status.RUNNING)
    assert Board.get("/taken") is None
    given = Transform()
    given.translation.x = 0.3
    given.rotation.w = 1.0
    Board.set("/given", given)

    assert tick(give) is Status.SUCCESS
    spin(executor, lambda: tick(take) is Status.SUCCESS)

    assert Board.get("/taken").transform.translation.x == 0.3


def sequence(*statuses: Any) -> Any:
    """Return a tree of two behaviours, the first of which has these statuses and then succeeds."""
    root = py_trees.composites.Sequence("root", memory=True)
    root.add_child(py_trees.behaviours.StatusQueue("first", [*statuses], eventually=Status.SUCCESS))
    root.add_child(py_trees.behaviours.Running("second"))
    return root


def test_a_timer_ticks_a_tree_so_often(node: Any, executor: Any) -> None:
    """Beside the other callbacks of its node, with handlers before and after each tick."""
    tree = trees.BehaviourTree(sequence())
    tree.setup(node=node)
    calls: list[str] = []

    tree.tick_tock(
        10,
        number_of_iterations=3,
        pre_tick_handler=lambda _: calls.append("before"),
        post_tick_handler=lambda _: calls.append("after"),
    )
    spin(executor, tree.timer.is_canceled)

    assert calls == ["before", "after"] * 3
    assert (tree.count, tree.statistics.count) == (3, 2)
    assert tree.statistics.tick_interval > 0


def test_parameters_open_and_close_the_default_snapshots(node: Any, executor: Any) -> None:
    """Each change of the tree is one message for those that listen."""
    tree = trees.BehaviourTree(sequence(Status.RUNNING))
    tree.setup(node=node)
    heard: list[Any] = []
    node.create_subscription(Snapshot, "/robot/snapshots", heard.append, 10)

    node.set_parameters([Parameter("default_snapshot_stream", value=True)])
    tree.tick()
    spin(executor, lambda: len(heard) == 1)
    tree.tick()
    spin(executor, lambda: len(heard) == 2)
    tree.tick()  # nothing has changed, and the period is not over
    node.set_parameters([Parameter("default_snapshot_stream", value=False)])

    assert len(heard) == 2
    assert [each.is_active for each in heard[0].behaviours] == [True, False, True]
    assert not tree.snapshot_streams


def test_a_snapshot_is_read_as_the_tree_that_it_shows() -> None:
    """With the child that runs, whether there is a memory, and decorators."""
    root = sequence()
    root.add_child(py_trees.decorators.Inverter("not", py_trees.behaviours.Success("third")))
    root.tick_once()
    message = Snapshot(behaviours=[conversions.behaviour_to_msg(each) for each in root.iterate()])

    read, active = trees.tree_of(message)

    def shape(behaviour: Any) -> Any:
        children = [shape(child) for child in behaviour.children]
        return behaviour.name, behaviour.id, behaviour.status, children

    assert shape(read) == shape(root)
    assert read.memory is True
    assert read.current_child.name == "second"
    assert active == {}


def test_a_snapshot_whose_behaviours_are_in_a_circle_ends() -> None:
    """Another process may send anything."""
    root = sequence()
    message = Snapshot(behaviours=[conversions.behaviour_to_msg(each) for each in root.iterate()])
    first, _, last = message.behaviours
    first.child_ids = [first.own_id, last.own_id]

    read, _ = trees.tree_of(message)

    assert [each.name for each in read.iterate()] == ["second", "root"]
    assert trees.tree_of(Snapshot()) == (None, {})


def test_a_watcher_shows_the_tree_of_another_node(
    node: Any, executor: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    """It has that node open a stream, and closes it at its end."""
    tree = trees.BehaviourTree(sequence())
    tree.setup(node=node)
    ticks = threading.Thread(target=executor.spin)
    ticks.start()
    watcher = trees.Watcher(
        parameters=trees.SnapshotStream.Parameters(blackboard_data=True), statistics=True
    )
    watcher.setup(timeout_sec=5.0)
    opened = list(tree.snapshot_streams)

    tree.tick()
    while not watcher.snapshot_visitor.visited:
        rclpy.spin_once(watcher.node, timeout_sec=0.05)
    watcher.shutdown()
    executor.shutdown()
    ticks.join()

    printed = capsys.readouterr().out
    assert "Tick 0" in printed
    assert "second" in printed
    assert "Blackboard Data" in printed
    assert "[time/avg/stddev]" in printed
    assert opened == ["/robot/snapshot_streams/_snapshots_0"]
    assert not tree.snapshot_streams


def exchange_of(node: Any) -> Any:
    """Return the services of the blackboard on a node."""
    exchange = blackboard.Exchange()
    exchange.setup(node)
    return exchange


def opened(exchange: Any, *names: str) -> str:
    """Open a stream as its service does, and return its topic."""
    cls = service_class("py_trees_ros_interfaces/srv/OpenBlackboardStream")
    response = exchange._open_service(cls.Request(variables=list(names)), cls.Response())
    return str(response.topic)


def test_a_stream_of_the_blackboard_says_what_has_changed(node: Any, executor: Any) -> None:
    """Only variables that were asked for count; without listeners it ends."""
    exchange = exchange_of(node)
    heard: list[str] = []
    topic = opened(exchange, "speed")
    listener = node.create_subscription(String, topic, lambda msg: heard.append(msg.data), 10)
    for name, value in (("/speed", 1), ("/other", 2), ("/speed", 3)):
        Board.set(name, value)
        exchange.post_tick_handler()
    spin(executor, lambda: len(heard) == 2)

    plain = [re.sub(r"\x1b\[[\d;]*m", "", text).split() for text in heard]
    assert plain == [["speed", ":", "1"], ["speed", ":", "3"]]
    node.destroy_subscription(listener)
    spin(executor, lambda: node.count_subscribers(topic) == 0)
    exchange.post_tick_handler()
    assert not exchange.views


def test_a_stream_waits_for_its_first_listener(node: Any) -> None:
    """A tree that ticks fast would else close it before the watcher has subscribed."""
    exchange = exchange_of(node)
    opened(exchange)

    exchange.post_tick_handler()

    assert len(exchange.views) == 1


def test_streams_are_bounded(node: Any) -> None:
    """Another process may open them without end."""
    exchange = exchange_of(node)
    topics = [opened(exchange) for _ in range(blackboard.MAX_STREAMS + 1)]

    assert [view.topic_name for view in exchange.views] == topics[1:]


def test_names_of_what_goes_in_circles_are_bounded() -> None:
    """An attribute of an object may be the object."""

    class Circle:
        @property
        def itself(self) -> Any:
            return self

    names: list[str] = []
    blackboard.add_names(names, "circle", Circle(), 3)

    assert names == [
        "circle",
        "circle.itself",
        "circle.itself.itself",
        "circle.itself.itself.itself",
    ]


def test_what_cannot_be_compared_counts_as_changed(node: Any) -> None:
    """Functions and locks are on the blackboards of real trees."""
    Board.set("/lock", threading.Lock())
    Board.set("/function", lambda: None)
    for name in ("/lock", "/function"):
        part = blackboard.SubBlackboard(node)
        part.update({name})
        part.update({name})
        assert part.is_changed


def test_the_watcher_lists_fields_below_their_variable(capsys: pytest.CaptureFixture[str]) -> None:
    """As `py-trees-blackboard-watcher --list` prints them."""
    blackboard_watcher.pretty_print_variables(["/pose", "/pose.x"])

    assert [line.strip() for line in capsys.readouterr().out.splitlines()[2:4]] == ["/pose", ".x"]


def test_the_workspaces_own_package_comes_first(tmp_path: Path) -> None:
    """A workspace with upstream's sources runs those."""
    from aionode._packages import use
    from aionode.rclpy._finder import gives_way

    own = tmp_path / "py_trees_ros"
    (own / "py_trees_ros").mkdir(parents=True)
    (own / "py_trees_ros/__init__.py").touch()
    (own / "package.xml").write_text(
        "<package format='3'><name>py_trees_ros</name><version>1.0.0</version>"
        "<export><build_type>ament_python</build_type></export></package>"
    )
    (own / "setup.py").touch()
    assert not gives_way("py_trees_ros")
    use(tmp_path)

    assert gives_way("py_trees_ros")
