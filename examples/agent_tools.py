#!/usr/bin/env python3
"""Offer what a robot can do as tools to a language model of any kind.

Here lines of JSON stand for the model: ``{"tool": "call_add_two_ints", "input": {"a": 1}}`` from
standard input, and the results go to standard output, after a line with the tools.
"""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Awaitable, Callable
from typing import Any, NamedTuple

import aionode
from aionode import Node
from aionode.errors import AionodeError
from aionode.message import documentation, from_builtins, json_schema, summarize


class Tool(NamedTuple):
    """The description of a tool for a model, and the function that runs it."""

    definition: dict[str, Any]
    run: Callable[[dict[str, Any]], Awaitable[dict[str, Any]]]


async def tools_of(node: Node) -> dict[str, Tool]:
    """Return a tool for each service and action, and one for the next message of each topic."""
    tools: dict[str, Tool] = {}
    offered = node.graph.offered()

    def add(verb: str, name: str, about: str, schema: Any, run: Any) -> None:
        tool = f"{verb}{name.replace('/', '_')}"[:64]
        about = f"{name}: {about}"
        tools[tool] = Tool({"name": tool, "description": about, "input_schema": schema}, run)

    for name, (type_name, *_) in offered.services.items():
        service = await node.find_service(type_name)
        client = node.create_client(service, name)
        add("call", name, *described(service, service.Request), answering(client, service.Request))
    for name, (type_name, *_) in offered.actions.items():
        action = await node.find_action(type_name)
        doer = node.create_action_client(action, name)
        add("do", name, *described(action, action.Goal), answering(doer, action.Goal))
    for name, (type_name, *_) in offered.topics.items():
        message = await node.find_message(type_name)
        about, _ = described(message, message)
        add("read", name, about, {"type": "object", "properties": {}}, reading(node, message, name))
    return tools


def described(interface: Any, asked: Any) -> tuple[str, dict[str, Any]]:
    """Return the description of a type, and the JSON schema of its request, goal or message."""
    return documentation(interface)[0], json_schema(asked)


def answering(client: Any, asked: Any) -> Any:
    """Return a function that calls a service or executes a goal with a model's values."""

    async def run(given: dict[str, Any]) -> dict[str, Any]:
        async with asyncio.timeout(30):  # which cancels a goal
            return summarize(await client.call(from_builtins(asked, given)), limit=4000)

    return run


def reading(node: Node, message: Any, topic: str) -> Any:
    """Return a function that waits for the next message of a topic."""

    async def run(_: dict[str, Any]) -> dict[str, Any]:
        subscription = node.create_subscription(message, topic)
        try:
            async with asyncio.timeout(5):
                return summarize(await subscription.receive(), limit=4000)
        finally:
            subscription.destroy()

    return run


async def answer(tools: dict[str, Tool], asked: dict[str, Any]) -> dict[str, Any]:
    """Run a tool; an error is returned as a text from which the model can correct its input."""
    if asked.get("tool") not in tools:
        return {"error": f"there is no tool {asked.get('tool')!r}; there are {', '.join(tools)}"}
    try:
        return await tools[asked["tool"]].run(asked.get("input", {}))
    except (AionodeError, TimeoutError) as error:
        return {"error": str(error) or "it has not answered in time"}


async def lines_of_model() -> asyncio.StreamReader:
    """Return the lines of standard input; a real program would query the model here."""
    reader, loop = asyncio.StreamReader(), asyncio.get_running_loop()
    await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), sys.stdin)
    return reader


async def main() -> None:
    """Answer one line after the other."""
    async with Node("assistant") as node:
        await node.get_clock().sleep(1.0)  # until the nodes of the robot are found
        tools = await tools_of(node)
        print(json.dumps([tool.definition for tool in tools.values()]), flush=True)
        async for line in await lines_of_model():
            print(json.dumps(await answer(tools, json.loads(line))), flush=True)


if __name__ == "__main__":
    aionode.run(main)
