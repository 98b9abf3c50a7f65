"""The base classes of services and actions, and the types that implement them."""

from __future__ import annotations

from types import new_class
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeAlias, TypeVar

from aionode.message._field_types import Sequence, int8
from aionode.message._message import Message, MessageMeta
from aionode.message.type_names import TYPES_BY_NAME, checked_type_name

__all__ = ["ActionClass", "ActionType", "Interface", "ServiceClass", "ServiceType"]


class Hidden:
    """A class attribute of a service or action type that is created on first access."""

    def __init__(self, make: Any) -> None:
        self.make = make

    def __set_name__(self, owner: type, name: str) -> None:
        """Store the name of the attribute."""
        self.name = name

    def __get__(self, instance: object, owner: type) -> Any:
        """Return the value of the attribute for `owner`, and cache it there."""
        part = self.make(owner)
        setattr(owner, self.name, part)
        return part


def name_halves(cls: type, typename: str, halves: tuple[str, ...], *, by_name: bool) -> None:
    """Set the ROS names of a service or action class and its nested messages."""
    cls.__ros_type__ = checked_type_name(typename)  # type: ignore[attr-defined] # both declare it
    for half in halves:
        message = cls.__dict__.get(half)
        if not isinstance(message, MessageMeta):
            msg = f"{typename}: needs a nested class {half}(Message), even one without fields"
            raise TypeError(msg)
        message.__ros_type__ = f"{typename}_{half}"  # type: ignore[attr-defined] # of Message
    if by_name:
        TYPES_BY_NAME[typename] = cls


def make_event(cls: type[ServiceType]) -> type[Message]:
    """Create the service event message, which reports one request or response of a service."""
    # Imported on first use, as generated modules import this one.
    from aionode.interfaces.service_msgs.msg import ServiceEventInfo

    namespace = {
        "__module__": cls.__module__,
        "__qualname__": f"{cls.__qualname__}.Event",
        "__doc__": f"A request to or a response of {cls.__name__}, with its client and time.",
        "__annotations__": {
            "info": ServiceEventInfo,
            "request": Sequence[cls.Request, 1],
            "response": Sequence[cls.Response, 1],
        },
    }
    name = f"{cls.__ros_type__}_Event"
    return MessageMeta("Event", (Message,), namespace, typename=name, by_name=False)  # type: ignore[return-value] # a class of Message


class ServiceType:
    """Base class of all service types, with nested messages `Request` and `Response`.

    Write a service as a class::

        class Add(ServiceType, typename="tutorial/srv/Add"):
            class Request(Message):
                a: int64 = 0
                b: int64 = 0

            class Response(Message):
                sum: int64 = 0

    `Event` is the message of service introspection.
    """

    __ros_type__: ClassVar[str] = ""
    Event: ClassVar[Any] = Hidden(make_event)
    if TYPE_CHECKING:  # so that type[ServiceType] is a ServiceClass
        Request: ClassVar[type[Message]]
        Response: ClassVar[type[Message]]

    def __init_subclass__(cls, *, typename: str, by_name: bool = True) -> None:
        """Set the ROS names of the service and its messages."""
        name_halves(cls, typename, ("Request", "Response"), by_name=by_name)


def make_impl(cls: type[ActionType]) -> type:
    """Create the class of the services and messages that implement an action."""
    # Imported on first use, as generated modules import this one.
    from aionode.interfaces.action_msgs.msg import GoalStatusArray
    from aionode.interfaces.action_msgs.srv import CancelGoal
    from aionode.interfaces.builtin_interfaces.msg import Time
    from aionode.interfaces.unique_identifier_msgs.msg import UUID

    place = f"{cls.__qualname__}.Impl"

    def message(name: str, annotations: dict[str, Any], doc: str, typename: str = "") -> Any:
        namespace = {
            "__module__": cls.__module__,
            "__qualname__": f"{place}.{name}",
            "__doc__": doc,
            "__annotations__": annotations,
        }
        short_name = name.rpartition(".")[2]
        return MessageMeta(short_name, (Message,), namespace, typename=typename, by_name=False)

    def service(name: str, request: dict[str, Any], response: dict[str, Any]) -> Any:
        typename = f"{cls.__ros_type__}_{name.removesuffix('Service')}"
        namespace = {
            "__module__": cls.__module__,
            "__qualname__": f"{place}.{name}",
            "__doc__": f"The service {typename}.",
            "Request": message(f"{name}.Request", request, f"A request to {typename}."),
            "Response": message(f"{name}.Response", response, f"A response of {typename}."),
        }
        options = {"typename": typename, "by_name": False}
        return new_class(name, (ServiceType,), options, lambda ns: ns.update(namespace))

    parts = {
        "__module__": cls.__module__,
        "__qualname__": place,
        "__doc__": f"The services and messages that implement {cls.__ros_type__}.",
        "SendGoalService": service(
            "SendGoalService",
            {"goal_id": UUID, "goal": cls.Goal},
            {"accepted": bool, "stamp": Time},
        ),
        "GetResultService": service(
            "GetResultService",
            {"goal_id": UUID},
            {"status": int8, "result": cls.Result},
        ),
        "FeedbackMessage": message(
            "FeedbackMessage",
            {"goal_id": UUID, "feedback": cls.Feedback},
            "Feedback, and the goal that it belongs to.",
            f"{cls.__ros_type__}_FeedbackMessage",
        ),
        "CancelGoalService": CancelGoal,
        "GoalStatusMessage": GoalStatusArray,
    }
    return type("Impl", (), parts)


class ActionType:
    """Base class of all action types, with nested messages `Goal`, `Result` and `Feedback`.

    `Impl` has the types that only the action protocol uses, named as in rclpy:
    `SendGoalService`, `GetResultService`, `CancelGoalService`, `FeedbackMessage` and
    `GoalStatusMessage`.
    """

    __ros_type__: ClassVar[str] = ""
    Impl: ClassVar[Any] = Hidden(make_impl)
    if TYPE_CHECKING:  # so that type[ActionType] is an ActionClass
        Goal: ClassVar[type[Message]]
        Result: ClassVar[type[Message]]
        Feedback: ClassVar[type[Message]]

    def __init_subclass__(cls, *, typename: str, by_name: bool = True) -> None:
        """Set the ROS names of the action and its messages."""
        name_halves(cls, typename, ("Goal", "Result", "Feedback"), by_name=by_name)


Interface: TypeAlias = Message | ServiceType | ActionType
"""Any class that has a ROS type name."""

Request_co = TypeVar("Request_co", bound=Message, covariant=True)
Response_co = TypeVar("Response_co", bound=Message, covariant=True)
Goal_co = TypeVar("Goal_co", bound=Message, covariant=True)
Result_co = TypeVar("Result_co", bound=Message, covariant=True)
Feedback_co = TypeVar("Feedback_co", bound=Message, covariant=True)


# mypy does not let a class that is nested in a class object stand for a property, and pyright takes
# the result of a method for no class. So each sees the form that it understands.
MYPY = False

if TYPE_CHECKING and MYPY:

    class ServiceClass(Protocol[Request_co, Response_co]):
        def Request(self, *args: Any, **values: Any) -> Request_co: ...  # noqa: N802  # a class
        def Response(self, *args: Any, **values: Any) -> Response_co: ...  # noqa: N802  # a class

    class ActionClass(Protocol[Goal_co, Result_co, Feedback_co]):
        def Goal(self, *args: Any, **values: Any) -> Goal_co: ...  # noqa: N802  # a class
        def Result(self, *args: Any, **values: Any) -> Result_co: ...  # noqa: N802  # a class
        def Feedback(self, *args: Any, **values: Any) -> Feedback_co: ...  # noqa: N802  # a class

else:

    class ServiceClass(Protocol[Request_co, Response_co]):
        """For type checkers: a service type, with its request and response types.

        ``def create_client(self, srv_type: ServiceClass[RequestT, ResponseT], …)`` infers both
        types from ``AddTwoInts``. ``ServiceClass[Message, Message]`` is any service: what
        `Node.find_service` returns, with ``.Request`` and ``.Response`` as message classes.
        """

        @property
        def Request(self) -> type[Request_co]: ...  # noqa: N802  # a class
        @property
        def Response(self) -> type[Response_co]: ...  # noqa: N802  # a class

    class ActionClass(Protocol[Goal_co, Result_co, Feedback_co]):
        """For type checkers: an action type, with its goal, result and feedback types."""

        @property
        def Goal(self) -> type[Goal_co]: ...  # noqa: N802  # a class
        @property
        def Result(self) -> type[Result_co]: ...  # noqa: N802  # a class
        @property
        def Feedback(self) -> type[Feedback_co]: ...  # noqa: N802  # a class
