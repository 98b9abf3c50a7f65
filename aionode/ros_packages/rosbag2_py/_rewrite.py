"""Programs import these from `rosbag2_py`: they rewrite bags and their metadata."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from aionode import bag
from aionode.bag.yaml_files import outputs_in
from aionode.errors import AionodeError

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["Reindexer", "bag_rewrite"]


class Place(Protocol):
    """The parts of `StorageOptions` that are used: the place of a bag."""

    uri: str


def bag_rewrite(input_options: Sequence[Place], output_config_file: str, /) -> None:
    """Rewrite bags into one or more others.

    Args:
        input_options: The bags.
        output_config_file: A YAML file with ``output_bags``, as ``ros2 bag convert -o`` takes it.

    Raises:
        RuntimeError: a bag cannot be read, a new one exists or cannot be written, or the file
            requests a format other than MCAP.
    """
    try:
        for uri, options in outputs_in(output_config_file):
            bag.convert([place.uri for place in input_options], uri, **options)
    except (AionodeError, OSError, ValueError) as error:
        raise RuntimeError(str(error)) from error


class Reindexer:
    """Rebuilds the metadata of bags."""

    def reindex(self, storage_options: Place) -> None:
        """Write ``metadata.yaml`` from the files of a bag.

        Raises:
            RuntimeError: there are no files, or one is damaged.
        """
        try:
            bag.reindex(storage_options.uri)
        except (AionodeError, OSError) as error:
            raise RuntimeError(str(error)) from error
