"""Services of autoware_localization_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.autoware_common_msgs.msg import ResponseStatus
from aionode.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped
from aionode.message import DEFAULT, Message, Sequence, ServiceType, uint8, uint16

__all__ = ["InitializeLocalization"]


class InitializeLocalization(
    ServiceType, typename="autoware_localization_msgs/srv/InitializeLocalization"
):
    """InitializeLocalization, as Autoware defines it."""

    class Request(Message):
        """The request of InitializeLocalization."""

        AUTO: ClassVar[uint8] = 0
        DIRECT: ClassVar[uint8] = 1

        pose_with_covariance: Annotated[
            list[PoseWithCovarianceStamped], Sequence[PoseWithCovarianceStamped, 1]
        ] = DEFAULT
        method: uint8 = 0

    class Response(Message):
        """The response of InitializeLocalization."""

        ERROR_UNSAFE: ClassVar[uint16] = 1
        ERROR_GNSS_SUPPORT: ClassVar[uint16] = 2
        ERROR_GNSS: ClassVar[uint16] = 3
        ERROR_ESTIMATION: ClassVar[uint16] = 4

        status: ResponseStatus = DEFAULT
