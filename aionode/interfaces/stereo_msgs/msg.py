"""Messages of stereo_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.sensor_msgs.msg import Image, RegionOfInterest
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import DEFAULT, Message, float32

__all__ = ["DisparityImage"]


class DisparityImage(Message, typename="stereo_msgs/msg/DisparityImage"):
    """How far each pixel is shifted between two cameras; depth is `f` times `t` / shift.

    Attributes:
        header: Time and frame of the left camera.
        image: The shifts, in pixels, as floats.
        f: Focal length, in pixels.
        t: Distance between the cameras, in m.
        valid_window: The part of the image in which shifts can be found.
        min_disparity: Smallest shift searched for, in pixels.
        max_disparity: Largest shift searched for, in pixels.
        delta_d: Smallest step between shifts, in pixels.
    """

    header: Header = DEFAULT
    image: Image = DEFAULT
    f: float32 = 0.0
    t: float32 = 0.0
    valid_window: RegionOfInterest = DEFAULT
    min_disparity: float32 = 0.0
    max_disparity: float32 = 0.0
    delta_d: float32 = 0.0
