"""`launch_ros.actions`."""

from __future__ import annotations

from launch_ros.actions._containers import (
    ComposableNodeContainer,
    LoadComposableNodes,
)
from launch_ros.actions._lifecycle import LifecycleNode, LifecycleTransition
from launch_ros.actions._node import Node
from launch_ros.actions._settings import (
    PushROSNamespace,
    PushRosNamespace,
    ROSTimer,
    RosTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
]
