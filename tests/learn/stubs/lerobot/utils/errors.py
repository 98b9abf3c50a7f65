"""Errors of devices."""

__all__ = ["DeviceAlreadyConnectedError", "DeviceNotConnectedError"]


class DeviceNotConnectedError(ConnectionError):
    """It is not connected."""


class DeviceAlreadyConnectedError(ConnectionError):
    """It is connected already."""
