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
    """Have a paused player send messages as fast as it can."""

    class Request(Message):
        """How many to send; 0 sends all that are left."""

        num_messages: uint64 = 0

    class Response(Message):
        """How many were sent."""

        actually_burst: uint64 = 0


class GetRate(ServiceType, typename="rosbag2_interfaces/srv/GetRate"):
    """How fast a player plays."""

    class Request(Message):
        """The request of GetRate."""

    class Response(Message):
        """1 is the speed of the recording."""

        rate: float64 = 0.0


class IsDiscoveryRunning(ServiceType, typename="rosbag2_interfaces/srv/IsDiscoveryRunning"):
    """Whether a recorder looks for new topics."""

    class Request(Message):
        """The request of IsDiscoveryRunning."""

    class Response(Message):
        """Whether it does."""

        running: bool = False


class IsPaused(ServiceType, typename="rosbag2_interfaces/srv/IsPaused"):
    """Whether a player or recorder is paused."""

    class Request(Message):
        """The request of IsPaused."""

    class Response(Message):
        """Whether it is."""

        paused: bool = False


class Pause(ServiceType, typename="rosbag2_interfaces/srv/Pause"):
    """Pause a player or recorder."""

    class Request(Message):
        """The request of Pause."""

    class Response(Message):
        """The response of Pause."""


class Play(ServiceType, typename="rosbag2_interfaces/srv/Play"):
    """Have a player play."""

    class Request(Message):
        """From where, and how long.

        Attributes:
            start_offset: How far from the beginning of the recording to start.
            playback_duration: How long to play; negative means to the end.
            playback_until_timestamp: Recorded time at which to stop; negative means at the end.
        """

        start_offset: Time = DEFAULT
        playback_duration: Duration = DEFAULT
        playback_until_timestamp: Time = DEFAULT

    class Response(Message):
        """Whether it plays."""

        success: bool = False


class PlayNext(ServiceType, typename="rosbag2_interfaces/srv/PlayNext"):
    """Have a paused player send its next message."""

    class Request(Message):
        """The request of PlayNext."""

    class Response(Message):
        """Whether there was one."""

        success: bool = False


class Record(ServiceType, typename="rosbag2_interfaces/srv/Record"):
    """Have a recorder record."""

    class Request(Message):
        """Where to write the recording."""

        uri: str = ""

    class Response(Message):
        """0 if it records, else a number and a text that say why not."""

        return_code: int32 = 0
        error_string: str = ""


class Resume(ServiceType, typename="rosbag2_interfaces/srv/Resume"):
    """Let a paused player or recorder go on."""

    class Request(Message):
        """The request of Resume."""

    class Response(Message):
        """The response of Resume."""


class Seek(ServiceType, typename="rosbag2_interfaces/srv/Seek"):
    """Have a player jump."""

    class Request(Message):
        """To which recorded time."""

        time: Time = DEFAULT

    class Response(Message):
        """Whether the recording has that time."""

        success: bool = False


class SetRate(ServiceType, typename="rosbag2_interfaces/srv/SetRate"):
    """Set how fast a player plays."""

    class Request(Message):
        """1 is the speed of the recording; it has to be more than 0."""

        rate: float64 = 0.0

    class Response(Message):
        """Whether it was set."""

        success: bool = False


class Snapshot(ServiceType, typename="rosbag2_interfaces/srv/Snapshot"):
    """Have a recorder write what it keeps in memory."""

    class Request(Message):
        """The request of Snapshot."""

    class Response(Message):
        """Whether it did."""

        success: bool = False


class SplitBagfile(ServiceType, typename="rosbag2_interfaces/srv/SplitBagfile"):
    """Have a recorder go on in a new file."""

    class Request(Message):
        """The request of SplitBagfile."""

    class Response(Message):
        """The response of SplitBagfile."""


class StartDiscovery(ServiceType, typename="rosbag2_interfaces/srv/StartDiscovery"):
    """Have a recorder look for new topics."""

    class Request(Message):
        """The request of StartDiscovery."""

    class Response(Message):
        """0 if it does, else a number and a text that say why not."""

        return_code: int32 = 0
        error_string: str = ""


class Stop(ServiceType, typename="rosbag2_interfaces/srv/Stop"):
    """Stop a player or recorder."""

    class Request(Message):
        """The request of Stop."""

    class Response(Message):
        """The response of Stop."""


class StopDiscovery(ServiceType, typename="rosbag2_interfaces/srv/StopDiscovery"):
    """Have a recorder stop looking for new topics."""

    class Request(Message):
        """The request of StopDiscovery."""

    class Response(Message):
        """0 if it stopped, else a number and a text that say why not."""

        return_code: int32 = 0
        error_string: str = ""


class TogglePaused(ServiceType, typename="rosbag2_interfaces/srv/TogglePaused"):
    """Pause a player or recorder, or let it go on."""

    class Request(Message):
        """The request of TogglePaused."""

    class Response(Message):
        """The response of TogglePaused."""
