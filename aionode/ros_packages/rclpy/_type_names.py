"""Names that rclpy has for type checkers, and which programs import for their annotations.

None has fields, as type checkers do not see them: a program finds them when it runs.
"""

from __future__ import annotations

from typing import Protocol, TypeVar

__all__ = [
    "FeedbackMessage",
    "GetResultServiceResponse",
    "MsgType",
    "SrvType",
    "SrvTypeRequest",
    "SrvTypeResponse",
]

MsgType = TypeVar("MsgType")
SrvType = TypeVar("SrvType")
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")
Result_co = TypeVar("Result_co", covariant=True)
Feedback_co = TypeVar("Feedback_co", covariant=True)


class GetResultServiceResponse(Protocol[Result_co]):
    """The answer to the request for the result of a goal."""


class FeedbackMessage(Protocol[Feedback_co]):
    """The feedback of a goal."""
