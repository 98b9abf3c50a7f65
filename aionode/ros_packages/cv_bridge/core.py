"""Converts OpenCV images, which are numpy arrays, to and from messages."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import numpy.typing as npt

from cv_bridge._colors import Pixels, cvtColor2
from cv_bridge._encodings import DEPTHS, cv_type, getCvType, type_name
from rclpy._arrays import array_over
from rosidl_generator_py import message_class

__all__ = ["CvBridge", "CvBridgeError"]

PASSTHROUGH = "passthrough"


class CvBridgeError(TypeError):
    """An image cannot be converted."""


class CvBridge:
    """Converts images.

    Attributes:
        cvtype_to_name: OpenCV's names of its types, by their numbers.
        cvdepth_to_numpy_depth: numpy's names of types, by the numbers of OpenCV's depths.
        numpy_type_to_cvtype: OpenCV's names of depths by numpy's names, and vice versa.
    """

    def __init__(self) -> None:
        self.cvdepth_to_numpy_depth = dict(enumerate(DEPTHS.values()))
        self.cvtype_to_name = {
            cv_type(depth, channels): f"{name}C{channels}"
            for depth, name in enumerate(DEPTHS)
            for channels in range(1, 5)
        }
        self.numpy_type_to_cvtype = {dtype: name for name, dtype in DEPTHS.items()}
        self.numpy_type_to_cvtype.update(DEPTHS)

    # Types

    def dtype_with_channels_to_cvtype2(self, dtype: np.dtype[Any], n_channels: int) -> str:
        """Return OpenCV's name for a type, such as 8UC3.

        Raises:
            KeyError: OpenCV has no such type.
        """
        return type_name(dtype.name, n_channels)

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """Return numpy's name for the type of a channel, and the number of channels."""
        return self.cvdepth_to_numpy_depth[cvtype & 7], (cvtype >> 3) + 1

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """Return the number of OpenCV's type for an encoding.

        Raises:
            CvBridgeError: The encoding is unknown.
        """
        try:
            return getCvType(encoding)
        except RuntimeError as error:
            raise CvBridgeError(error) from error

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return numpy's name for an encoding's channel type, and the number of channels.

        Raises:
            CvBridgeError: The encoding is unknown.
        """
        return self.cvtype2_to_dtype_with_channels(self.encoding_to_cvtype2(encoding))

    # Images

    def imgmsg_to_cv2(self, img_msg: Any, desired_encoding: str = PASSTHROUGH) -> Pixels:
        """Return the pixels of a message: rows, columns, and channels if there are several.

        They share the bytes of the message if nothing is converted and rows have no padding.

        Args:
            img_msg: A sensor_msgs/msg/Image.
            desired_encoding: The encoding to return, such as bgr8; ``passthrough`` for the
                message's.

        Raises:
            CvBridgeError: An encoding is unknown, or the two cannot be converted.
            TypeError: The message has less data than its size needs.
            ModuleNotFoundError: The conversion needs `cv2`, which is not installed.
        """
        name, channels = self.encoding_to_dtype_with_channels(img_msg.encoding)
        dtype = np.dtype(name).newbyteorder(">" if img_msg.is_bigendian else "<")
        columns = img_msg.step // (dtype.itemsize * channels)
        padded = array_over(
            img_msg.data,
            (img_msg.height, columns, channels),
            dtype,
            (img_msg.step, dtype.itemsize * channels, dtype.itemsize),
        )
        grey = padded[..., 0] if channels == 1 else padded
        pixels = np.ascontiguousarray(grey[:, : img_msg.width])
        if pixels.dtype.byteorder == (">" if sys.byteorder == "little" else "<"):
            pixels = pixels.astype(name)
        return self._converted(pixels, img_msg.encoding, desired_encoding)

    def cv2_to_imgmsg(
        self, cvim: npt.NDArray[Any], encoding: str = PASSTHROUGH, header: Any = None
    ) -> Any:
        """Return a sensor_msgs/msg/Image of an image.

        Args:
            cvim: The pixels.
            encoding: The meaning of the channels, such as bgr8; nothing is converted.
                ``passthrough`` stands for OpenCV's type, such as 8UC3.
            header: The header of the message.

        Raises:
            CvBridgeError: The encoding is unknown, or does not match the type of the image.
            KeyError: OpenCV has no such type.
            TypeError: `cvim` is not a numpy array.
        """
        check_is_array(cvim)
        channels = 1 if cvim.ndim < 3 else cvim.shape[2]
        cv_name = self.dtype_with_channels_to_cvtype2(cvim.dtype, channels)
        if encoding == PASSTHROUGH:
            encoding = cv_name
        elif self.cvtype_to_name.get(self.encoding_to_cvtype2(encoding)) != cv_name:
            raise CvBridgeError(
                f"encoding specified as {encoding}, but image has incompatible type {cv_name}"
            )
        message = message_class("sensor_msgs/msg/Image")(encoding=encoding)
        message.height, message.width = cvim.shape[:2]
        if header is not None:
            message.header = header
        order = cvim.dtype.byteorder
        message.is_bigendian = int(order == ">" or (order == "=" and sys.byteorder == "big"))
        message.data.frombytes(cvim.tobytes())
        message.step = len(message.data) // max(message.height, 1)
        return message

    # Compressed images

    def compressed_imgmsg_to_cv2(
        self, cmprs_img_msg: Any, desired_encoding: str = PASSTHROUGH
    ) -> Pixels:
        """Return the pixels of a compressed image: grey, BGR or BGRA, as in the file.

        Args:
            cmprs_img_msg: A sensor_msgs/msg/CompressedImage.
            desired_encoding: The encoding to which they are converted, such as rgb8.

        Raises:
            CvBridgeError: The encoding is unknown, or conversion is impossible; or the data is not
                an image.
            ModuleNotFoundError: `cv2` is not installed.
        """
        import cv2

        packed = np.frombuffer(bytes(cmprs_img_msg.data), np.uint8)
        pixels: Pixels | None = cv2.imdecode(packed, cv2.IMREAD_UNCHANGED) if packed.size else None
        if pixels is None:
            raise CvBridgeError(
                f"{packed.size} bytes of the format {cmprs_img_msg.format!r} are not an "
                "image that OpenCV can read"
            )
        if desired_encoding == "bgr8":  # unknown data is assumed to be in that encoding
            return pixels
        return self._converted(pixels, encoding_of(pixels), desired_encoding)

    def cv2_to_compressed_imgmsg(self, cvim: npt.NDArray[Any], dst_format: str = "jpg") -> Any:
        """Return a sensor_msgs/msg/CompressedImage of an image.

        Args:
            cvim: The pixels: grey, BGR or BGRA.
            dst_format: The file extension of the format, such as jpg or png.

        Raises:
            TypeError: `cvim` is not a numpy array.
            ModuleNotFoundError: `cv2` is not installed.
            cv2.error: OpenCV does not know the format, or cannot write such an image in it.
        """
        check_is_array(cvim)
        import cv2

        message = message_class("sensor_msgs/msg/CompressedImage")(format=dst_format)
        message.data.frombytes(cv2.imencode(f".{dst_format}", cvim)[1].tobytes())
        return message

    def _converted(self, pixels: Pixels, encoding: str, desired: str) -> Pixels:
        if desired == PASSTHROUGH:
            return pixels
        try:
            return cvtColor2(pixels, encoding, desired)
        except RuntimeError as error:
            raise CvBridgeError(error) from error


def check_is_array(image: Any) -> None:
    """Raise TypeError if an image is not a numpy array."""
    if not isinstance(image, np.ndarray | np.generic):
        raise TypeError("Your input type is not a numpy array")


def encoding_of(pixels: Pixels) -> str:
    """Return the encoding of an image that OpenCV has read from a file."""
    channels = 1 if pixels.ndim == 2 else pixels.shape[2]
    return f"{ {1: 'mono', 4: 'bgra'}.get(channels, 'bgr') }{pixels.dtype.itemsize * 8}"
