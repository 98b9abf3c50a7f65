"""Services of object_recognition_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.object_recognition_msgs.msg import ObjectInformation, ObjectType
from aionode.message import DEFAULT, Message, ServiceType

__all__ = ["GetObjectInformation"]


class GetObjectInformation(
    ServiceType, typename="object_recognition_msgs/srv/GetObjectInformation"
):
    """GetObjectInformation, as object_recognition defines it."""

    class Request(Message):
        """The request of GetObjectInformation."""

        type: ObjectType = DEFAULT

    class Response(Message):
        """The response of GetObjectInformation."""

        information: ObjectInformation = DEFAULT
