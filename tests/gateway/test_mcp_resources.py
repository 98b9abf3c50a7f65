"""What a client reads of a robot without a tool: resources, events, and the prompt."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import mcp
import pytest
from mcp.shared.exceptions import MCPDeprecationWarning

from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.std_srvs.srv import Trigger
from tests.support.mcp_bench import POLICY, Bench, bench_of
from tests.support.waiting import until


def tell(bench: Bench, text: str) -> None:
    """Let the robot's program report an event."""
    bench.served.tell(text)


async def read(client: Any, uri: str) -> Any:
    """Return a resource, decoded if it is JSON."""
    (content,) = (await client.read_resource(uri)).contents
    return json.loads(content.text) if content.mime_type == "application/json" else content.text


async def test_the_robot_its_topics_and_types_are_resources(assisted: Bench, era: str) -> None:
    """Including the owner's description."""
    client = await assisted.connect(era)
    listed = [each.uri for each in (await client.list_resources()).resources]
    (template,) = (await client.list_resource_templates()).resource_templates

    topics = {"robot://topic/cmd_vel", "robot://topic/says", "robot://topic/text"}
    assert listed[:2] == ["robot://about", "robot://events"]
    assert topics <= set(listed[2:])
    assert template.uri_template == "robot://type/{package}/{kind}/{name}"
    described = await read(client, "robot://type/std_msgs/msg/String")
    assert "data" in described["message"]["properties"]


async def test_the_owner_describes_the_robot(era: str) -> None:
    """The model is told at the beginning."""
    async with bench_of(about="A warehouse robot; keep off the red line.") as bench:
        client = await bench.connect(era)
        assert "keep off the red line" in str(client.instructions)
        assert "keep off the red line" in await read(client, "robot://about")


async def test_a_topic_is_read_as_a_resource(assisted: Bench, era: str) -> None:
    """The next message of it."""
    client = await assisted.connect(era)
    async with asyncio.TaskGroup() as tasks:
        reading = tasks.create_task(read(client, "robot://topic/text"))
        await assisted.base.text.wait_for_subscribers()
        assisted.base.text.publish(String(data="one"))

    assert reading.result()["value"] == {"data": "one"}


@pytest.mark.parametrize("uri", ["robot://topic/tekst", "robot://type/std_msgs/msg/No", "x://y"])
async def test_what_is_not_there_is_an_error(assisted: Bench, era: str, uri: str) -> None:
    """It is an error of the protocol, since resources have no other errors."""
    client = await assisted.connect(era)
    with pytest.raises(mcp.MCPError):
        await client.read_resource(uri)


async def test_a_warning_of_the_robot_is_an_event(assisted: Bench, era: str) -> None:
    """Even one that was logged before anybody listened."""
    assisted.base.get_logger().warning("the battery is low")
    client = await assisted.connect(era)
    await read(client, "robot://events")
    tell(assisted, "a person is near")
    found: list[Any] = []

    async def has_come() -> None:
        while len(found) < 2:
            found[:] = (await read(client, "robot://events"))["events"]
            await asyncio.sleep(0.01)  # noqa: TID251  # it comes over the network

    async with asyncio.timeout(50):
        await has_come()
    assert {(each["source"], each["text"]) for each in found} == {
        ("base", "the battery is low"), ("", "a person is near"),
    }  # fmt: skip


async def test_the_log_is_for_those_who_may_read_it(era: str) -> None:
    """What the program reports is for everyone."""
    policy = '[[who]]\nname = "a"\nloopback = true\n[[allow]]\nsee = "/base"\n'
    async with bench_of(policy) as bench:
        bench.base.get_logger().warning("the battery is low")
        tell(bench, "hello")
        client = await bench.connect(era)
        events = (await read(client, "robot://events"))["events"]

    assert [each["text"] for each in events] == ["hello"]


async def test_a_client_of_the_newest_revision_listens_for_events(assisted: Bench) -> None:
    """This lets the robot speak first."""
    client = await assisted.connect()
    heard: list[Any] = []

    async def listen() -> None:
        async with client.listen(resource_subscriptions=["robot://events"]) as events:
            async for event in events:
                heard.append(event)
                return

    async with asyncio.TaskGroup() as tasks:
        listening = tasks.create_task(listen())
        while not heard and not listening.done():
            tell(assisted, "the battery is low")
            await asyncio.sleep(0.05)  # noqa: TID251  # nothing says that it listens

    assert heard[0].uri == "robot://events"


async def test_new_tools_are_told(assisted: Bench) -> None:
    """A service that appears later gets a tool."""
    client = await assisted.connect()
    assisted.use(POLICY.replace('call = "/switch"', 'call = "/**"'))
    heard: list[Any] = []

    async def listen() -> None:
        async with client.listen(tools_list_changed=True) as events:
            async for event in events:
                heard.append(event)
                return

    async with asyncio.TaskGroup() as tasks:
        listening = tasks.create_task(listen())
        number = 0
        while not listening.done():
            number += 1
            assisted.base.create_service(Trigger, f"/new{number}", lambda _, response: response)
            await asyncio.sleep(0.2)  # noqa: TID251  # nothing says that it listens
    names = [tool.name for tool in (await client.list_tools(cache_mode="bypass")).tools]

    assert heard
    assert "call_new1" in names


async def test_a_client_of_an_older_revision_subscribes_to_events(assisted: Bench) -> None:
    """It is also notified of new tools, without asking."""
    heard: list[str] = []

    async def take(message: Any) -> None:
        heard.append(str(getattr(message, "method", message)))

    client = await assisted.connect("legacy", message_handler=take)
    await client.list_tools()
    with pytest.warns(MCPDeprecationWarning):  # the newest revision listens
        await client.subscribe_resource("robot://events")
    tell(assisted, "the battery is low")
    assisted.base.create_service(Trigger, "/new", lambda _, response: response)
    await until(lambda: len(heard) >= 2)

    assert sorted(set(heard)) == [
        "notifications/resources/updated", "notifications/tools/list_changed",
    ]  # fmt: skip


async def test_the_prompt_says_how_the_robot_moves(assisted: Bench, era: str) -> None:
    """It is derived from the policy."""
    client = await assisted.connect(era)
    (listed,) = (await client.list_prompts()).prompts
    prompt = await client.get_prompt(listed.name)
    text = prompt.messages[0].content.text

    assert "`move` repeats a command on /cmd_vel" in text
    assert "linear.x from -0.5 to 0.5" in text
    assert "goal to /count" in text
    assert "10 s at most" in text
