"""The programs that publish the pictures of cameras, with a file of a video in its place."""

from __future__ import annotations

import asyncio
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import Parameter
from aionode.errors import CommandError
from aionode.image import decompress, to_numpy
from aionode.interfaces.sensor_msgs.msg import CameraInfo, CompressedImage, Image
from aionode.interfaces.sensor_msgs.srv import SetCameraInfo
from aionode.interfaces.std_srvs.srv import SetBool
from aionode.programs._camera import video
from aionode.programs._camera.calibration import Calibration, info_of, text_of
from aionode.programs._camera.camera_node import CameraNode, chosen, devices
from aionode.programs._camera.usb_cam_node import UsbCam
from aionode.programs._camera.v4l2_camera_node import V4L2Camera
from tests.programs.conftest import Start
from tests.support.peers import isolated_environment
from tests.support.waiting import until

av = pytest.importorskip("av", reason="videos are read by PyAV")

WIDTH, HEIGHT = 64, 48


@pytest.fixture(scope="module")
def videos(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write ten pictures, from dark to light, as they are and as JPEG."""
    folder = tmp_path_factory.mktemp("videos")
    for name, codec, pixels in (("plain", "ffv1", "yuv420p"), ("jpeg", "mjpeg", "yuvj420p")):
        with av.open(str(folder / f"{name}.mkv"), "w") as container:
            stream = container.add_stream(codec, rate=30)
            stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, pixels
            for at in range(10):
                shade = np.full((HEIGHT, WIDTH, 3), 20 * at, np.uint8)
                container.mux(stream.encode(av.VideoFrame.from_ndarray(shade, format="rgb24")))
            container.mux(stream.encode())
    return folder


class Viewer:
    """A node that receives the images of a camera."""

    def __init__(self, node: Any) -> None:
        self.node = node
        self.seen: asyncio.Queue[Any] = asyncio.Queue()

    def look(self, kind: Any, topic: str) -> None:
        """Subscribe to a topic."""
        self.node.create_subscription(kind, topic, self.seen.put_nowait)

    async def pictures(self, count: int) -> list[Any]:
        """Return a number of messages."""
        async with asyncio.timeout(20):
            return [await self.seen.get() for _ in range(count)]


@pytest.fixture
async def viewer(node_factory: Callable[..., Any], monkeypatch: pytest.MonkeyPatch) -> Viewer:
    """Return a viewer; no calibration is at home, and cameras are tried again soon."""
    monkeypatch.setenv("ROS_HOME", "/nowhere")
    monkeypatch.setattr("aionode.programs._camera.camera.RETRY_SEC", 0.05)
    return Viewer(node_factory("viewer"))


SMALL: dict[str, Any] = {"image_width": WIDTH, "image_height": HEIGHT, "framerate": 200.0}


async def test_a_video_in_the_place_of_a_camera_begins_anew_at_its_end(
    start: Start, viewer: Viewer, videos: Path
) -> None:
    """Its pictures come one after the other, with the frame of the camera."""
    viewer.look(Image, "image_raw")
    given_values = {"video_device": str(videos / "plain.mkv"), "pixel_format": "yuyv2rgb"}
    start(UsbCam, frame_id="eye", **SMALL | given_values)
    images = await viewer.pictures(12)

    assert {(each.width, each.height, each.encoding) for each in images} == {(64, 48, "rgb8")}
    assert images[0].header.frame_id == "eye"
    shades = [int(to_numpy(each).mean()) for each in images]
    assert shades[:10] == pytest.approx([20 * at for at in range(10)], abs=3)
    assert shades[10:] == shades[:2]


@pytest.mark.parametrize(
    ("pixels", "encoding", "shape"),
    [
        ("yuyv", "yuv422_yuy2", (48, 64, 2)),
        ("uyvy", "yuv422", (48, 64, 2)),
        ("mono8", "mono8", (48, 64)),
        ("rgb8", "rgb8", (48, 64, 3)),
    ],
)
async def test_pixel_formats_are_those_of_usb_cam(
    start: Start, viewer: Viewer, videos: Path, pixels: str, encoding: str, shape: tuple[int, ...]
) -> None:
    """Each with its encoding of ROS."""
    viewer.look(Image, "image_raw")
    start(UsbCam, video_device=str(videos / "plain.mkv"), pixel_format=pixels, **SMALL)
    image = (await viewer.pictures(5))[-1]

    assert image.encoding == encoding
    found = to_numpy(image)
    assert found.shape == shape
    luma = found[..., {"yuyv": 0, "uyvy": 1}[pixels]] if "uv" in encoding else found
    assert float(luma.mean()) == pytest.approx(80, abs=8)


async def test_jpeg_of_a_camera_is_passed_on_unchanged(
    start: Start, viewer: Viewer, videos: Path
) -> None:
    """As usb_cam does with `mjpeg`; there is no `image_raw` then."""
    viewer.look(CompressedImage, "image_raw/compressed")
    start(UsbCam, video_device=str(videos / "jpeg.mkv"), pixel_format="mjpeg", **SMALL)
    (picture,) = await viewer.pictures(1)

    assert picture.format == "jpeg"
    assert bytes(picture.data[:3]) == b"\xff\xd8\xff"
    assert decompress(picture).width == WIDTH
    names = {name for name, _ in viewer.node.get_topic_names_and_types()}
    assert "/image_raw" not in names


async def test_pictures_that_jpeg_cannot_hold_are_converted_for_it(
    start: Start, viewer: Viewer, videos: Path
) -> None:
    """Otherwise a subscription would end the camera, with the default format of usb_cam."""
    viewer.look(CompressedImage, "image_raw/compressed")
    start(UsbCam, video_device=str(videos / "plain.mkv"), **SMALL)
    picture = (await viewer.pictures(5))[-1]

    assert float(to_numpy(decompress(picture)).mean()) == pytest.approx(80, abs=8)


async def test_set_capture_ends_the_pictures(start: Start, viewer: Viewer, videos: Path) -> None:
    """It also begins them again."""
    viewer.look(CameraInfo, "camera_info")
    node = start(UsbCam, video_device=str(videos / "plain.mkv"), pixel_format="rgb8", **SMALL)
    client = viewer.node.create_client(SetBool, "set_capture")
    await viewer.pictures(1)

    assert (await client.call(SetBool.Request(data=False))).message == "Stop Capturing"
    assert not node.is_capturing
    assert (await client.call(SetBool.Request(data=True))).message == "Start Capturing"
    await viewer.pictures(2)


async def test_v4l2_camera_publishes_the_calibration_of_its_size(
    start: Start, viewer: Viewer, videos: Path, tmp_path: Path
) -> None:
    """With the stamp of the picture; zeros if the calibration is of another size."""
    file = tmp_path / "eye.yaml"
    info = CameraInfo(width=WIDTH, height=HEIGHT, distortion_model="plumb_bob")
    info.k = [100.0, 0.0, 32.0, 0.0, 100.0, 24.0, 0.0, 0.0, 1.0]
    file.write_text(text_of(info, "eye"))
    viewer.look(CameraInfo, "camera_info")
    images: list[Image] = []
    viewer.node.create_subscription(Image, "image_raw", images.append)
    start(
        V4L2Camera,
        video_device=str(videos / "plain.mkv"),
        image_size=[WIDTH, HEIGHT],
        time_per_frame=[1, 200],
        camera_info_url=f"file://{file}",
        camera_frame_id="eye",
    )
    (seen,) = await viewer.pictures(1)

    assert seen.k[0] == 100.0
    assert seen.header == images[0].header
    assert (seen.header.frame_id, images[0].encoding) == ("eye", "rgb8")


async def test_camera_ros_publishes_below_the_name_of_its_node(
    start: Start, viewer: Viewer, videos: Path
) -> None:
    """The pictures of a camera as they are, if nothing else is chosen."""
    viewer.look(Image, "/camera/image_raw")
    viewer.look(CameraInfo, "/camera/camera_info")
    start(CameraNode, camera=str(videos / "plain.mkv"), frame_id="eye")
    image, info = sorted(
        await viewer.pictures(2), key=lambda each: type(each).__name__, reverse=True
    )

    assert (image.width, image.height, image.encoding) == (WIDTH, HEIGHT, "rgb8")
    assert (info.width, info.height) == (WIDTH, HEIGHT)
    assert image.header == info.header
    assert image.header.frame_id == "eye"


@pytest.mark.parametrize(
    ("pixels", "encoding"),
    [
        ("BGR888", "rgb8"),
        ("RGB888", "bgr8"),
        ("XRGB8888", "bgra8"),
        ("ABGR8888", "rgba8"),
        ("YUYV", "yuv422_yuy2"),
        ("UYVY", "yuv422"),
        ("R8", "mono8"),
        ("R16", "mono16"),
        ("MJPEG", "rgb8"),
    ],
)
async def test_pixel_formats_of_camera_ros_are_those_of_libcamera(
    start: Start, viewer: Viewer, videos: Path, pixels: str, encoding: str
) -> None:
    """Their names and ROS's have opposite orders."""
    viewer.look(Image, "/camera/image_raw")
    start(CameraNode, camera=str(videos / "plain.mkv"), format=pixels, width=32, height=24)
    (image,) = await viewer.pictures(1)

    assert (image.encoding, image.width, image.height) == (encoding, 32, 24)


@pytest.mark.parametrize("pixels", ["", "XRGB8888", "YUYV", "UYVY", "R8", "R16", "MJPEG"])
async def test_pictures_of_camera_ros_are_jpeg_in_all_formats(
    start: Start, viewer: Viewer, videos: Path, pixels: str
) -> None:
    """For those who subscribe to them."""
    viewer.look(CompressedImage, "/camera/image_raw/compressed")
    start(CameraNode, camera=str(videos / "plain.mkv"), format=pixels)
    (picture,) = await viewer.pictures(1)

    assert decompress(picture).width == WIDTH


async def test_the_quality_of_jpeg_can_be_changed(
    start: Start, viewer: Viewer, videos: Path
) -> None:
    """While the camera runs, as in camera_ros."""
    node = start(CameraNode, camera=str(videos / "plain.mkv"), jpeg_quality=90)
    assert node.jpeg_quality == 90

    assert node.set_parameters([Parameter("jpeg_quality", value=20)])[0].successful
    assert node.jpeg_quality == 20
    assert not node.set_parameters([Parameter("jpeg_quality", value=101)])[0].successful


async def test_the_rate_is_that_of_the_shortest_time_between_pictures(
    start: Start, videos: Path
) -> None:
    """As libcamera has no parameter for a rate."""
    limits = {"FrameDurationLimits": [20000, 40000]}

    assert start(CameraNode, camera=str(videos / "plain.mkv"), **limits).rate == 50.0


async def test_parameters_that_need_libcamera_are_named_once_each(
    start: Start, videos: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nobody should wonder why a camera takes no notice of them; nor can they be set later."""
    given_values = {"role": "still", "sensor_mode": "1640:1232", "orientation": 180, "Gamma": 2.0}
    node = start(
        CameraNode, camera=str(videos / "plain.mkv"), format="R8", width=4, height=4, **given_values
    )

    lines = [line for line in capsys.readouterr().err.splitlines() if "no effect" in line]
    assert [line.partition("parameter '")[2].partition("'")[0] for line in lines] == list(
        given_values
    )
    assert not node.set_parameters([Parameter("AeEnable", value=False)])[0].successful


@pytest.fixture
def system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder that describes two cameras, one of them with a device for metadata."""
    usb = tmp_path / "usb1/1-4"
    for interface in ("1-4:1.0", "1-5:1.0"):
        (tmp_path / "usb1" / interface[:3] / interface).mkdir(parents=True)
    (usb / "idVendor").write_text("0ac8\n")
    (usb / "idProduct").write_text("3420\n")
    folder = tmp_path / "video4linux"
    for number, name, index, place in (
        (10, "Other", 0, "usb1/1-5/1-5:1.0"),
        (2, "HD Webcam", 0, "usb1/1-4/1-4:1.0"),
        (3, "HD Webcam", 1, "usb1/1-4/1-4:1.0"),
    ):
        device = folder / f"video{number}"
        device.mkdir(parents=True)
        (device / "name").write_text(f"{name}\n")
        (device / "index").write_text(f"{index}\n")
        (device / "device").symlink_to(tmp_path / place)
    monkeypatch.setattr(video, "SYSTEM", folder)
    monkeypatch.setattr("aionode.programs._camera.camera_node.SYSTEM", folder)
    return folder


@pytest.mark.usefixtures("system")
@pytest.mark.parametrize(
    ("camera", "device"),
    [
        (None, "/dev/video2"),
        (0, "/dev/video2"),
        (1, "/dev/video10"),
        ("Other", "/dev/video10"),
        ("/dev/video10", "/dev/video10"),
        (r"\_SB_.PCI0.RP05.PXSX.XHC_.RHUB.HS04-4:1.0-0ac8:3420", "/dev/video2"),
        ("/dev/null", "/dev/null"),
    ],
)
def test_a_camera_is_selected_by_index_or_name(camera: object, device: str) -> None:
    """Also by the name that libcamera gives to a camera at USB."""
    assert chosen(camera, devices()) == device


@pytest.mark.usefixtures("system")
@pytest.mark.parametrize("camera", [2, -1, True, "", "none", "-0ac8:3420", 0.5, [0]])
def test_a_camera_that_is_not_there_is_named_with_those_that_are(camera: object) -> None:
    """So that the right one can be chosen."""
    cameras = re.escape("cameras here: 0 'HD Webcam' (/dev/video2), 1 'Other' (/dev/video10)")
    with pytest.raises(CommandError, match=cameras):
        chosen(camera, devices())


async def test_a_calibration_is_kept_in_its_file(
    node_factory: Callable[..., Any], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """By the service that camera_calibration calls; below the home of ROS by default."""
    monkeypatch.setenv("ROS_HOME", str(tmp_path))
    node = node_factory("camera")
    Calibration(node, "eye", "")
    client = node.create_client(SetCameraInfo, "~/set_camera_info")
    info = CameraInfo(width=4, height=3, distortion_model="plumb_bob", d=[0.1, 0, 0, 0, 0])
    answer = await client.call(SetCameraInfo.Request(camera_info=info))

    assert answer.success
    assert info_of((tmp_path / "camera_info" / "eye.yaml").read_text()) == info


@given(
    st.lists(st.floats(-1e6, 1e6), min_size=33, max_size=33),
    st.lists(st.floats(-1e3, 1e3), max_size=8),
    st.integers(1, 10_000),
)
def test_a_calibration_is_restored_unchanged(
    numbers: list[float], d: list[float], size: int
) -> None:
    """Through its file."""
    info = CameraInfo(width=size, height=size + 1, distortion_model="rational_polynomial", d=d)
    info.k, info.r, info.p = numbers[:9], numbers[9:18], numbers[18:30]

    assert info_of(text_of(info, "eye")) == info


@given(st.text(max_size=40))
def test_what_is_no_calibration_is_one_error(text: str) -> None:
    """Whatever a file holds."""
    with pytest.raises(ValueError, match=r"no(t a)? calibration"):
        info_of(text)


@pytest.mark.parametrize("field", ["k", "r", "p", "width", "binning_x"])
def test_a_calibration_with_numbers_of_no_camera_is_the_same_error(field: str) -> None:
    """It would end the camera when it is published."""
    info = CameraInfo(width=4, height=3)
    setattr(info, field, {"k": [1.0], "r": [1.0] * 10, "p": [1.0] * 9}.get(field, -1))
    with pytest.raises(ValueError, match=rf"not a calibration: .*\.{field}: "):
        info_of(text_of(info, "eye"))


@pytest.mark.parametrize(
    "text", ["image_width: .inf", "[" * 5000, f"image_width: {'1:' * 20_000}1"]
)
def test_a_calibration_beyond_all_limits_is_the_same_error(text: str) -> None:
    """A camera should not end because of its calibration."""
    matrices = ("camera_matrix", "rectification_matrix", "projection_matrix")
    rest = "".join(f"\n{name}: {{data: [1]}}" for name in (*matrices, "distortion_coefficients"))
    with pytest.raises(ValueError, match="not a calibration"):
        info_of(text + rest)


@pytest.mark.parametrize(
    ("kind", "parameters", "text"),
    [
        (UsbCam, {"video_device": "/dev/video77"}, "video_device '/dev/video77' does not exist"),
        (UsbCam, {"pixel_format": "test"}, "pixel_format is 'test'; use yuyv, yuyv2rgb"),
        (UsbCam, {"image_width": 0}, "use numbers above 0"),
        (UsbCam, {"framerate": 0.0}, "should take 0 pictures per second; use 1e-06 to 1e.06"),
        (UsbCam, {"framerate": 1e-300}, "1e-300 pictures per second"),
        (V4L2Camera, {"time_per_frame": [1, 10**9]}, "1e.09 pictures per second"),
        (V4L2Camera, {"image_size": [640]}, "Invalid image size"),
        (V4L2Camera, {"output_encoding": "mono"}, "output_encoding 'mono'"),
        (CameraNode, {"camera": "none.mkv"}, "camera 'none.mkv' does not exist; cameras here"),
        (CameraNode, {"format": "NV21"}, "unsupported pixel format 'NV21'; use BGR888, RGB888"),
        (CameraNode, {"role": "photo"}, "invalid stream role: 'photo'; use viewfinder, video"),
        (CameraNode, {"sensor_mode": "1640x1232"}, "Expected .width.:.height. but got '1640x1232'"),
        (CameraNode, {"width": 640}, "width is 640 and height 0; use numbers above 0 for both"),
        (CameraNode, {"width": -1, "height": -1}, "width is -1 and height -1"),
        (V4L2Camera, {"image_size": [640, 10**8]}, "use at most 16384 for each"),
        (CameraNode, {"FrameDurationLimits": [3, 2]}, "FrameDurationLimits is .*such as .33333"),
        (CameraNode, {"FrameDurationLimits": "30"}, "FrameDurationLimits is '30'"),
        (CameraNode, {"FrameDurationLimits": [0.1, 0.2]}, "FrameDurationLimits is "),
    ],
)
async def test_what_does_not_fit_is_refused(
    start: Start, kind: Any, parameters: dict[str, Any], text: str
) -> None:
    """The error says what is valid."""
    with pytest.raises(CommandError, match=text):
        start(kind, **parameters)


@pytest.mark.parametrize("package", ["av", "PIL"])
async def test_a_package_that_is_missing_is_named_at_once(
    start: Start, videos: Path, monkeypatch: pytest.MonkeyPatch, package: str
) -> None:
    """Not only once somebody subscribes to compressed pictures."""
    monkeypatch.setattr(video, "find_spec", {"av": 1, "PIL": 1, package: None}.get)
    with pytest.raises(CommandError, match=r"pip install 'aionode\[camera\]'"):
        start(UsbCam, video_device=str(videos / "plain.mkv"))


async def test_a_file_that_is_no_video_is_said_and_tried_again(
    start: Start, viewer: Viewer, tmp_path: Path, videos: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As a camera that is pulled out, and is back a second later."""
    file = tmp_path / "a.mkv"
    file.write_bytes(b"no video")
    viewer.look(CameraInfo, "camera_info")
    start(UsbCam, video_device=str(file), pixel_format="rgb8", **SMALL)
    await until(lambda: "not a readable video" in capsys.readouterr().err)
    file.write_bytes((videos / "plain.mkv").read_bytes())

    assert await viewer.pictures(1)


@pytest.mark.parametrize("pixels", ["yuyv", "uyvy"])
async def test_odd_sizes_of_formats_with_pairs_of_pixels_are_said(
    start: Start, videos: Path, capsys: pytest.CaptureFixture[str], pixels: str
) -> None:
    """FFmpeg has none of them; a camera may have other sizes once it is plugged in again."""
    sizes = {"image_width": 63, "image_height": 47}
    start(UsbCam, video_device=str(videos / "plain.mkv"), pixel_format=pixels, **sizes)

    await until(lambda: "pictures of 63 x 47 pixels cannot be yuv422" in capsys.readouterr().err)


async def test_a_camera_may_come_later_if_its_check_is_skipped(
    start: Start, viewer: Viewer, tmp_path: Path, videos: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Otherwise a launch file that starts before udev would have no camera."""
    file = tmp_path / "a.mkv"
    viewer.look(CameraInfo, "camera_info")
    skip = {"skip_device_check": True}
    start(UsbCam, video_device=str(file), pixel_format="rgb8", **SMALL | skip)
    await until(lambda: "retrying until it can be opened" in capsys.readouterr().err)
    file.write_bytes((videos / "plain.mkv").read_bytes())

    assert await viewer.pictures(1)


async def test_a_silent_camera_does_not_keep_the_process(start: Start, tmp_path: Path) -> None:
    """Its driver answers only once it is unplugged, and Ctrl-C should not need that."""
    pipe = tmp_path / "a.mkv"
    os.mkfifo(pipe)
    node = start(UsbCam, video_device=str(pipe), pixel_format="rgb8", **SMALL)
    writer = await asyncio.to_thread(os.open, pipe, os.O_WRONLY)
    try:
        node.destroy_node()
        async with asyncio.timeout(50):
            await asyncio.get_running_loop().shutdown_default_executor()
    finally:
        os.close(writer)


async def test_a_control_is_set_again_when_its_parameter_is(
    start: Start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in the original: people turn brightness and exposure while they look."""
    log = tmp_path / "log"
    tool = tmp_path / "v4l2-ctl"
    tool.write_text(f'#!/bin/sh\necho "$@" >> {log}\n')
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    node = start(UsbCam, video_device="/dev/null", **SMALL)
    await until(lambda: log.exists() and "focus_auto=0" in log.read_text())

    assert node.set_parameters([Parameter("brightness", value=99)])[0].successful

    await until(lambda: log.read_text().count("focus_auto=0") == 2)
    assert "--device=/dev/null -c brightness=99" in log.read_text()


async def test_controls_of_the_camera_are_those_of_usb_cam(
    start: Start, viewer: Viewer, videos: Path
) -> None:
    """By the names that v4l2-ctl knows; what is -1 is left alone."""
    values = {"autoexposure": False, "exposure": 40, "gain": 7, "auto_white_balance": False}
    node = start(UsbCam, video_device=str(videos / "plain.mkv"), **SMALL | values)

    assert node.controls() == {
        "brightness": 50,
        "gain": 7,
        "white_balance_temperature_auto": 0,
        "white_balance_temperature": 4000,
        "exposure_auto": 1,
        "exposure_absolute": 40,
        "focus_auto": 0,
    }


@pytest.mark.slow
@pytest.mark.processes
@pytest.mark.timeout(90)
@pytest.mark.one_loop
def test_a_camera_is_started_by_its_name(videos: Path) -> None:
    """As a launch file does it; the other end reads the pictures."""
    env = {**os.environ, **isolated_environment(), "PYTHONUNBUFFERED": "1"}
    aionode = [sys.executable, "-m", "aionode"]
    device = f"video_device:={videos / 'plain.mkv'}"
    words = ["run", "v4l2_camera", "v4l2_camera_node", "--ros-args", "-p", device]
    with subprocess.Popen([*aionode, *words], env=env) as process:
        said = subprocess.run(
            [*aionode, "topic", "echo", "--once", "/image_raw", "sensor_msgs/msg/Image"],
            env=env, capture_output=True, text=True, check=False, timeout=60,
        )  # fmt: skip
        process.send_signal(signal.SIGINT)

    assert "width: 640" in said.stdout
    assert "encoding: rgb8" in said.stdout
