"""``topic_tools demux``: republishes a topic on one of several others, selected by services."""

from __future__ import annotations

from typing import Any, Final

from aionode.programs._topic_tools.mux import Selector, run_selector, services_of

__all__ = ["SERVICES", "Demux", "main"]

SERVICES: Final = services_of("demux")
"""The types of the services."""


class Demux(Selector):
    """Publishes the messages of its input on the selected output, initially the first one.

    Args:
        *words: The input topic, and the outputs; fewer than two are ignored.
    """

    def __init__(self, *words: str) -> None:
        given: dict[str, Any] = {}
        if len(words) > 1:
            given = {"input_topic": words[0], "output_topics": list(words[1:])}
        super().__init__("demux", SERVICES, given)
        self.input_topic = self.declare_parameter("input_topic", "~/input").value
        self.declare_selection("output_topics")

    def use(self, topic: str) -> None:
        """Switch to another output."""
        super().use(topic)
        self.forget()
        self.output_topic = topic


def main() -> None:
    """Run the node until Ctrl-C."""
    run_selector(Demux, "demux <intopic> <outtopic1> [outtopic2...]")
