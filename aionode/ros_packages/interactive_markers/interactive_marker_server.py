"""A server of interactive markers for displays such as RViz."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from std_msgs.msg import Header
from visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerFeedback,
    InteractiveMarkerPose,
    InteractiveMarkerUpdate,
)
from visualization_msgs.srv import GetInteractiveMarkers

from rclpy.duration import Duration

__all__ = ["InteractiveMarkerServer", "MarkerContext", "UpdateContext"]

TAKEN: Duration = Duration(seconds=1.0)
"""How long a marker belongs to the client that last moved it."""

Callback = Callable[[Any], Any]


class MarkerContext:
    """A marker, and the callbacks for its feedback."""

    def __init__(self, time: Any) -> None:
        self.last_feedback = time
        self.last_client_id = ""
        self.default_feedback_callback: Callback | None = None
        self.feedback_callbacks: dict[int, Callback] = {}
        self.int_marker: Any = InteractiveMarker()


class UpdateContext:
    """The pending change of a marker, made by the next `applyChanges`."""

    FULL_UPDATE = 0
    POSE_UPDATE = 1
    ERASE = 2

    def __init__(self) -> None:
        self.update_type = self.FULL_UPDATE
        self.int_marker: Any = InteractiveMarker()
        self.default_feedback_callback: Callback | None = None
        self.feedback_callbacks: dict[int, Callback] = {}


class InteractiveMarkerServer:
    """Sends markers to displays, and calls functions when a user moves or clicks one.

    Changes become visible with `applyChanges`; callbacks change at once.

    Args:
        node: The node that publishes.
        topic_ns: The namespace of the topics and the service.
        q_size: The depth of the topics.
    """

    DEFAULT_FEEDBACK_CALLBACK = 255

    def __init__(self, node: Any, topic_ns: str, q_size: int = 100) -> None:
        self.node = node
        self.topic_ns = topic_ns
        self.seq_num = 0
        self.mutex = threading.Lock()
        self.marker_contexts: dict[str, MarkerContext] = {}
        self.pending_updates: dict[str, UpdateContext] = {}
        self.get_interactive_markers_srv: Any = node.create_service(
            GetInteractiveMarkers,
            f"{topic_ns}/get_interactive_markers",
            self.getInteractiveMarkersCallback,
        )
        self.update_pub: Any = node.create_publisher(
            InteractiveMarkerUpdate, f"{topic_ns}/update", q_size
        )
        self.feedback_sub: Any = node.create_subscription(
            InteractiveMarkerFeedback, f"{topic_ns}/feedback", self.processFeedback, q_size
        )

    def shutdown(self) -> None:
        """Erase all markers, and destroy topics and service; call it before destroying the node."""
        if self.update_pub is None:
            return
        self.clear()
        self.applyChanges()
        self.node.destroy_service(self.get_interactive_markers_srv)
        self.node.destroy_publisher(self.update_pub)
        self.node.destroy_subscription(self.feedback_sub)
        self.get_interactive_markers_srv = self.update_pub = self.feedback_sub = None

    def insert(
        self,
        marker: Any,
        *,
        feedback_callback: Callback | None = None,
        feedback_type: int = DEFAULT_FEEDBACK_CALLBACK,
    ) -> None:
        """Add a marker, or replace the one with its name.

        Args:
            marker: The marker.
            feedback_callback: Called with feedback.
            feedback_type: The type of feedback; by default, all types without their own callback.
        """
        with self.mutex:
            update = self.pending_updates.setdefault(marker.name, UpdateContext())
            update.update_type = UpdateContext.FULL_UPDATE
            update.int_marker = marker
        if feedback_callback is not None:
            self.setCallback(marker.name, feedback_callback, feedback_type)

    def setPose(self, name: str, pose: Any, header: Any = None) -> bool:
        """Move a marker, and return whether it exists.

        Args:
            name: The marker's name.
            pose: Its new pose.
            header: The frame of the pose; by default that of the marker.
        """
        with self.mutex:
            context = self.marker_contexts.get(name)
            update = self.pending_updates.get(name)
            is_new = update is not None and update.update_type == UpdateContext.FULL_UPDATE
            known = update if is_new else context
            if known is None:
                return False
            is_given = header is not None and header.frame_id != ""
            self.doSetPose(update, name, pose, header if is_given else known.int_marker.header)
            return True

    def erase(self, name: str) -> bool:
        """Remove a marker, and return whether it existed."""
        with self.mutex:
            if name not in self.pending_updates and name not in self.marker_contexts:
                return False
            update = self.pending_updates.setdefault(name, UpdateContext())
            update.update_type = UpdateContext.ERASE
            return True

    def clear(self) -> None:
        """Remove all markers."""
        with self.mutex:
            names = list(self.marker_contexts)
            self.pending_updates = {}
        for name in names:
            self.erase(name)

    def setCallback(
        self,
        name: str,
        feedback_callback: Callback | None,
        feedback_type: int = DEFAULT_FEEDBACK_CALLBACK,
    ) -> bool:
        """Set the callback for feedback on a marker, and return whether the marker exists.

        Args:
            name: The marker's name.
            feedback_callback: Called with feedback; None to remove the callback.
            feedback_type: The type of feedback; by default, all types without their own callback.
        """
        with self.mutex:
            found = [self.marker_contexts.get(name), self.pending_updates.get(name)]
            for each in found:
                if each is None:
                    continue
                if feedback_type == self.DEFAULT_FEEDBACK_CALLBACK:
                    each.default_feedback_callback = feedback_callback
                elif feedback_callback is None:
                    each.feedback_callbacks.pop(feedback_type, None)
                else:
                    each.feedback_callbacks[feedback_type] = feedback_callback
            return any(each is not None for each in found)

    def applyChanges(self) -> None:
        """Publish the changes since the last call."""
        with self.mutex:
            if not self.pending_updates:
                return
            message = InteractiveMarkerUpdate(type=InteractiveMarkerUpdate.UPDATE)
            for name, update in self.pending_updates.items():
                self._apply(name, update, message)
            self.pending_updates = {}
            self.seq_num += 1
        self.publish(message)

    def _apply(self, name: str, update: UpdateContext, message: Any) -> None:
        if update.update_type == UpdateContext.ERASE:
            if self.marker_contexts.pop(name, None) is not None:
                message.erases.append(name)
            return
        if update.update_type == UpdateContext.POSE_UPDATE:
            marker = self.marker_contexts[name].int_marker
            marker.pose, marker.header = update.int_marker.pose, update.int_marker.header
            message.poses.append(
                InteractiveMarkerPose(header=marker.header, pose=marker.pose, name=marker.name)
            )
            return
        if name not in self.marker_contexts:
            context = MarkerContext(self.node.get_clock().now())
            context.default_feedback_callback = update.default_feedback_callback
            context.feedback_callbacks = update.feedback_callbacks
            self.marker_contexts[name] = context
        self.marker_contexts[name].int_marker = update.int_marker
        message.markers.append(update.int_marker)

    def get(self, name: str) -> Any:
        """Return a marker as it will be after `applyChanges`; None if it does not exist."""
        context = self.marker_contexts.get(name)
        update = self.pending_updates.get(name)
        if update is None:
            return None if context is None else context.int_marker
        if update.update_type == UpdateContext.POSE_UPDATE and context is not None:
            context.int_marker.pose = update.int_marker.pose
            return context.int_marker
        is_new = update.update_type == UpdateContext.FULL_UPDATE
        return update.int_marker if is_new else None

    def processFeedback(self, feedback: Any) -> None:
        """Move a marker as a client requests, and call its callback."""
        with self.mutex:
            name = feedback.marker_name
            context = self.marker_contexts.get(name)
            if context is None:
                return
            now = self.node.get_clock().now()
            is_other = context.last_client_id not in {"", feedback.client_id}
            if is_other and now - context.last_feedback < TAKEN:
                self.node.get_logger().debug(
                    f"Rejecting feedback for {name}: conflicting feedback from separate clients."
                )
                return
            context.last_feedback = now
            context.last_client_id = feedback.client_id
            if feedback.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
                stamp = context.int_marker.header.stamp
                follows_frame = stamp.sec == 0 and stamp.nanosec == 0
                header = context.int_marker.header if follows_frame else feedback.header
                self.doSetPose(self.pending_updates.get(name), name, feedback.pose, header)
            default = context.default_feedback_callback
            callback = context.feedback_callbacks.get(feedback.event_type, default)
        if callback is not None:
            callback(feedback)

    def publish(self, update: Any) -> None:
        """Publish an update with the next sequence number."""
        update.seq_num = self.seq_num
        self.update_pub.publish(update)

    def getInteractiveMarkersCallback(self, request: Any, response: Any) -> Any:
        """Answer with all markers."""
        with self.mutex:
            response.sequence_number = self.seq_num
            response.markers = [each.int_marker for each in self.marker_contexts.values()]
        return response

    def doSetPose(self, update: UpdateContext | None, name: str, pose: Any, header: Any) -> None:
        """Record the new pose of a marker; the caller holds the lock."""
        is_new = update is not None and update.update_type == UpdateContext.FULL_UPDATE
        if update is None:
            update = self.pending_updates[name] = UpdateContext()
        if not is_new:
            update.update_type = UpdateContext.POSE_UPDATE
        update.int_marker.pose = pose
        update.int_marker.header = Header(stamp=header.stamp, frame_id=header.frame_id)
