"""Services of rosbag2_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.message import DEFAULT, Message, ServiceType, float64, int32, uint64

__all__ = [
    "Burst",
    "GetRate",
    "IsDiscoveryRunning",
    "IsPaused",
    "Pause",
    "Play",
    "PlayNext",
    "Record",
    "Resume",
    "Seek",
    "SetRate",
    "Snapshot",
    "SplitBagfile",
    "StartDiscovery",
    "Stop",
    "StopDiscovery",
    "TogglePaused",
]


class Burst(ServiceType, typename="rosbag2_interfaces/srv/Burst"):
    """Burst."""

    class Request(Message):
        """The request of Burst."""

        num_messages: uint64 = 0

    class Response(Message):
        """The response of Burst."""

        actually_burst: uint64 = 0


class GetRate(ServiceType, typename="rosbag2_interfaces/srv/GetRate"):
    """GetRate."""

    class Request(Message):
        """The request of GetRate."""

    class Response(Message):
        """The response of GetRate."""

        rate: float64 = 0.0


class IsDiscoveryRunning(ServiceType, typename="rosbag2_interfaces/srv/IsDiscoveryRunning"):
    """IsDiscoveryRunning."""

    class Request(Message):
        """The request of IsDiscoveryRunning."""

    class Response(Message):
        """The response of IsDiscoveryRunning."""

        running: bool = False


class IsPaused(ServiceType, typename="rosbag2_interfaces/srv/IsPaused"):
    """IsPaused."""

    class Request(Message):
        """The request of IsPaused."""

    class Response(Message):
        """The response of IsPaused."""

        paused: bool = False


class Pause(ServiceType, typename="rosbag2_interfaces/srv/Pause"):
    """Pause."""

    class Request(Message):
        """The request of Pause."""

    class Response(Message):
        """The response of Pause."""


class Play(ServiceType, typename="rosbag2_interfaces/srv/Play"):
    """Play."""

    class Request(Message):
        """The request of Play."""

        start_offset: Time = DEFAULT
        playback_duration: Duration = DEFAULT
        playback_until_timestamp: Time = DEFAULT

    class Response(Message):
        """The response of Play."""

        success: bool = False


class PlayNext(ServiceType, typename="rosbag2_interfaces/srv/PlayNext"):
    """PlayNext."""

    class Request(Message):
        """The request of PlayNext."""

    class Response(Message):
        """The response of PlayNext."""

        success: bool = False


class Record(ServiceType, typename="rosbag2_interfaces/srv/Record"):
    """Record."""

    class Request(Message):
        """The request of Record."""

        uri: str = ""

    class Response(Message):
        """The response of Record."""

        return_code: int32 = 0
        error_string: str = ""


class Resume(ServiceType, typename="rosbag2_interfaces/srv/Resume"):
    """Resume."""

    class Request(Message):
        """The request of Resume."""

    class Response(Message):
        """The response of Resume."""


class Seek(ServiceType, typename="rosbag2_interfaces/srv/Seek"):
    """Seek."""

    class Request(Message):
        """The request of Seek."""

        time: Time = DEFAULT

    class Response(Message):
        """The response of Seek."""

        success: bool = False


class SetRate(ServiceType, typename="rosbag2_interfaces/srv/SetRate"):
    """SetRate."""

    class Request(Message):
        """The request of SetRate."""

        rate: float64 = 0.0

    class Response(Message):
        """The response of SetRate."""

        success: bool = False


class Snapshot(ServiceType, typename="rosbag2_interfaces/srv/Snapshot"):
    """Snapshot."""

    class Request(Message):
        """The request of Snapshot."""

    class Response(Message):
        """The response of Snapshot."""

        success: bool = False


class SplitBagfile(ServiceType, typename="rosbag2_interfaces/srv/SplitBagfile"):
    """SplitBagfile."""

    class Request(Message):
        """The request of SplitBagfile."""

    class Response(Message):
        """The response of SplitBagfile."""


class StartDiscovery(ServiceType, typename="rosbag2_interfaces/srv/StartDiscovery"):
    """StartDiscovery."""

    class Request(Message):
        """The request of StartDiscovery."""

    class Response(Message):
        """The response of StartDiscovery."""

        return_code: int32 = 0
        error_string: str = ""


class Stop(ServiceType, typename="rosbag2_interfaces/srv/Stop"):
    """Stop."""

    class Request(Message):
        """The request of Stop."""

    class Response(Message):
        """The response of Stop."""


class StopDiscovery(ServiceType, typename="rosbag2_interfaces/srv/StopDiscovery"):
    """StopDiscovery."""

    class Request(Message):
        """The request of StopDiscovery."""

    class Response(Message):
        """The response of StopDiscovery."""

        return_code: int32 = 0
        error_string: str = ""


class TogglePaused(ServiceType, typename="rosbag2_interfaces/srv/TogglePaused"):
    """TogglePaused."""

    class Request(Message):
        """The request of TogglePaused."""

    class Response(Message):
        """The response of TogglePaused."""
