"""Converts between objects of py_trees and messages."""

from __future__ import annotations

import uuid
from typing import Any, Final

import py_trees
from py_trees_ros_interfaces.msg import ActivityItem, Behaviour, KeyValue
from unique_identifier_msgs.msg import UUID

from aionode.clock import S_TO_NS

__all__ = [
    "activity_stream_to_msgs",
    "additional_detail_to_str",
    "behaviour_to_msg",
    "behaviour_type_to_msg_constant",
    "blackbox_enum_to_msg_constant",
    "msg_constant_to_behaviour_type",
    "msg_constant_to_blackbox_level_enum",
    "msg_constant_to_status_enum",
    "msg_to_behaviour",
    "msg_to_uuid4",
    "rclpy_duration_to_float",
    "rclpy_time_to_float",
    "status_enum_to_msg_constant",
    "uuid4_to_msg",
]

TYPES: Final = {
    py_trees.composites.Sequence: Behaviour.SEQUENCE,
    py_trees.composites.Selector: Behaviour.SELECTOR,
    py_trees.composites.Parallel: Behaviour.PARALLEL,
    py_trees.decorators.Decorator: Behaviour.DECORATOR,
    py_trees.behaviour.Behaviour: Behaviour.BEHAVIOUR,
}
"""The constant of each class of behaviours, with the common base last."""

STATUSES: Final = {
    py_trees.common.Status.INVALID: Behaviour.INVALID,
    py_trees.common.Status.RUNNING: Behaviour.RUNNING,
    py_trees.common.Status.SUCCESS: Behaviour.SUCCESS,
    py_trees.common.Status.FAILURE: Behaviour.FAILURE,
}

LEVELS: Final = {
    py_trees.common.BlackBoxLevel.DETAIL: Behaviour.BLACKBOX_LEVEL_DETAIL,
    py_trees.common.BlackBoxLevel.COMPONENT: Behaviour.BLACKBOX_LEVEL_COMPONENT,
    py_trees.common.BlackBoxLevel.BIG_PICTURE: Behaviour.BLACKBOX_LEVEL_BIG_PICTURE,
    py_trees.common.BlackBoxLevel.NOT_A_BLACKBOX: Behaviour.BLACKBOX_LEVEL_NOT_A_BLACKBOX,
}

ACCESSES: Final = {
    "read": Behaviour.BLACKBOARD_ACCESS_READ,
    "write": Behaviour.BLACKBOARD_ACCESS_WRITE,
    "exclusive": Behaviour.BLACKBOARD_ACCESS_EXCLUSIVE_WRITE,
}
"""The constant of each attribute of a blackboard client that holds keys."""

WITH_MEMORY: Final = "WithMemory"


def key_of(table: dict[Any, Any], value: int, what: str) -> Any:
    """Return the key of a table whose value is a constant in a message."""
    for key, constant in table.items():
        if constant == value:
            return key
    raise TypeError(f"invalid {what} specified in message [{value}]")


def activity_stream_to_msgs() -> list[Any]:
    """Return the blackboard's activity stream as messages."""
    return [
        ActivityItem(
            key=item.key,
            client_name=item.client_name,
            activity_type=item.activity_type,
            previous_value=str(item.previous_value),
            current_value=str(item.current_value),
        )
        for item in py_trees.blackboard.Blackboard.activity_stream.data
    ]


def behaviour_type_to_msg_constant(behaviour: Any) -> int:
    """Return the constant of the class of a behaviour."""
    for cls, constant in TYPES.items():
        if isinstance(behaviour, cls):
            return int(constant)
    return int(Behaviour.UNKNOWN_TYPE)


def msg_constant_to_behaviour_type(value: int) -> Any:
    """Return the class of behaviours that a constant stands for.

    Raises:
        TypeError: There is no such constant.
    """
    return key_of(TYPES, value, "type")


def additional_detail_to_str(behaviour: Any) -> str:
    """Return the policy of a parallel, or whether a sequence or selector has memory."""
    if isinstance(behaviour, py_trees.composites.Parallel):
        policy = type(behaviour.policy).__name__.replace("Success", "")
        if not hasattr(behaviour.policy, "children"):
            return policy
        chosen = sorted(str(behaviour.children.index(child)) for child in behaviour.policy.children)
        return f"{policy}({', '.join(chosen)})"
    with_memory = (py_trees.composites.Sequence, py_trees.composites.Selector)
    return WITH_MEMORY if isinstance(behaviour, with_memory) and behaviour.memory else ""


def status_enum_to_msg_constant(status: Any) -> int:
    """Return the constant of a status; 0 if it has none."""
    return int(STATUSES.get(status, 0))


def msg_constant_to_status_enum(value: int) -> Any:
    """Return the status that a constant stands for.

    Raises:
        TypeError: There is no such constant.
    """
    return key_of(STATUSES, value, "status")


def blackbox_enum_to_msg_constant(blackbox_level: Any) -> int:
    """Return the constant of the level of a black box."""
    return int(LEVELS.get(blackbox_level, Behaviour.BLACKBOX_LEVEL_NOT_A_BLACKBOX))


def msg_constant_to_blackbox_level_enum(value: int) -> Any:
    """Return the level of a black box that a constant stands for.

    Raises:
        TypeError: There is no such constant.
    """
    return key_of(LEVELS, value, "blackbox level")


def uuid4_to_msg(uuid4: uuid.UUID | None = None) -> Any:
    """Return a UUID as a message; by default, a new one."""
    return UUID(uuid=list((uuid4 or uuid.uuid4()).bytes))


def msg_to_uuid4(msg: Any) -> uuid.UUID:
    """Return the UUID of a message."""
    return uuid.UUID(bytes=bytes(msg.uuid), version=4)


def behaviour_to_msg(behaviour: Any) -> Any:
    """Return a behaviour as a message, which contains only the ids of its children."""
    msg = Behaviour(
        name=behaviour.name,
        class_name=f"{behaviour.__module__}.{type(behaviour).__name__}",
        own_id=uuid4_to_msg(behaviour.id),
        child_ids=[uuid4_to_msg(child.id) for child in behaviour.children],
        type=behaviour_type_to_msg_constant(behaviour),
        blackbox_level=blackbox_enum_to_msg_constant(behaviour.blackbox_level),
        status=status_enum_to_msg_constant(behaviour.status),
        additional_detail=additional_detail_to_str(behaviour),
        message=behaviour.feedback_message,
    )
    if behaviour.parent:
        msg.parent_id = uuid4_to_msg(behaviour.parent.id)
    tip = behaviour.tip()
    if tip is not None and tip != behaviour:
        msg.tip_id = uuid4_to_msg(tip.id)
    is_composite = isinstance(behaviour, py_trees.composites.Composite)
    if is_composite and behaviour.current_child is not None:
        msg.current_child_id = uuid4_to_msg(behaviour.current_child.id)
    msg.blackboard_access = [
        KeyValue(key=key, value=constant)
        for client in behaviour.blackboards
        for access, constant in ACCESSES.items()
        for key in getattr(client, access)
    ]
    return msg


def msg_to_behaviour(msg: Any) -> Any:
    """Return a behaviour that looks like the one in a message, and does nothing.

    Raises:
        TypeError: A constant of the message is unknown.
    """
    cls = msg_constant_to_behaviour_type(msg.type)
    behaviour: Any
    if cls is py_trees.decorators.Decorator:
        behaviour = py_trees.decorators.PassThrough(
            name=msg.name, child=py_trees.behaviours.Dummy()
        )
    elif cls is py_trees.composites.Parallel:
        behaviour = cls(name=msg.name, policy=py_trees.common.ParallelPolicy.SuccessOnAll())
    elif cls is py_trees.behaviour.Behaviour:
        behaviour = py_trees.behaviours.Dummy(name=msg.name)
    else:
        behaviour = cls(name=msg.name, memory=msg.additional_detail == WITH_MEMORY)
    behaviour.id = msg_to_uuid4(msg.own_id)
    behaviour.status = msg_constant_to_status_enum(msg.status)
    behaviour.blackbox_level = msg_constant_to_blackbox_level_enum(msg.blackbox_level)
    behaviour.feedback_message = msg.message
    return behaviour


def rclpy_time_to_float(time: Any) -> float:
    """Return a time in seconds."""
    return float(time.nanoseconds) / S_TO_NS


def rclpy_duration_to_float(duration: Any) -> float:
    """Return a duration in seconds."""
    return float(duration.nanoseconds) / S_TO_NS
