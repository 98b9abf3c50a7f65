"""The views of the page in a browser: from above, in space, frames, several plots and pictures."""

from __future__ import annotations

import asyncio
import struct
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from aionode.action import CancelResponse
from aionode.gateway import Gateway, Policy
from aionode.image import from_numpy
from aionode.interfaces.geometry_msgs.msg import PoseStamped, TransformStamped
from aionode.interfaces.nav_msgs.msg import OccupancyGrid, Odometry, Path
from aionode.interfaces.sensor_msgs.msg import LaserScan, PointCloud2, PointField
from aionode.interfaces.std_msgs.msg import String
from aionode.message import ActionType, Message, float64
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.tf import StaticTransformBroadcaster
from tests.support.chromium import IN_A_BROWSER, chromium
from tests.support.waiting import until

if TYPE_CHECKING:
    import pathlib
    from collections.abc import AsyncIterator

    from aionode.node import Node
    from tests.support.chromium import Page

pytestmark = IN_A_BROWSER

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
WRITING = Policy.default(allow_write=True)


class DriveTo(ActionType, typename="page_test_interfaces/action/DriveTo"):
    """Drives to a place."""

    class Goal(Message):
        """The place."""

        x: float64 = 0.0
        y: float64 = 0.0

    class Result(Message):
        """Empty."""

        driven: float64 = 0.0

    class Feedback(Message):
        """The remaining distance."""

        distance_left: float64 = 0.0


@asynccontextmanager
async def page_of(node: Node, policy: Policy = WRITING) -> AsyncIterator[Page]:
    """Open the page of a node's gateway, and wait until it has the list of topics."""
    async with Gateway(node, policy, port=0) as gateway, chromium() as browser:
        page = await browser.open(f"http://127.0.0.1:{gateway.port}/")
        await page.until("document.querySelector('#state').textContent === 'connected'")
        yield page


def place(node: Node, child: str, parent: str, x: float, y: float) -> None:
    """Publish the pose of a frame, as a static transform."""
    transform = TransformStamped(child_frame_id=child)
    transform.header.frame_id = parent
    transform.transform.translation.x = x
    transform.transform.translation.y = y
    transform.transform.rotation.w = 1.0
    StaticTransformBroadcaster(node).sendTransform(transform)


async def tick(page: Page, selector: str) -> None:
    """Tick a checkbox that exists, or will soon."""
    await page.until(f"document.querySelector({selector!r})")
    await page.value(f"document.querySelector({selector!r}).click(); 1")


async def show(page: Page, topic: str) -> None:
    """Tick the layer of a topic, and wait until it is drawn."""
    labels = "[...document.querySelectorAll('#scene .layers label')]"
    found = f"{labels}.find(e => e.textContent === {topic!r})"
    await page.until(found)
    await page.value(f"{found}.querySelector('input').click(); 1")
    shown = "document.querySelector('#scene canvas').dataset.shown.split(' ')"
    await page.until(f"{shown}.includes({topic!r})")


async def reds(page: Page) -> int:
    """Return how many pixels of the view from above have the first layer's colour."""
    return int(
        await page.value(
            "(() => { const c = document.querySelector('#scene canvas');"
            "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0;"
            "for (let i = 0; i < d.length; i += 4)"
            "n += d[i] > 200 && d[i + 1] < 110 && d[i + 2] < 120;"
            "return n; })()"
        )
    )


def scan() -> LaserScan:
    """Return a scan of a surrounding wall, with two beams that hit nothing."""
    message = LaserScan(angle_min=-3.0, angle_increment=0.1, range_min=0.1, range_max=9.0)
    message.header.frame_id = "lidar"
    message.ranges = np.array([2.0] * 58 + [np.inf, np.nan], np.float32)
    return message


def cloud() -> PointCloud2:
    """Return three points, one of them invalid."""
    message = PointCloud2(height=1, width=3, point_step=16, row_step=48)
    message.header.frame_id = "lidar"
    message.fields = [
        PointField(name=n, offset=4 * i, datatype=7, count=1) for i, n in enumerate("xyz")
    ]
    message.data = struct.pack("<12f", 1, 1, 1, 0, np.nan, 0, 0, 0, 3, 3, 0, 0)
    return message


def grid() -> OccupancyGrid:
    """Return a map of six cells."""
    message = OccupancyGrid()
    message.header.frame_id = "map"
    message.info.width, message.info.height, message.info.resolution = 3, 2, 0.5
    message.info.origin.orientation.w = 1.0
    message.data = np.array([0, 100, -1, 50, 0, 0], np.int8)
    return message


def path() -> Path:
    """Return a path of three places."""
    message = Path()
    message.header.frame_id = "map"
    for x in (0.0, 1.0, 2.0):
        pose = PoseStamped()
        pose.pose.position.x = x
        message.poses.append(pose)
    return message


def odometry() -> Odometry:
    """Return the pose of the robot."""
    message = Odometry()
    message.header.frame_id = "map"
    message.pose.pose.orientation.w = 1.0
    return message


MESSAGES: dict[str, Any] = {
    "/scan": scan, "/points": cloud, "/map": grid, "/plan": path, "/odom": odometry,
}  # fmt: skip


@pytest.mark.parametrize(
    "topic",
    [each if each == "/scan" else pytest.param(each, marks=pytest.mark.slow) for each in MESSAGES],
)
async def test_a_layer_is_drawn_from_above(node: Node, topic: str) -> None:
    """In the fixed frame, to which the transforms lead."""
    message = MESSAGES[topic]()
    place(node, "base_link", "map", 1.0, 0.0)
    place(node, "lidar", "base_link", 0.2, 0.0)
    node.create_publisher(type(message), topic, LATCHED).publish(message)
    async with page_of(node) as page:
        await show(page, topic)

        # The layer may be drawn in its own frame before the transforms have come.
        await page.until("document.querySelector('#scene .fixed').value === 'map'")
        if topic != "/map":
            assert await reds(page) > 3


@pytest.mark.slow
async def test_a_layer_says_why_it_cannot_be_drawn(node: Node) -> None:
    """Without a transform, or with a map whose size does not match its data."""
    lost, wrong = odometry(), grid()
    lost.header.frame_id = "<b>elsewhere</b>"
    wrong.info.width = 7
    node.create_publisher(Odometry, "/lost", LATCHED).publish(lost)
    node.create_publisher(OccupancyGrid, "/wrong", LATCHED).publish(wrong)
    place(node, "base_link", "map", 1.0, 0.0)
    async with page_of(node) as page:
        await page.until("document.querySelectorAll('#scene .layers input').length === 2")
        await page.value(
            "document.querySelectorAll('#scene .layers input').forEach(e => e.click()); 1"
        )
        await page.until("document.querySelector('#scene .fixed').options.length === 4")
        await page.choose("#scene .fixed", "map")
        await page.until("document.querySelector('#scene .caption').textContent.includes('/lost')")

        caption = await page.text("#scene .caption")
        assert "/lost: no transform from <b>elsewhere</b> to map" in caption
        assert "/wrong: 7 \u00d7 2 cells of 0.5 m with 6 values are not a map" in caption


@pytest.mark.slow
async def test_what_nobody_looks_at_is_not_subscribed_to(node: Node) -> None:
    """A robot publishes many transforms and large clouds; the topic list measures neither."""
    publisher = node.create_publisher(PointCloud2, "/points", 1)
    async with page_of(node) as page:
        await page.until("document.querySelector('#scene .layers input')")
        assert publisher.get_subscription_count() == 0
        await tick(page, "#scene .layers input")
        await until(lambda: publisher.get_subscription_count() == 1)
        await tick(page, "#scene .layers input")
        await until(lambda: publisher.get_subscription_count() == 0)


async def drag(page: Page) -> None:
    """Choose "goal by the next click", press in the middle, and point to the left."""
    await tick(page, "#scene .arm")
    x, y = await page.place("#scene canvas")
    await page.mouse("mousePressed", x, y)
    await page.mouse("mouseMoved", x - 50, y)
    await page.mouse("mouseReleased", x - 50, y)


async def test_a_click_sends_a_goal_pose(node: Node) -> None:
    """It is where the pointer was pressed, facing where it was released; one click is one goal."""
    got: list[PoseStamped] = []
    node.create_subscription(PoseStamped, "/goal_pose", got.append, 10)
    place(node, "base_link", "map", 1.0, 0.0)
    node.create_publisher(Odometry, "/odom", LATCHED).publish(odometry())
    async with page_of(node) as page:
        await show(page, "/odom")
        await page.choose("#scene .target", "/goal_pose")
        await drag(page)
        await until(lambda: bool(got))

        assert got[0].header.frame_id == "map"
        assert got[0].header.stamp.sec > 0
        assert got[0].pose.position.x == pytest.approx(0.0, abs=0.05)
        assert abs(got[0].pose.orientation.z) == pytest.approx(1.0, abs=0.01)
        assert not await page.value("document.querySelector('#scene .arm').checked")


@pytest.mark.slow
async def test_a_click_sends_the_goal_of_an_action(node: Node) -> None:
    """Its feedback is shown, and STOP cancels it."""
    ended: list[str] = []

    async def drive(handle: Any) -> DriveTo.Result:
        handle.publish_feedback(DriveTo.Feedback(distance_left=1.5))
        try:
            await asyncio.Event().wait()
        finally:
            ended.append("cancelled")
        return DriveTo.Result()

    node.create_action_server(
        DriveTo, "/drive_to", drive, cancel_callback=lambda _handle: CancelResponse.ACCEPT
    )
    node.create_publisher(Odometry, "/odom", LATCHED).publish(odometry())
    async with page_of(node) as page:
        await show(page, "/odom")
        await page.choose("#scene .target", "/drive_to")
        await drag(page)
        await page.until("document.querySelector('#scene .progress').textContent.includes('1.5')")
        await page.value("document.querySelector('#stop').click(); 1")
        await page.until("document.querySelector('#scene .progress').textContent === 'cancelled'")

        assert ended == ["cancelled"]


@pytest.mark.slow
async def test_a_goal_that_the_policy_refuses_is_reported(node: Node) -> None:
    """The page only requests it; the gateway decides."""
    got: list[PoseStamped] = []
    node.create_subscription(PoseStamped, "/goal_pose", got.append, 10)
    node.create_publisher(Odometry, "/odom", LATCHED).publish(odometry())
    async with page_of(node, Policy.default()) as page:
        await show(page, "/odom")
        await page.choose("#scene .target", "/goal_pose")
        await drag(page)
        await page.until(
            "document.querySelector('#notice').textContent.includes('without a policy')"
        )

        assert not got


MESH = '<visual><geometry><mesh filename="{}" scale="{}"/></geometry></visual>'
URDF = f"""<robot name="r"><material name="red"><color rgba="1 0 0 1"/></material>
<link name="base_link">
  <visual><geometry><box size="0.4 0.3 0.1"/></geometry><material name="red"/></visual>
  <visual><geometry><sphere radius="0.1"/></geometry></visual>
  <visual><geometry><cylinder radius="0.1" length="0.2"/></geometry></visual>
  {MESH.format("package://rover/meshes/base%20link.stl", "2 2 2")}
</link>
<link name="arm">{MESH.format("package://rover/meshes/arm.dae", "1 1 1")}</link>
<link name="flag">{MESH.format("package://other/x.stl", "1 1 1")}</link>
<joint name="j" type="fixed">
  <parent link="base_link"/><child link="arm"/><origin xyz="0 0 0.5"/>
</joint>
</robot>"""
"""A model with all shapes; its arm has a joint without a transform, and one mesh is not allowed."""

DAE = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema">
<asset><unit meter="0.1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="f" count="9">0 0 0 1 0 0 0 1 0</float_array></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w">
<node><translate>0 0 2</translate><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>"""


@pytest.fixture
def package(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Install a package with meshes."""
    marker = tmp_path / "share/ament_index/resource_index/packages"
    marker.mkdir(parents=True)
    (marker / "rover").touch()
    meshes = tmp_path / "share/rover/meshes"
    meshes.mkdir(parents=True)
    corners = struct.pack("<12f", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0)
    (meshes / "base link.stl").write_bytes(bytes(80) + struct.pack("<I", 1) + corners + bytes(2))
    (meshes / "arm.dae").write_text(DAE)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))


@pytest.mark.usefixtures("package")
async def test_the_model_is_drawn_in_space(node: Node) -> None:
    """Boxes, cylinders, spheres and meshes; a mesh that the policy does not serve is named."""
    node.create_publisher(String, "/robot_description", LATCHED).publish(String(data=URDF))
    place(node, "base_link", "odom", 1.0, 0.0)
    place(node, "flag", "odom", 0.0, 0.0)
    async with page_of(node, Policy.default(assets=["rover"])) as page:
        await page.until(
            "document.querySelector('#space .description').value === '/robot_description'"
        )
        await tick(page, "#space .on")
        await page.until("document.querySelector('#space canvas').dataset.parts === '5'")
        await page.until("document.querySelector('#space .caption').textContent")

        assert "flag: asset /other/x.stl" in await page.text("#space .caption")
        red = await page.value(
            "(() => { const c = document.querySelector('#space canvas');"
            "const gl = c.getContext('webgl');"
            "const d = new Uint8Array(4 * c.width * c.height);"
            "gl.readPixels(0, 0, c.width, c.height, gl.RGBA, gl.UNSIGNED_BYTE, d); let n = 0;"
            "for (let i = 0; i < d.length; i += 4) n += d[i] > 90 && d[i + 1] < 20;"
            "return n; })()"
        )
        assert red > 500


@pytest.mark.slow
async def test_meshes_are_read(node: Node) -> None:
    """In each format, as triangles in metres with z upwards."""
    stl = "solid a\nfacet normal 0 0 1\nouter loop\n" + "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1/1 2//2 3 -1\n"
    async with page_of(node) as page:

        async def corners(name: str, text: str) -> list[float]:
            found: list[float] = await page.value(
                f"import('./page/meshes.js').then(it => Array.from(it.mesh({name!r},"
                f" new TextEncoder().encode({text!r}).buffer)))"
            )
            return found

        async def failure(name: str, text: str) -> str:
            with pytest.raises(AssertionError) as failed:
                await corners(name, text)
            return str(failed.value)

        assert await corners("a.STL", stl) == [0, 0, 0, 1, 0, 0, 0, 1, 0]
        assert len(await corners("a.obj", obj)) == 18
        assert await corners("a.dae", DAE) == pytest.approx([0, 0, 0.2, 0.1, 0, 0.2, 0, 0.1, 0.2])
        upright = DAE.replace("Z_UP", "Y_UP")
        assert await corners("a.dae", upright) == pytest.approx(
            [0, -0.2, 0, 0.1, -0.2, 0, 0, -0.2, 0.1]
        )
        doubling = ""  # a trillion nodes
        for deep in range(40):
            inner = f'<instance_node url="#n{deep + 1}"/>' * 2
            doubling += f'<node id="n{deep}">{inner}</node>'
        many = f"<COLLADA><visual_scene>{doubling}</visual_scene></COLLADA>"
        assert "more than 10000 nodes" in await failure("a.dae", many)
        for name, text in {"a.stl": "x", "a.dae": "<x", "a.obj": "f 1 2 3", "a.glb": ""}.items():
            with pytest.raises(AssertionError):
                await corners(name, text)


@pytest.mark.slow
async def test_frames_are_shown_as_a_tree(node: Node) -> None:
    """With their poses in their parents; names of the robot are shown as text."""
    place(node, "base_link", "map", 1.0, 2.0)
    place(node, "<i>lidar", "base_link", 0.25, 0.0)
    async with page_of(node) as page:
        await tick(page, "#frames .on")
        await page.until("document.querySelectorAll('#frames tbody tr').length === 3")
        rows = await page.value(
            "[...document.querySelectorAll('#frames tbody tr')].map(r => "
            "[r.cells[0].textContent, r.cells[0].style.paddingLeft, r.cells[1].textContent])"
        )

        assert rows[0][:2] == ["map", "0em"]
        assert rows[1] == ["base_link", "1em", "1.000, 2.000, 0.000  0.0°"]
        assert rows[2] == ["<i>lidar", "2em", "0.250, 0.000, 0.000  0.0°"]


@pytest.mark.slow
async def test_transforms_in_a_circle_end(node: Node) -> None:
    """Two programs may each claim that the other's frame is the parent."""
    place(node, "a", "b", 1.0, 0.0)
    place(node, "b", "a", 1.0, 0.0)
    message = odometry()
    message.header.frame_id = "a"
    node.create_publisher(Odometry, "/odom", LATCHED).publish(message)
    async with page_of(node) as page:
        await tick(page, "#frames .on")
        await show(page, "/odom")


@pytest.mark.slow
async def test_there_may_be_several_plots_and_pictures(node: Node) -> None:
    """Each picture has its own topic; numbers are added to the newest plot."""
    for number, name in enumerate(("/left", "/right")):
        image = from_numpy(np.full((4 + number, 6, 3), 90, np.uint8), "rgb8")
        node.create_publisher(type(image), name, LATCHED).publish(image)
    node.create_publisher(Odometry, "/odom", LATCHED).publish(odometry())
    async with page_of(node) as page:
        await page.click("#camera .more")
        views = "#camera .view:nth-of-type({}) {}"
        for number, name in enumerate(("/left", "/right")):
            await page.choose(views.format(number + 1, "select"), name)
            caption = views.format(number + 1, ".caption")
            await page.until(
                f"document.querySelector({caption!r}).textContent === '6 \u00d7 {4 + number}, rgb8'"
            )
        await page.until("document.querySelector(\"#topics tr[data-topic='/odom']\")")
        await page.click("#topics tr[data-topic='/odom']")
        await page.until("document.querySelectorAll('#message td.number').length > 5")
        await page.value("document.querySelectorAll('#message td.number')[2].click(); 1")
        await page.click("#plot .more")
        await page.value("document.querySelectorAll('#message td.number')[3].click(); 1")
        legends = await page.value(
            "[...document.querySelectorAll('#plot .legend')].map(each => each.textContent)"
        )

        assert legends == ["/odom pose.pose.position.x \u00d7", "/odom pose.pose.position.y \u00d7"]
