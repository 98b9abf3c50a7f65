"""The page in a browser: what it shows, what it changes, and that closing it ends driving."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager, suppress
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pytest

from aionode.gateway import Gateway, Policy
from aionode.gateway.session.encoding.eight_bits import eight_bits
from aionode.image import compress, from_numpy, to_numpy
from aionode.interfaces.geometry_msgs.msg import Twist, TwistStamped
from aionode.node import Node
from examples.web_page_robot import POLICY, Robot
from tests.support.chromium import IN_A_BROWSER, chromium

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Sequence

    from aionode.engine.context import Context
    from aionode.interfaces.sensor_msgs.msg import Image
    from tests.support.chromium import Page

pytestmark = IN_A_BROWSER


def driving(ttl_sec: float = 30.0) -> Policy:
    """Return a policy by which a page may drive, even if a busy machine delays it."""
    return Policy.parse(f"""
        [[who]]
        name = "operator"
        loopback = true
        [[allow]]
        subscribe = "/**"
        [[allow]]
        publish = "/cmd_vel"
        lease = {{ ttl_sec = {ttl_sec}, max_age_sec = 30 }}
        fields = {{ "linear.x" = {{ min = -0.5, max = 0.5, outside = "clamp" }} }}
    """)


class Scene(NamedTuple):
    """The page in a browser, and the robot behind it.

    Attributes:
        page: The page.
        robot: The robot.
        gateway: Its gateway.
        commands: What the robot was told to drive.
        network: Set while the network between browser and gateway carries something.
    """

    page: Page
    robot: Robot
    gateway: Gateway
    commands: list[Twist]
    network: asyncio.Event

    @property
    def speeds(self) -> list[float]:
        """The commanded speeds, in m/s."""
        return [command.linear.x for command in self.commands]


@asynccontextmanager
async def scene(
    context: Context, policy: Policy = POLICY, fragment: str = "", *, is_cuttable: bool = False
) -> AsyncIterator[Scene]:
    """Run a robot, its gateway and a browser that has opened the page."""
    commands: list[Twist] = []
    network = asyncio.Event()
    network.set()
    async with (
        Robot(context) as robot,
        Node("wheels", context=context) as wheels,
        Gateway(robot, policy=policy, port=0) as gateway,
        relay(gateway.port, network) as relayed,
        chromium() as browser,
    ):
        wheels.create_subscription(Twist, "/cmd_vel", commands.append, 100)
        port = relayed if is_cuttable else gateway.port
        page = await browser.open(f"http://127.0.0.1:{port}/{fragment}")
        yield Scene(page, robot, gateway, commands, network)


@asynccontextmanager
async def relay(port: int, network: asyncio.Event) -> AsyncIterator[int]:
    """Yield a port that forwards to another one while an event is set, and is silent otherwise."""

    async def copy(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with suppress(ConnectionError):
            while data := await reader.read(65536):
                await network.wait()
                writer.write(data)
                await writer.drain()
        writer.close()

    async def connect(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        back, forth = await asyncio.open_connection("127.0.0.1", port)
        await asyncio.gather(copy(reader, forth), copy(back, writer))

    server = await asyncio.start_server(connect, "127.0.0.1", 0)
    async with server:
        yield server.sockets[0].getsockname()[1]


async def connected(page: Page) -> None:
    """Wait until the page has the list of topics."""
    await page.until("document.querySelector('#state').textContent === 'connected'")
    await page.until("document.querySelectorAll('#topics tbody tr').length > 3")


async def hold(page: Page) -> None:
    """Tick "drive", and hold the pad a bit above its middle."""
    await page.click("#teleop .armed")
    x, y = await page.place("#teleop .pad")
    await page.mouse("mousePressed", x, y - 40)


async def drive(page: Page, robot: Node, commands: Sequence[Twist]) -> None:
    """Hold the pad until the robot moves.

    A page that got no processor for longer than the time to live has let go, and is held again.
    """
    await page.click("#teleop .armed")
    x, y = await page.place("#teleop .pad")
    held = "document.querySelector('.pad').classList.contains('held')"
    async with asyncio.timeout(20):
        while len(commands) < 3 or not commands[-1].linear.x:
            if not await page.value(held):
                await page.mouse("mouseReleased", x, y - 40)
                await page.mouse("mousePressed", x, y - 40)
            await robot.get_clock().sleep(0.02)


async def until(node: Node, condition: Callable[[], bool]) -> None:
    """Check repeatedly whether something has happened, for at most 20 s."""
    async with asyncio.timeout(20):
        while not condition():
            await node.get_clock().sleep(0.02)


async def test_the_page_shows_what_the_robot_does(context: Context) -> None:
    """Rates, values, plots, pictures and the log, all from this gateway."""
    async with scene(context) as (page, robot, *_):
        await connected(page)
        await page.click("#topics tr[data-topic='/odom']")
        await page.until("document.querySelectorAll('#message td.number').length > 5")
        await page.click("#message td.number")
        await page.choose("#camera select", "/camera/image")
        robot.get_logger().error("<b>low battery</b>")

        rate = "#topics tr[data-topic='/odom'] .rate"
        await page.until(f'Number(document.querySelector("{rate}").textContent) > 5')
        await page.until("document.querySelector('#camera .caption').textContent")
        await page.until("document.querySelector('#log .level-40')")
        assert (await page.text("#plot .legend button")).startswith("/odom header.stamp.sec")
        assert "rgb8" in await page.text("#camera .caption")
        assert "robot: <b>low battery</b>" in await page.text("#log .level-40")
        origins = "performance.getEntriesByType('resource').map(each => new URL(each.name).origin)"
        assert set(await page.value(origins)) == {await page.value("location.origin")}


@pytest.mark.slow
async def test_the_page_sets_parameters_and_calls_services(context: Context) -> None:
    """The node's reason for a refusal is shown."""
    async with scene(context) as (page, robot, *_):
        await connected(page)
        robot.x = 5.0
        await page.choose("#parameters select", "/robot")
        await page.until("document.querySelectorAll('#parameters input').length > 1")
        field = "#parameters tr:nth-child(2) input"
        assert await page.text("#parameters tr:nth-child(2) td") == "floor"
        await page.write(field, "1.5")
        await page.until(f"document.querySelector('{field}').className === 'taken'")
        await page.write(field, "9.5")
        await page.until(f"document.querySelector('{field}').className === 'refused'")
        notice = await page.text("#notice")
        await page.choose("#services select", "/robot/reset")
        await page.until("document.querySelector('#services .type').textContent")
        await page.click("#services .call")
        await page.until("document.querySelector('#services pre').textContent.includes('back')")

        assert robot.settings.floor == 1.5
        assert "/robot:floor" in notice
        assert robot.x < 5.0


async def test_letting_go_stops(context: Context) -> None:
    """The page sends while the pad is held, within the limits of the policy."""
    async with scene(context, driving()) as (page, robot, _, commands, _):
        await connected(page)
        await page.write("#teleop .speed", "5")
        await hold(page)
        await until(robot, lambda: len(commands) >= 5)
        x, y = await page.place("#teleop .pad")
        await page.mouse("mouseReleased", x, y)
        await until(robot, lambda: not commands[-1].linear.x)

        assert {each.linear.x for each in commands} == {0.5, 0.0}


@pytest.mark.slow
async def test_the_stop_button_ends_driving(context: Context) -> None:
    """Even while the pad is held; afterwards the pad has no effect until "drive" is ticked."""
    async with scene(context, driving()) as (page, robot, _, commands, _):
        await connected(page)
        await drive(page, robot, commands)
        await page.value("document.querySelector('#stop').click(); 1")
        await until(robot, lambda: not commands[-1].linear.x)
        count = len(commands)
        x, y = await page.place("#teleop .pad")
        await page.mouse("mousePressed", x, y)
        await page.value("new Promise(done => setTimeout(done, 200))")

        assert not await page.value("document.querySelector('#teleop .armed').checked")
        assert not any(each.linear.x for each in commands[count:])


async def test_driving_stops_when_the_tab_closes(context: Context) -> None:
    """Nobody releases the pad: the gateway ends the lease of a client that has left."""
    async with scene(context, driving()) as (page, robot, gateway, commands, _):
        await connected(page)
        await drive(page, robot, commands)
        await page.close()
        await until(robot, lambda: not (commands[-1].linear.x or gateway.stats.holders))

        assert commands[-1] == Twist()


@pytest.mark.slow
async def test_hiding_the_tab_stops(context: Context) -> None:
    """The page itself stops: browsers run the scripts of hidden tabs only once a second."""
    async with scene(context, driving()) as (page, robot, _, commands, _):
        await connected(page)
        await drive(page, robot, commands)
        await page.hide()
        await until(robot, lambda: not commands[-1].linear.x)

        assert not await page.value("document.querySelector('#teleop .armed').checked")


@pytest.mark.slow
async def test_driving_stops_when_the_browser_freezes_the_tab(context: Context) -> None:
    """Browsers do so to save power; the page is notified, and its timers stand still."""
    async with scene(context, driving(ttl_sec=0.3)) as (page, robot, gateway, commands, _):
        await connected(page)
        await drive(page, robot, commands)
        await page.do("Page.setWebLifecycleState", state="frozen")
        await until(robot, lambda: not (commands[-1].linear.x or gateway.stats.holders))

        assert commands[-1] == Twist()


@pytest.mark.slow
async def test_driving_stops_when_the_network_is_cut(context: Context) -> None:
    """Neither end is notified: the gateway sends the stop after the time to live.

    Commands that the page has sent meanwhile are refused when the network is back. It sends none
    afterwards here: until it hears of the refusal, it may, and these are carried out.
    """
    async with scene(context, driving(ttl_sec=0.3), is_cuttable=True) as whole:
        page, robot, gateway, commands, network = whole
        await connected(page)
        await drive(page, robot, commands)
        network.clear()
        await until(robot, lambda: not (commands[-1].linear.x or gateway.stats.holders))
        count = len(commands)
        await page.value("new Promise(done => setTimeout(done, 200))")
        await page.value("WebSocket.prototype.send = () => {}; 1")
        network.set()
        await page.until("!document.querySelector('.pad').classList.contains('held')")

        assert not any(command.linear.x for command in commands[count:])


@pytest.mark.slow
async def test_driving_stops_when_the_page_freezes(context: Context) -> None:
    """A script that never returns sends nothing: the gateway stops after the time to live."""
    async with scene(context, driving(ttl_sec=0.3)) as (page, robot, gateway, commands, _):
        await connected(page)
        await drive(page, robot, commands)
        await page.value("setTimeout(() => { for (;;); }, 0); 1")
        await until(robot, lambda: not (commands[-1].linear.x or gateway.stats.holders))

        assert commands[-1] == Twist()


@pytest.mark.slow
async def test_a_key_drives_while_it_is_held(context: Context) -> None:
    """Stamped commands work too; the gateway sets the stamp by the robot's clock."""
    policy = Policy.default(allow_write=True)
    stamped: list[TwistStamped] = []
    async with scene(context, policy) as (page, robot, *_):
        robot.create_subscription(TwistStamped, "/base/cmd_vel", stamped.append, 100)
        await connected(page)
        await page.write("#teleop .topic", "/base/cmd_vel")
        await page.until("document.querySelectorAll('#command-topics option').length === 2")
        await page.click("#teleop .armed")
        key = {"code": "ArrowUp", "key": "ArrowUp"}
        await page.do("Input.dispatchKeyEvent", type="keyDown", **key)
        await until(robot, lambda: len(stamped) >= 3)
        await page.do("Input.dispatchKeyEvent", type="keyUp", **key)
        await until(robot, lambda: not stamped[-1].twist.linear.x)

        assert stamped[0].twist.linear.x == 0.3
        assert stamped[0].header.stamp.sec > 0


SHOWN = {
    "rgb8": (np.uint8, 3),
    "bgr8": (np.uint8, 3),
    "rgba8": (np.uint8, 4),
    "rgb16": (np.uint16, 3),
    "8UC3": (np.uint8, 3),
    "mono8": (np.uint8, 1),
    "mono16": (np.uint16, 1),
    "16UC1": (np.uint16, 1),
    "16SC1": (np.int16, 1),
    "32FC1": (np.float32, 1),
    "64FC1": (np.float64, 1),
    "bayer_rggb8": (np.uint8, 1),
    "bayer_gbrg16": (np.uint16, 1),
    "yuv422": (np.uint8, 2),
    "yuv422_yuy2": (np.uint8, 2),
}
"""Encodings of images that the page shows itself, with the type and number of their channels."""


@pytest.mark.slow
async def test_pictures_are_those_that_the_gateway_makes(context: Context) -> None:
    """The same rules exist in JavaScript and in Python; a pixel may differ by rounding."""
    random = np.random.default_rng(7)
    async with scene(context) as (page, *_):
        await connected(page)
        different = {}
        for encoding, (kind, channels) in SHOWN.items():
            shape = (5, 7) if channels == 1 else (5, 7, channels)
            pixels = (random.random(shape) * 200).astype(kind)
            message = from_numpy(pixels, encoding)
            expected = to_numpy(eight_bits(message), "rgb8")
            got = await page.value(drawn(message))
            error = np.abs(np.array(got).reshape(5, 7, 4)[:, :, :3] - expected.astype(int)).max()
            if error > 1:
                different[encoding] = error

    assert not different


def drawn(message: Image) -> str:
    """Return a script that makes a page draw an image, as lists of red, green, blue and alpha."""
    fields = f"""{{
        width: {message.width}, height: {message.height}, step: {message.step},
        encoding: {message.encoding!r}, is_bigendian: {message.is_bigendian},
        data: new Uint8Array({list(bytes(message.data))}),
    }}"""
    return f"import('./page/picture.js').then((it) => Array.from(it.picture({fields}).data))"


@pytest.mark.slow
async def test_a_picture_larger_than_its_data_is_an_error(context: Context) -> None:
    """A message of a few bytes could have the browser take gigabytes."""
    async with scene(context) as (page, *_):
        for size in ("width: 30000, height: 30000, step: 30000", "width: 9, height: 1, step: 4"):
            assert "too few for" in await page.value(
                f"import('./page/picture.js').then((it) => it.picture({{ {size}, encoding: 'mono8',"
                " is_bigendian: 0, data: new Uint8Array(4) })).catch((error) => error.message)"
            )


@pytest.mark.slow
async def test_numbers_that_hardly_differ_can_be_plotted(context: Context) -> None:
    """With nanoseconds since 1970, grid lines may be closer than two numbers can be."""
    async with scene(context) as (page, *_):
        assert await page.value(
            "import('./page/plot.js').then(({ Plot }) => {"
            " const plot = new Plot(document.querySelector('#plot canvas'));"
            " plot.add('stamp');"
            " for (const value of [1e17, 1e17 + 16]) plot.push('stamp', value);"
            " plot.draw(performance.now() / 1000);"
            " return true; })"
        )


@pytest.mark.slow
async def test_pictures_have_their_colours(context: Context) -> None:
    """Raw, without a number in it, and compressed."""
    red = np.full((60, 80, 3), (200, 30, 0), np.uint8)
    depth = np.full((60, 80), 2.0, np.float32)
    depth[0, 0], depth[0, 1], depth[0, 2] = np.nan, 1.0, 3.0
    pictures: dict[str, Any] = {
        "/bgr8": from_numpy(red[:, :, ::-1].copy(), "bgr8"),
        "/depth": from_numpy(depth, "32FC1"),
        "/png": compress(from_numpy(red, "rgb8"), "png"),
    }
    async with scene(context) as (page, robot, *_):
        outlets = {name: robot.create_publisher(type(pictures[name]), name, 1) for name in pictures}

        def show() -> None:
            for name, outlet in outlets.items():
                outlet.publish(pictures[name])

        robot.create_timer(0.1, show)
        await connected(page)
        for name, colour in zip(pictures, ["200,30,0", "128,128,128", "200,30,0"], strict=True):
            await page.choose("#camera select", name)
            await page.until(
                "document.querySelector('#camera .caption').textContent && document"
                ".querySelector('#camera canvas').getContext('2d').getImageData(9, 9, 1, 1)"
                f".data.slice(0, 3).join() === '{colour}'"
            )


@pytest.mark.slow
async def test_a_second_page_is_told_who_drives(context: Context) -> None:
    """Its pad is released, because its commands have no effect."""
    async with scene(context, driving()) as (page, robot, _, commands, _), chromium() as other:
        await connected(page)
        await drive(page, robot, commands)
        second = await other.open(await page.value("location.href"))
        await connected(second)
        await second.write("#teleop .speed", "0.1")
        await hold(second)
        await second.until("document.querySelector('#notice').textContent.includes('commands it')")
        await second.until("!document.querySelector('.pad').classList.contains('held')")

        assert 0.1 not in {command.linear.x for command in commands}


async def test_the_page_asks_for_a_token(context: Context) -> None:
    """A token after the number sign of its address suffices; a user types theirs in."""
    policy = Policy.parse("""
        [[who]]
        name = "operator"
        token = "correct horse battery staple"

        [[allow]]
        see = "/**"
        subscribe = "/**"
    """)
    async with scene(context, policy, "#token=wrong") as (page, *_):
        await page.until("!document.querySelector('#sign-in').hidden")
        # The reason comes later, and moves the button.
        await page.until("document.querySelector('#notice').textContent.includes('refused')")
        await page.value("document.querySelector('#token').value = 'correct horse battery staple'")
        await page.click("#sign-in button")
        await connected(page)

        assert "token" not in await page.value("location.href")
