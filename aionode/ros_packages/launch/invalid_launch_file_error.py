"""`launch.invalid_launch_file_error`."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["InvalidLaunchFileError"]


class InvalidLaunchFileError(Exception):
    """A launch file requested by a program cannot be read.

    Args:
        extension: The extension of its name, without the dot.
        likely_errors: The errors that occurred.
    """

    def __init__(self, extension: str = "", *, likely_errors: Sequence[Exception] = ()) -> None:
        what = "".join(f"\n - {type(error).__name__}: {error}" for error in likely_errors)
        of_kind = f" of the format [{extension}]" if extension else ""
        super().__init__(f"The launch file{of_kind} cannot be read:{what}" if what else "Invalid")
        if likely_errors:
            self.__cause__ = likely_errors[0]
