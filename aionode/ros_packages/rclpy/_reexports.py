"""Names that modules of rclpy and tf2 have from elsewhere in ROS, as programs take them.

They are found when asked for, and so are names of `typing`, which nearly every module has. Of what
those modules have from Python itself there is no more than a program was seen to take from there.
"""

from __future__ import annotations

import sys
import typing
from importlib import import_module
from importlib.machinery import PathFinder
from types import ModuleType
from typing import Any, Final

__all__ = ["add_names"]

NAMES: Final = """
    rclpy: callback_groups duration exceptions impl qos_profile_rosout_default
    rclpy.action.client: Action CancelGoal Clock FeedbackMessage GetResultServiceResponse
        GoalStatusArray ServiceIntrospectionState Time UUID Waitable
    rclpy.action.graph: Node
    rclpy.action.server: Action CancelGoal Clock FeedbackMessage GetResultServiceResponse GoalInfo
        ServiceIntrospectionState Task UUID Waitable
    rclpy.client: CallbackGroup Clock Context QoSProfile ServiceIntrospectionState Srv SrvRequestT
        SrvResponseT SrvType SrvTypeRequest SrvTypeResponse
    rclpy.clock: Context
    rclpy.duration: S_TO_NS builtin_interfaces
    rclpy.event_handler: CallbackGroup get_logger qos_policy_name_from_kind rclpy
    rclpy.executors: Client Clock ClockType Context GuardCondition InvalidHandle MessageInfo Msg
        NumberOfEntities Service SignalHandlerGuardCondition Subscription Timer TimerCancelledError
        TimerInfo Waitable time timeout_sec_to_nsec
    rclpy.experimental.events_executor: rclpy
    rclpy.guard_condition: CallbackGroup Context
    rclpy.impl: implementation_singleton logging_severity rcutils_logger
    rclpy.impl.rcutils_logger: Clock LoggingSeverity
    rclpy.lifecycle.node: CallbackGroup MsgT QoSProfile RcutilsLogger Service
        check_is_valid_srv_type lifecycle_msgs
    rclpy.lifecycle.publisher: CallbackGroup PublisherEventCallbacks QoSProfile
    rclpy.logging_service: GetLoggerLevels LoggerLevel LoggingSeverity SetLoggerLevels
        SetLoggerLevelsResult TOPIC_SEPARATOR_STRING qos_profile_services_default rclpy
    rclpy.node: AllowableParameterValue AllowableParameterValueT ContentFilterOptions Context
        FloatingPointRange IntegerRange InvalidParameterTypeException InvalidParameterValueException
        InvalidTopicNameException ListParameters ListParametersResult MessageInfo MsgT MsgType
        PARAMETER_SEPARATOR_STRING ParameterAlreadyDeclaredException ParameterDescriptor
        ParameterEvent ParameterImmutableException ParameterMsg ParameterNotDeclaredException
        ParameterType ParameterUninitializedException ParameterValue RcutilsLogger
        SetParametersResult Srv SrvRequestT SrvResponseT SrvType SrvTypeRequest SrvTypeResponse
        TimerInfo TopicEndpointInfo Waitable expand_topic_name validate_full_topic_name
        validate_namespace validate_node_name validate_parameter_name validate_topic_name
    rclpy.parameter: ParameterMsg ParameterType ParameterValue
    rclpy.parameter_client: CallbackGroup Client DescribeParameters Future GetParameterTypes
        GetParameters ListParameters MessageInfo Node ParameterEvent ParameterMsg
        QoSOverridingOptions SetParameters SetParametersAtomically Subscription
        SubscriptionEventCallbacks
    rclpy.parameter_event_handler: CallbackGroup Node ParameterEvent ParameterMsg
        QoSOverridingOptions SubscriptionEventCallbacks
    rclpy.parameter_service: DescribeParameters GetParameterTypes GetParameters ListParameters
        ListParametersResult ParameterUninitializedException SetParameters SetParametersAtomically
        SetParametersResult TOPIC_SEPARATOR_STRING
    rclpy.publisher: CallbackGroup EventHandler MsgType PublisherEventCallbacks QoSProfile
    rclpy.qos: Duration
    rclpy.qos_overriding_options: Parameter ParameterAlreadyDeclaredException ParameterDescriptor
        QoSDurabilityPolicy QoSHistoryPolicy QoSLivelinessPolicy QoSProfile QoSReliabilityPolicy
        SetParametersResult rclpy
    rclpy.serialization: Msg MsgT
    rclpy.service: CallbackGroup Clock QoSProfile ServiceIntrospectionState Srv SrvRequestT
        SrvResponseT SrvType SrvTypeRequest SrvTypeResponse
    rclpy.signals: InvalidHandle
    rclpy.subscription: CallbackGroup MsgType QoSProfile SubscriptionEventCallbacks
    rclpy.time: builtin_interfaces
    rclpy.time_source: SetParametersResult rosgraph_msgs
    rclpy.timer: CallbackGroup Clock Context
    rclpy.type_description_service: GetTypeDescription ParameterDescriptor ParameterType Service
        TOPIC_SEPARATOR_STRING check_is_valid_srv_type qos_profile_services_default
    rclpy.type_support: FeedbackMessage GetResultServiceResponse ServiceEventInfo Time UUID
    rclpy.utilities: ament_index_python
    rclpy.validate_full_topic_name: InvalidServiceNameException InvalidTopicNameException
    rclpy.validate_namespace: InvalidNamespaceException
    rclpy.validate_node_name: InvalidNodeNameException
    rclpy.validate_parameter_name: InvalidParameterException
    rclpy.validate_topic_name: InvalidServiceNameException InvalidTopicNameException
    rclpy.wait_for_message: MsgT Node QoSProfile
    rclpy.qos_event: CallbackGroup NumberOfEntities Waitable get_logger qos_policy_name_from_kind
        rclpy
    message_filters: Duration LoggingSeverity rclpy
    tf2_ros: ActionClient Clock Duration DurabilityPolicy FrameGraph Future Header HistoryPolicy
        JumpThreshold LookupTransform Node PointCloud2 PointStamped PoseStamped
        PoseWithCovarianceStamped QoSProfile ReentrantCallbackGroup SingleThreadedExecutor TFMessage
        Time=rclpy.time.Time TimeJump TransformStamped Vector3Stamped builtin_interfaces rclpy
    tf2_ros.buffer: FrameGraphSrvRequest=tf2_msgs.srv.FrameGraph.Request
        FrameGraphSrvResponse=tf2_msgs.srv.FrameGraph.Response tf2=tf2_py FrameGraph Future
        JumpThreshold Node Time=rclpy.time.Time TimeJump TransformStamped rclpy tf2_ros
    tf2_ros.buffer_client: LookupTransformGoal=tf2_msgs.action.LookupTransform.Goal
        LookupTransformResult=tf2_msgs.action.LookupTransform.Result tf2=tf2_py Clock Node
        Time=rclpy.time.Time TransformStamped LookupTransform builtin_interfaces tf2_ros
    tf2_ros.buffer_interface: tf2=tf2_py Header PointCloud2 PointStamped PoseStamped
        PoseWithCovarianceStamped Time=rclpy.time.Time TransformStamped Vector3Stamped rclpy tf2_ros
    tf2_ros.static_transform_broadcaster: DurabilityPolicy HistoryPolicy Node QoSProfile TFMessage
        TransformStamped
    tf2_ros.transform_broadcaster: Node QoSProfile TFMessage TransformStamped
    tf2_ros.transform_listener: Buffer Node TFMessage tf2_ros
    tf2_geometry_msgs: Point Point32 PointStamped PolygonStamped Pose PoseStamped
        PoseWithCovarianceStamped TransformStamped Vector3Stamped tf2_ros
    tf2_geometry_msgs.tf2_geometry_msgs: Point Point32 PointStamped PolygonStamped Pose PoseStamped
        PoseWithCovarianceStamped TransformStamped Vector3Stamped tf2_ros
    tf2_sensor_msgs: Header PointCloud2 Transform TransformStamped create_cloud read_points tf2_ros
    tf2_sensor_msgs.tf2_sensor_msgs: Header PointCloud2 Transform TransformStamped create_cloud
        read_points tf2_ros
"""
"""The names by the modules of rclpy 9.1.2 and tf2 0.45 that have them, but for those that are here
already; with ``=`` and what it is, where another module has another thing of that name."""

ORIGINS: Final = """
    action_msgs.msg: GoalInfo GoalStatusArray
    action_msgs.srv: CancelGoal
    rclpy._type_names: FeedbackMessage GetResultServiceResponse MsgType SrvType SrvTypeRequest
        SrvTypeResponse
    builtin_interfaces.msg: Time
    geometry_msgs.msg: Point Point32 PointStamped PolygonStamped Pose PoseStamped
        PoseWithCovarianceStamped Transform TransformStamped Vector3Stamped
    rcl_interfaces.msg: FloatingPointRange IntegerRange ListParametersResult LoggerLevel
        ParameterDescriptor ParameterEvent ParameterMsg=Parameter ParameterType ParameterValue
        SetLoggerLevelsResult SetParametersResult
    rcl_interfaces.srv: DescribeParameters GetLoggerLevels GetParameterTypes GetParameters
        ListParameters SetLoggerLevels SetParameters SetParametersAtomically
    rclpy.action.client: ActionClient
    rclpy.callback_groups: CallbackGroup ReentrantCallbackGroup
    rclpy.client: Client
    rclpy.clock: Clock JumpThreshold TimeJump
    rclpy.clock_type: ClockType
    rclpy.constants: S_TO_NS
    rclpy.context: Context
    rclpy.duration: Duration
    rclpy.event_handler: EventHandler PublisherEventCallbacks SubscriptionEventCallbacks
    rclpy.exceptions: InvalidNamespaceException InvalidNodeNameException InvalidParameterException
        InvalidParameterTypeException InvalidParameterValueException InvalidServiceNameException
        InvalidTopicNameException ParameterAlreadyDeclaredException ParameterImmutableException
        ParameterNotDeclaredException ParameterUninitializedException
    rclpy.executors: SingleThreadedExecutor
    rclpy.expand_topic_name: expand_topic_name
    rclpy.guard_condition: GuardCondition
    rclpy.impl.implementation_singleton.rclpy_implementation: InvalidHandle TimerCancelledError
    rclpy.impl.logging_severity: LoggingSeverity
    rclpy.impl.rcutils_logger: RcutilsLogger
    rclpy.logging: get_logger
    rclpy.node: Node
    rclpy.parameter: AllowableParameterValue AllowableParameterValueT PARAMETER_SEPARATOR_STRING
        Parameter
    rclpy.qos: DurabilityPolicy HistoryPolicy QoSDurabilityPolicy QoSHistoryPolicy
        QoSLivelinessPolicy QoSProfile QoSReliabilityPolicy qos_policy_name_from_kind
        qos_profile_rosout_default qos_profile_services_default
    rclpy.qos_overriding_options: QoSOverridingOptions
    rclpy.service: Service
    rclpy.service_introspection: ServiceIntrospectionState
    rclpy.signals: SignalHandlerGuardCondition
    rclpy.subscription: MessageInfo Subscription
    rclpy.subscription_content_filter_options: ContentFilterOptions
    rclpy.task: Future Task
    rclpy.timer: Timer TimerInfo
    rclpy.topic_endpoint_info: TopicEndpointInfo
    rclpy.type_support: Action Msg MsgT Srv SrvRequestT SrvResponseT check_is_valid_srv_type
    rclpy.utilities: timeout_sec_to_nsec
    rclpy.validate_full_topic_name: validate_full_topic_name
    rclpy.validate_namespace: validate_namespace
    rclpy.validate_node_name: validate_node_name
    rclpy.validate_parameter_name: validate_parameter_name
    rclpy.validate_topic_name: TOPIC_SEPARATOR_STRING validate_topic_name
    rclpy.waitable: NumberOfEntities Waitable
    sensor_msgs.msg: PointCloud2
    sensor_msgs_py.point_cloud2: create_cloud read_points
    service_msgs.msg: ServiceEventInfo
    std_msgs.msg: Header
    tf2_msgs.action: LookupTransform
    tf2_msgs.msg: TFMessage
    tf2_msgs.srv: FrameGraph
    tf2_ros.buffer: Buffer
    type_description_interfaces.srv: GetTypeDescription
    unique_identifier_msgs.msg: UUID
"""
"""The module that defines each name, with ``=`` and its name there; all others are modules."""

SUBMODULES: Final = (
    "callback_groups",
    "duration",
    "exceptions",
    "impl",
    "implementation_singleton",
    "logging_severity",
    "rcutils_logger",
)
"""Those of them that are modules in the module that has them."""


def table(text: str) -> dict[str, list[str]]:
    """Return the words after each word that ends in a colon."""
    entries: dict[str, list[str]] = {}
    words: list[str] = []
    for word in text.split():
        if word.endswith(":"):
            words = entries.setdefault(word[:-1], [])
        else:
            words.append(word)
    return entries


BY_MODULE: Final = table(NAMES)


def add_names(name: str) -> None:
    """Let a module, which is being loaded, find its names from elsewhere, and list them."""
    module = sys.modules[name]
    words = [word.partition("=") for word in BY_MODULE.get(name, [])]
    names = {shown: place for shown, _, place in words}

    def find(asked: str) -> Any:
        if asked in names:
            place = names[asked]
            value = loaded(place) if place else value_of(asked, name)
        elif asked in typing.__all__:
            value = getattr(typing, asked)
        elif has_module(module, asked):
            value = import_module(f"{name}.{asked}")
        else:
            raise AttributeError(f"module {name!r} has no attribute {asked!r}")
        vars(module)[asked] = value
        return value

    def listed() -> list[str]:
        return sorted({*vars(module), *names})

    vars(module).update(__getattr__=find, __dir__=listed)


def has_module(package: ModuleType, name: str) -> bool:
    """Return whether a package has a public module of this name.

    In ROS, importing one of them imports most others, and programs take those as attributes:
    ``rclpy.node`` is there after ``from rclpy.action import ActionClient``.
    """
    folder = vars(package).get("__path__")  # not by getattr, which would ask for it here
    if folder is None or name.startswith("_"):
        return False
    return PathFinder.find_spec(f"{package.__name__}.{name}", folder) is not None


def value_of(name: str, module: str) -> Any:
    """Return what a name stands for in a module of rclpy."""
    if name in SUBMODULES:
        return import_module(f"{module}.{name}")
    for origin, words in table(ORIGINS).items():
        for word in words:
            shown, _, inside = word.partition("=")
            if shown == name:
                return getattr(loaded(origin), inside or name)
    return loaded(name)


def loaded(origin: str) -> Any:
    """Return a module by its name in ROS, or a part of one."""
    try:
        return import_module(origin)
    except ModuleNotFoundError:
        parent, _, part = origin.rpartition(".")
        if not parent:
            raise
        return getattr(loaded(parent), part)
