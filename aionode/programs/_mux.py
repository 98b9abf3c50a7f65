"""``topic_tools mux``: one of several topics is published on another one; services say which."""

from __future__ import annotations

import sys
from typing import Any, Final

import aionode
from aionode import Parameter
from aionode.arguments import remove_ros_args
from aionode.errors import CommandError
from aionode.idl import define
from aionode.programs._any_type import AnyTypeNode

__all__ = ["SERVICES", "Mux", "main"]

NONE_TOPIC: Final = "__none"
"""Stands for no topic."""

PREFIX: Final = "topic_tools_interfaces/srv/Mux"

SERVICES: Final[dict[str, Any]] = {
    "add": define(f"{PREFIX}Add", "string topic\n---\nbool success"),
    "delete": define(f"{PREFIX}Delete", "string topic\n---\nbool success"),
    "list": define(f"{PREFIX}List", "---\nstring[] topics"),
    "select": define(f"{PREFIX}Select", "string topic\n---\nstring prev_topic\nbool success"),
}
"""The types of the services, by their names below the node's."""


class Mux(AnyTypeNode):
    """Publishes the messages of the input that is selected; the first one at the beginning.

    Args:
        *words: The output topic, and the inputs; fewer than two say nothing.
    """

    def __init__(self, *words: str) -> None:
        given: dict[str, Any] = {}
        if len(words) > 1:
            given = {"output_topic": words[0], "input_topics": list(words[1:])}
        super().__init__("mux", given)
        initial = self.declare_parameter("initial_topic", "").value
        self.output_topic = self.declare_parameter("output_topic", "~/selected").value
        self.is_lazy = self.declare_parameter("lazy", False).value
        self.inputs: list[str] = list(self.needed("input_topics", Parameter.Type.STRING_ARRAY))
        if not self.inputs:
            raise CommandError("input_topics is empty; name a topic")
        self.input_topic = initial or self.inputs[0]
        for name, callback in (
            ("add", self.add),
            ("delete", self.delete),
            ("list", self.list_inputs),
            ("select", self.select),
        ):
            self.create_service(SERVICES[name], f"~/{name}", callback)

    async def discover(self) -> None:
        """Find the publishers of the input, if one is selected."""
        if self.input_topic == NONE_TOPIC:
            self.forget()
        else:
            await super().discover()

    def known(self, topic: str) -> str | None:
        """Return an input by its name, however it is written."""
        full = self.resolve_topic_name(topic)
        return next((each for each in self.inputs if self.resolve_topic_name(each) == full), None)

    def add(self, request: Any, response: Any) -> Any:
        """Add an input."""
        topic, log = request.topic, self.get_logger()
        log.info(f"trying to add {topic} to mux")
        if topic == NONE_TOPIC:
            log.warning(
                f"failed to add topic {topic} to mux, because it's reserved for special use"
            )
        elif topic in self.inputs:
            log.warning(f"tried to add a topic that mux was already listening to: [{topic}]")
        else:
            self.resolve_topic_name(topic)  # refuses what is no name, and its client is told
            self.inputs.append(topic)
            log.info(f"added {topic} to mux")
            response.success = True
        return response

    def delete(self, request: Any, response: Any) -> Any:
        """Remove an input that is not selected."""
        topic, log = request.topic, self.get_logger()
        log.info(f"trying to delete {topic} to mux")
        known = self.known(topic)
        if known is None:
            log.warning(f"tried to delete non-subscribed topic {topic} from mux")
        elif self.input_topic != NONE_TOPIC and known == self.known(self.input_topic):
            log.warning(f"tried to delete currently selected topic {topic} from mux")
        else:
            self.inputs.remove(known)
            log.info(f"deleted topic {topic} from mux")
            response.success = True
        return response

    def list_inputs(self, _request: Any, response: Any) -> Any:
        """List the inputs."""
        response.topics = self.inputs
        return response

    async def select(self, request: Any, response: Any) -> Any:
        """Select an input, or none."""
        topic, log = request.topic, self.get_logger()
        if self.input_topic != NONE_TOPIC and self.known(self.input_topic) is not None:
            response.prev_topic = self.input_topic
        if topic == NONE_TOPIC:
            log.info("mux selected to no input.")
            self.input_topic = NONE_TOPIC
        else:
            log.info(f"trying to switch mux to {topic}")
            if self.known(topic) is None:
                return response
            self.listen(topic)
            log.info(f"mux selected input: [{topic}]")
        response.success = True
        await self.discover()
        return response


def main() -> None:
    """Run the node until Ctrl-C.

    Raises:
        SystemExit: With status 1: there are too few arguments.
    """
    words = remove_ros_args(sys.argv)[1:]
    if len(words) < 2:
        sys.stderr.write(
            "Incorrect number of arguments. Usage: "
            "aionode run topic_tools mux <outtopic> <intopic1> [intopic2...]\n"
        )
        raise SystemExit(1)
    aionode.run(lambda: Mux(*words))
