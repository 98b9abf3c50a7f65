"""Programs import this as `cv_bridge`: images of OpenCV to and from messages, over numpy."""

from __future__ import annotations

from cv_bridge._colors import cvtColorForDisplay
from cv_bridge._encodings import getCvType
from cv_bridge.core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError", "cvtColorForDisplay", "getCvType"]
