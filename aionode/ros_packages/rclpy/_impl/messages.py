"""The messages and services that rclpy itself uses."""

from __future__ import annotations

from aionode.qos import QoSProfile
from rosidl_generator_py import message_class, service_class

__all__ = [
    "TEN_MESSAGES",
    "UUID",
    "CancelGoal",
    "ChangeState",
    "Clock",
    "DescribeParameters",
    "Duration",
    "GetAvailableStates",
    "GetAvailableTransitions",
    "GetLoggerLevels",
    "GetParameterTypes",
    "GetParameters",
    "GetState",
    "GetTypeDescription",
    "GoalInfo",
    "GoalStatus",
    "LifecycleState",
    "ListParameters",
    "ListParametersResult",
    "LoggerLevel",
    "Parameter",
    "ParameterDescriptor",
    "ParameterEvent",
    "ParameterValue",
    "SetLoggerLevels",
    "SetLoggerLevelsResult",
    "SetParameters",
    "SetParametersAtomically",
    "SetParametersResult",
    "Time",
    "TransitionDescription",
    "TransitionEvent",
]

CancelGoal = service_class("action_msgs/srv/CancelGoal")
GoalInfo = message_class("action_msgs/msg/GoalInfo")
GoalStatus = message_class("action_msgs/msg/GoalStatus")
UUID = message_class("unique_identifier_msgs/msg/UUID")
Duration = message_class("builtin_interfaces/msg/Duration")
Time = message_class("builtin_interfaces/msg/Time")
Clock = message_class("rosgraph_msgs/msg/Clock")
ListParametersResult = message_class("rcl_interfaces/msg/ListParametersResult")
LoggerLevel = message_class("rcl_interfaces/msg/LoggerLevel")
Parameter = message_class("rcl_interfaces/msg/Parameter")
ParameterDescriptor = message_class("rcl_interfaces/msg/ParameterDescriptor")
ParameterEvent = message_class("rcl_interfaces/msg/ParameterEvent")
ParameterValue = message_class("rcl_interfaces/msg/ParameterValue")
SetLoggerLevelsResult = message_class("rcl_interfaces/msg/SetLoggerLevelsResult")
SetParametersResult = message_class("rcl_interfaces/msg/SetParametersResult")
DescribeParameters = service_class("rcl_interfaces/srv/DescribeParameters")
GetLoggerLevels = service_class("rcl_interfaces/srv/GetLoggerLevels")
GetParameterTypes = service_class("rcl_interfaces/srv/GetParameterTypes")
GetParameters = service_class("rcl_interfaces/srv/GetParameters")
ListParameters = service_class("rcl_interfaces/srv/ListParameters")
SetLoggerLevels = service_class("rcl_interfaces/srv/SetLoggerLevels")
SetParameters = service_class("rcl_interfaces/srv/SetParameters")
SetParametersAtomically = service_class("rcl_interfaces/srv/SetParametersAtomically")
GetTypeDescription = service_class("type_description_interfaces/srv/GetTypeDescription")

ChangeState = service_class("lifecycle_msgs/srv/ChangeState")
GetAvailableStates = service_class("lifecycle_msgs/srv/GetAvailableStates")
GetAvailableTransitions = service_class("lifecycle_msgs/srv/GetAvailableTransitions")
GetState = service_class("lifecycle_msgs/srv/GetState")
LifecycleState = message_class("lifecycle_msgs/msg/State")
TransitionDescription = message_class("lifecycle_msgs/msg/TransitionDescription")
TransitionEvent = message_class("lifecycle_msgs/msg/TransitionEvent")

TEN_MESSAGES = QoSProfile(depth=10)
"""QoS of the services and topics of managed nodes."""
