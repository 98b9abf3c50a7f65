"""`interactive_markers`: what displays see, and what a click or a drag calls."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import rclpy
from interactive_markers import InteractiveMarkerServer, MenuHandler
from rosidl_generator_py import message_class, service_class
from tests.support.peers import isolated_environment

if TYPE_CHECKING:
    from collections.abc import Iterator

Marker = message_class("visualization_msgs/msg/InteractiveMarker")
Feedback = message_class("visualization_msgs/msg/InteractiveMarkerFeedback")
Update = message_class("visualization_msgs/msg/InteractiveMarkerUpdate")
Pose = message_class("geometry_msgs/msg/Pose")
GetMarkers = service_class("visualization_msgs/srv/GetInteractiveMarkers")


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A node of rclpy, without other participants."""
    for name, value in isolated_environment().items():
        monkeypatch.setenv(name, value)
    rclpy.init(args=[])
    yield rclpy.create_node("robot")
    rclpy.try_shutdown()


@pytest.fixture
def server(node: Any) -> Any:
    """A server whose updates are kept."""
    server: Any = InteractiveMarkerServer(node, "marker")
    server.sent = []
    publish = server.publish

    def kept(update: Any) -> None:
        publish(update)
        server.sent.append(update)

    server.publish = kept
    return server


def at(x: float) -> Any:
    """Return a pose."""
    pose = Pose()
    pose.position.x = x
    return pose


def dragged(x: float, client: str = "rviz", **fields: Any) -> Any:
    """Return the feedback of a client that drags the marker."""
    event = fields.pop("event_type", Feedback.POSE_UPDATE)
    return Feedback(marker_name="cup", client_id=client, event_type=event, pose=at(x), **fields)


def test_changes_are_sent_together_and_numbered(server: Any) -> None:
    """Whole markers at first, then poses, then erased names; nothing if nothing has changed."""
    server.insert(Marker(name="cup"))
    server.insert(Marker(name="can"))
    server.applyChanges()
    server.applyChanges()
    server.setPose("cup", at(1.5))
    server.erase("can")
    server.applyChanges()

    first, second = server.sent
    assert [each.name for each in first.markers] == ["cup", "can"]
    assert [(each.name, each.pose.position.x) for each in second.poses] == [("cup", 1.5)]
    assert (list(second.erases), second.seq_num) == (["can"], 2)
    assert not server.setPose("can", at(1.0))
    assert not server.erase("can")


def test_a_marker_that_is_not_shown_yet_can_be_moved(server: Any) -> None:
    """As in C++; the original in Python refuses."""
    server.insert(Marker(name="cup"))

    assert server.setPose("cup", at(2.0))
    server.applyChanges()
    assert server.sent[0].markers[0].pose.position.x == 2.0


def test_a_drag_moves_the_marker_and_calls_its_function(node: Any, server: Any) -> None:
    """Over the topic; the function may use the server, and the move is shown by applyChanges."""
    said: list[float] = []

    def moved(feedback: Any) -> None:
        said.append(feedback.pose.position.x)
        server.applyChanges()

    server.insert(Marker(name="cup"), feedback_callback=moved)
    server.applyChanges()
    display = node.create_publisher(Feedback, "marker/feedback", 1)
    display.publish(dragged(3.5))
    while not said:
        rclpy.spin_once(node, timeout_sec=5.0)

    assert said == [3.5]
    assert server.sent[1].poses[0].pose.position.x == 3.5
    assert server.get("cup").pose.position.x == 3.5


def test_a_second_client_waits_until_the_first_one_lets_go(server: Any) -> None:
    """Two people cannot drag one marker."""
    said: list[str] = []
    server.insert(Marker(name="cup"), feedback_callback=lambda each: said.append(each.client_id))
    server.applyChanges()
    server.marker_contexts["cup"].last_client_id = "first"

    server.processFeedback(dragged(1.0, "first"))
    server.processFeedback(dragged(2.0, "second"))
    server.processFeedback(Feedback(marker_name="nothing"))

    assert said == ["first"]


def test_a_kind_of_feedback_can_have_its_own_function(server: Any) -> None:
    """All others call the default one."""
    said: list[str] = []
    server.insert(Marker(name="cup"), feedback_callback=lambda _: said.append("default"))
    server.setCallback("cup", lambda _: said.append("click"), Feedback.BUTTON_CLICK)
    server.applyChanges()
    server.marker_contexts["cup"].last_client_id = "rviz"
    click = dragged(0.0, event_type=Feedback.BUTTON_CLICK)

    server.processFeedback(click)
    server.processFeedback(dragged(1.0))
    server.setCallback("cup", None, Feedback.BUTTON_CLICK)
    server.processFeedback(click)

    assert said == ["click", "default", "default"]
    assert not server.setCallback("nothing", None)


def test_a_display_that_comes_later_gets_all_markers(server: Any) -> None:
    """By a service, with the number of the update that they are as of."""
    server.insert(Marker(name="cup"))
    server.applyChanges()

    answer = server.getInteractiveMarkersCallback(GetMarkers.Request(), GetMarkers.Response())

    assert ([each.name for each in answer.markers], answer.sequence_number) == (["cup"], 1)


def test_the_end_of_a_server_erases_its_markers(server: Any) -> None:
    """A second end does nothing."""
    server.insert(Marker(name="cup"))
    server.applyChanges()

    server.shutdown()
    server.shutdown()

    assert list(server.sent[-1].erases) == ["cup"]


def test_a_menu_shows_its_entries_and_calls_the_one_that_is_chosen(server: Any) -> None:
    """With check boxes, nested and hidden entries; a change is shown by reApply."""
    said: list[str] = []
    menu = MenuHandler()
    top = menu.insert("Grasp")
    soft = menu.insert("softly", parent=top, callback=lambda _: said.append("soft"))
    hidden = menu.insert("never")
    assert soft is not None
    assert hidden is not None
    menu.setVisible(hidden, False)
    menu.setCheckState(soft, MenuHandler.CHECKED)
    server.insert(Marker(name="cup"))
    assert menu.apply(server, "cup")
    server.applyChanges()

    shown = server.sent[0].markers[0].menu_entries
    assert [(each.title, each.parent_id) for each in shown] == [("Grasp", 0), ("[x] softly", top)]
    server.marker_contexts["cup"].last_client_id = "rviz"
    server.processFeedback(dragged(0.0, event_type=Feedback.MENU_SELECT, menu_entry_id=soft))
    assert said == ["soft"]
    menu.setCheckState(soft, MenuHandler.UNCHECKED)
    assert menu.reApply(server)
    assert server.get("cup").menu_entries[1].title == "[ ] softly"
    assert (menu.getCheckState(soft), menu.getTitle(soft)) == (MenuHandler.UNCHECKED, "softly")
    assert not menu.apply(server, "nothing")
    assert menu.insert("lost", parent=99) is None
