"""rosbag2_interfaces."""

from aionode.interfaces.builtin_interfaces.msg import Duration, Time
from aionode.message import DEFAULT, Message, ServiceType, float64, int32, uint64


class Burst(ServiceType, typename="rosbag2_interfaces/srv/Burst"):
    """Burst."""

    class Request(Message):
        """Request."""

        num_messages: uint64 = 0

    class Response(Message):
        """Response."""

        actually_burst: uint64 = 0


class GetRate(ServiceType, typename="rosbag2_interfaces/srv/GetRate"):
    """GetRate."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        rate: float64 = 0.0


class IsDiscoveryRunning(ServiceType, typename="rosbag2_interfaces/srv/IsDiscoveryRunning"):
    """IsDiscoveryRunning."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        running: bool = False


class IsPaused(ServiceType, typename="rosbag2_interfaces/srv/IsPaused"):
    """IsPaused."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        paused: bool = False


class Pause(ServiceType, typename="rosbag2_interfaces/srv/Pause"):
    """Pause."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""


class Play(ServiceType, typename="rosbag2_interfaces/srv/Play"):
    """Play."""

    class Request(Message):
        """Request."""

        start_offset: Time = DEFAULT
        playback_duration: Duration = DEFAULT
        playback_until_timestamp: Time = DEFAULT

    class Response(Message):
        """Response."""

        success: bool = False


class PlayNext(ServiceType, typename="rosbag2_interfaces/srv/PlayNext"):
    """PlayNext."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        success: bool = False


class Record(ServiceType, typename="rosbag2_interfaces/srv/Record"):
    """Record."""

    class Request(Message):
        """Request."""

        uri: str = ""

    class Response(Message):
        """Response."""

        return_code: int32 = 0
        error_string: str = ""


class Resume(ServiceType, typename="rosbag2_interfaces/srv/Resume"):
    """Resume."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""


class Seek(ServiceType, typename="rosbag2_interfaces/srv/Seek"):
    """Seek."""

    class Request(Message):
        """Request."""

        time: Time = DEFAULT

    class Response(Message):
        """Response."""

        success: bool = False


class SetRate(ServiceType, typename="rosbag2_interfaces/srv/SetRate"):
    """SetRate."""

    class Request(Message):
        """Request."""

        rate: float64 = 0.0

    class Response(Message):
        """Response."""

        success: bool = False


class Snapshot(ServiceType, typename="rosbag2_interfaces/srv/Snapshot"):
    """Snapshot."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        success: bool = False


class SplitBagfile(ServiceType, typename="rosbag2_interfaces/srv/SplitBagfile"):
    """SplitBagfile."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""


class StartDiscovery(ServiceType, typename="rosbag2_interfaces/srv/StartDiscovery"):
    """StartDiscovery."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        return_code: int32 = 0
        error_string: str = ""


class Stop(ServiceType, typename="rosbag2_interfaces/srv/Stop"):
    """Stop."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""


class StopDiscovery(ServiceType, typename="rosbag2_interfaces/srv/StopDiscovery"):
    """StopDiscovery."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        return_code: int32 = 0
        error_string: str = ""


class TogglePaused(ServiceType, typename="rosbag2_interfaces/srv/TogglePaused"):
    """TogglePaused."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""
