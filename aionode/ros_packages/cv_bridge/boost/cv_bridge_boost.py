"""The functions that cv_bridge implements in C++."""

from __future__ import annotations

from cv_bridge._colors import cvtColor2, cvtColorForDisplay
from cv_bridge._encodings import getCvType

__all__ = ["CV_MAT_CNWrap", "CV_MAT_DEPTHWrap", "cvtColor2", "cvtColorForDisplay", "getCvType"]


def CV_MAT_CNWrap(cvtype: int) -> int:  # cv_bridge's name
    """Return the number of channels of an OpenCV type."""
    return (cvtype >> 3) + 1


def CV_MAT_DEPTHWrap(cvtype: int) -> int:  # cv_bridge's name
    """Return the depth of an OpenCV type."""
    return cvtype & 7
