"""The messages and services that rclpy itself uses."""

from __future__ import annotations

from rosidl_generator_py import message_class, service_class

__all__ = [
    "Clock",
    "DescribeParameters",
    "Duration",
    "GetParameterTypes",
    "GetParameters",
    "GetTypeDescription",
    "ListParameters",
    "ListParametersResult",
    "Parameter",
    "ParameterDescriptor",
    "ParameterEvent",
    "ParameterValue",
    "SetParameters",
    "SetParametersAtomically",
    "SetParametersResult",
    "Time",
]

Duration = message_class("builtin_interfaces/msg/Duration")
Time = message_class("builtin_interfaces/msg/Time")
Clock = message_class("rosgraph_msgs/msg/Clock")
ListParametersResult = message_class("rcl_interfaces/msg/ListParametersResult")
Parameter = message_class("rcl_interfaces/msg/Parameter")
ParameterDescriptor = message_class("rcl_interfaces/msg/ParameterDescriptor")
ParameterEvent = message_class("rcl_interfaces/msg/ParameterEvent")
ParameterValue = message_class("rcl_interfaces/msg/ParameterValue")
SetParametersResult = message_class("rcl_interfaces/msg/SetParametersResult")
DescribeParameters = service_class("rcl_interfaces/srv/DescribeParameters")
GetParameterTypes = service_class("rcl_interfaces/srv/GetParameterTypes")
GetParameters = service_class("rcl_interfaces/srv/GetParameters")
ListParameters = service_class("rcl_interfaces/srv/ListParameters")
SetParameters = service_class("rcl_interfaces/srv/SetParameters")
SetParametersAtomically = service_class("rcl_interfaces/srv/SetParametersAtomically")
GetTypeDescription = service_class("type_description_interfaces/srv/GetTypeDescription")
