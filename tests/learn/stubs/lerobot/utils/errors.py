"""Errors of devices."""

__all__ = ["DeviceAlreadyConnectedError", "DeviceNotConnectedError"]


class DeviceNotConnectedError(ConnectionError):
    """A device is not connected."""

    def __init__(self, message: str = "not connected") -> None:
        self.message = message
        super().__init__(message)


class DeviceAlreadyConnectedError(ConnectionError):
    """A device is connected already."""

    def __init__(self, message: str = "already connected") -> None:
        self.message = message
        super().__init__(message)
