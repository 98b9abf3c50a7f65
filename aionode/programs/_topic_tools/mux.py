"""``topic_tools mux``: republishes one of several topics, selected by services, on another one."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any, Final

import aionode
from aionode import Parameter
from aionode.arguments import remove_ros_args
from aionode.errors import CommandError
from aionode.idl import define
from aionode.programs._topic_tools.any_type import AnyTypeNode

__all__ = ["SERVICES", "Mux", "Selector", "main", "run_selector", "services_of"]

NONE_TOPIC: Final = "__none"
"""The name that selects no topic."""


MAX_TOPICS: Final = 1000


def services_of(tool: str) -> dict[str, Any]:
    """Return the service types of ``mux`` or ``demux``, by their names below the node's name."""
    prefix = f"topic_tools_interfaces/srv/{tool.capitalize()}"
    return {
        "add": define(f"{prefix}Add", "string topic\n---\nbool success"),
        "delete": define(f"{prefix}Delete", "string topic\n---\nbool success"),
        "list": define(f"{prefix}List", "---\nstring[] topics"),
        "select": define(f"{prefix}Select", "string topic\n---\nstring prev_topic\nbool success"),
    }


SERVICES: Final = services_of("mux")
"""The types of the services."""


class Selector(AnyTypeNode):
    """Keeps one of several topics selected, and serves requests to change the selection.

    Args:
        tool: ``mux`` or ``demux``.
        services: The types of its services.
        given: The parameters given as arguments.

    Attributes:
        topics: The topics that can be selected.
        selected: The selected topic.
    """

    def __init__(self, tool: str, services: dict[str, Any], given: dict[str, Any]) -> None:
        super().__init__(tool, given)
        self.tool = tool
        self.topics: list[str] = []
        self.selected = NONE_TOPIC
        callbacks = {
            "add": self.add,
            "delete": self.delete,
            "list": self.list_topics,
            "select": self.select,
        }
        for name, callback in callbacks.items():
            self.create_service(services[name], f"~/{name}", callback)

    def declare_selection(self, name: str) -> None:
        """Declare the topics and the initial selection.

        Raises:
            CommandError: There is no topic.
        """
        initial = self.declare_parameter("initial_topic", "").value
        self.topics = list(self.needed(name, Parameter.Type.STRING_ARRAY))
        if not self.topics:
            raise CommandError(f"{name} is empty; name a topic")
        self.use(initial or self.topics[0])

    def use(self, topic: str) -> None:
        """Select a topic."""
        self.selected = topic

    async def discover(self) -> None:
        """Find the publishers of the input, if a topic is selected."""
        if self.selected == NONE_TOPIC:
            self.forget()
        else:
            await super().discover()

    def known(self, topic: str) -> str | None:
        """Return the known topic that a name resolves to."""
        full = self.resolve_topic_name(topic)
        return next((each for each in self.topics if self.resolve_topic_name(each) == full), None)

    def add(self, request: Any, response: Any) -> Any:
        """Add a topic."""
        topic, log = request.topic, self.get_logger()
        log.info(f"trying to add {topic} to {self.tool}")
        if topic == NONE_TOPIC:
            log.warning(
                f"failed to add topic {topic} to {self.tool}, because it's reserved for special use"
            )
        elif len(self.topics) >= MAX_TOPICS:
            log.warning(f"failed to add topic {topic} to {self.tool}, which has {MAX_TOPICS}")
        elif topic in self.topics:
            log.warning(
                f"tried to add a topic that {self.tool} was already listening to: [{topic}]"
            )
        else:
            self.resolve_topic_name(topic)  # refuses invalid names, and its client gets the reason
            self.topics.append(topic)
            log.info(f"added {topic} to {self.tool}")
            response.success = True
        return response

    def delete(self, request: Any, response: Any) -> Any:
        """Remove a topic that is not selected."""
        topic, log = request.topic, self.get_logger()
        log.info(f"trying to delete {topic} to {self.tool}")
        known = self.known(topic)
        if known is None:
            log.warning(f"tried to delete non-subscribed topic {topic} from {self.tool}")
        elif self.selected != NONE_TOPIC and known == self.known(self.selected):
            log.warning(f"tried to delete currently selected topic {topic} from {self.tool}")
        else:
            self.topics.remove(known)
            log.info(f"deleted topic {topic} from {self.tool}")
            response.success = True
        return response

    def list_topics(self, _request: Any, response: Any) -> Any:
        """List the topics."""
        response.topics = self.topics
        return response

    async def select(self, request: Any, response: Any) -> Any:
        """Select a topic, or none."""
        topic, log = request.topic, self.get_logger()
        if self.selected != NONE_TOPIC and self.known(self.selected) is not None:
            response.prev_topic = self.selected
        if topic == NONE_TOPIC:
            log.info(f"{self.tool} selected to no input.")
            self.selected = NONE_TOPIC
        else:
            log.info(f"trying to switch {self.tool} to {topic}")
            if self.known(topic) is None:
                return response
            self.use(topic)
            log.info(f"{self.tool} selected input: [{topic}]")
        response.success = True
        await self.discover()
        return response


class Mux(Selector):
    """Publishes the messages of the selected input, which is initially the first one.

    Args:
        *words: The output topic, and the inputs; fewer than two are ignored.
    """

    def __init__(self, *words: str) -> None:
        given: dict[str, Any] = {}
        if len(words) > 1:
            given = {"output_topic": words[0], "input_topics": list(words[1:])}
        super().__init__("mux", SERVICES, given)
        self.output_topic = self.declare_parameter("output_topic", "~/selected").value
        self.is_lazy = self.declare_parameter("lazy", False).value
        self.declare_selection("input_topics")

    def use(self, topic: str) -> None:
        """Switch to another input."""
        super().use(topic)
        self.listen(topic)


def run_selector(make: Callable[..., Selector], usage: str) -> None:
    """Run a node, made with the words of the command line, until Ctrl-C.

    Raises:
        SystemExit: With status 1, if there are too few arguments.
    """
    words = remove_ros_args(sys.argv)[1:]
    if len(words) < 2:
        sys.stderr.write(f"Incorrect number of arguments. Usage: aionode run topic_tools {usage}\n")
        raise SystemExit(1)
    aionode.run(lambda: make(*words))


def main() -> None:
    """Run the node until Ctrl-C."""
    run_selector(Mux, "mux <outtopic> <intopic1> [intopic2...]")
