"""tf2_msgs."""

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.interfaces.tf2_msgs.msg import TF2Error
from aionode.message import ActionType, DEFAULT, Message


class LookupTransform(ActionType, typename="tf2_msgs/action/LookupTransform"):
    """LookupTransform."""

    class Goal(Message):
        """Goal."""

        target_frame: str = ""
        source_frame: str = ""
        source_time: Time = DEFAULT
        timeout: Duration = DEFAULT
        target_time: Time = DEFAULT
        fixed_frame: str = ""
        advanced: bool = False

    class Result(Message):
        """Result."""

        transform: TransformStamped = DEFAULT
        error: TF2Error = DEFAULT

    class Feedback(Message):
        """Feedback."""
