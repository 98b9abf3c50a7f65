"""Messages of statistics_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message, Sequence, float64, uint8

__all__ = ["MetricsMessage", "StatisticDataPoint", "StatisticDataType"]


class StatisticDataPoint(Message, typename="statistics_msgs/msg/StatisticDataPoint"):
    """One number of a statistic; `data_type` is a constant of StatisticDataType."""

    data_type: uint8 = 0
    data: float64 = 0.0


class MetricsMessage(Message, typename="statistics_msgs/msg/MetricsMessage"):
    """Statistics of one quantity over a span of time.

    Attributes:
        measurement_source_name: Which node measured.
        metrics_source: What was measured, such as ``message_age``.
        unit: Of the numbers, such as ``ms``.
        window_start: When measuring began.
        window_stop: When it ended.
        statistics: The numbers.
    """

    measurement_source_name: str = ""
    metrics_source: str = ""
    unit: str = ""
    window_start: Time = DEFAULT
    window_stop: Time = DEFAULT
    statistics: Annotated[list[StatisticDataPoint], Sequence[StatisticDataPoint]] = DEFAULT


class StatisticDataType(Message, typename="statistics_msgs/msg/StatisticDataType"):
    """Kinds of numbers in a statistic, as constants."""

    STATISTICS_DATA_TYPE_UNINITIALIZED: ClassVar[uint8] = 0
    STATISTICS_DATA_TYPE_AVERAGE: ClassVar[uint8] = 1
    STATISTICS_DATA_TYPE_MINIMUM: ClassVar[uint8] = 2
    STATISTICS_DATA_TYPE_MAXIMUM: ClassVar[uint8] = 3
    STATISTICS_DATA_TYPE_STDDEV: ClassVar[uint8] = 4
    STATISTICS_DATA_TYPE_SAMPLE_COUNT: ClassVar[uint8] = 5
