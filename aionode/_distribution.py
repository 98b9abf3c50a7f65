"""The ROS 2 distribution that the other nodes run, and its effect on the wire.

The fields of messages that differ between distributions are in `idl/_distribution_differences.py`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from aionode.errors import ConfigurationError

__all__ = [
    "DISTRIBUTIONS",
    "NO_TYPE_HASH",
    "choose_distribution",
    "distribution_mismatch",
    "other_distribution",
]

DISTRIBUTIONS: Final = ("humble", "iron", "jazzy", "kilted", "lyrical", "rolling")
DEFAULT: Final = "jazzy"
"""The distribution of the shipped interfaces; the wire is the same up to rolling."""

VARIABLE: Final = "ROS_DISTRO"

NO_TYPE_HASH: Final = "TypeHashNotSupported"
"""What ROS 2 Humble nodes send in place of every type hash."""

HUMBLE_HERE: Final = f"a Humble robot is here: set {VARIABLE}=humble to talk to it"
HUMBLE_ALONE: Final = f"this process speaks Humble, the others do not: unset {VARIABLE}"


def choose_distribution(environ: Mapping[str, str], ros_distro: str | None) -> str:
    """Return the distribution named by the argument, or else by the environment.

    An unknown name in the environment is taken for a newer distribution, and treated like the
    default.

    Raises:
        ConfigurationError: the argument is not a distribution.
    """
    if ros_distro is None:
        name = environ.get(VARIABLE, "").strip().lower()
        return name if name in DISTRIBUTIONS else DEFAULT
    if ros_distro not in DISTRIBUTIONS:
        raise ConfigurationError("ros_distro", ros_distro, f"use one of {', '.join(DISTRIBUTIONS)}")
    return ros_distro


def distribution_mismatch(own_hash: str, other_hash: str) -> str | None:
    """Return what to change if only one of two type hashes comes from Humble.

    Endpoints of Humble and of newer distributions never communicate over rmw_zenoh.
    """
    if own_hash == other_hash or NO_TYPE_HASH not in {own_hash, other_hash}:
        return None
    if other_hash == NO_TYPE_HASH:
        return HUMBLE_HERE
    return HUMBLE_ALONE


def other_distribution(ros_distro: str, type_hashes: Iterable[str]) -> str | None:
    """Return what to change if endpoints with these hashes cannot hear a context of `ros_distro`.

    In a network with both, a context hears those of its own kind.
    """
    hashless = {hash_ == NO_TYPE_HASH for hash_ in type_hashes}
    if hashless == {ros_distro != "humble"}:
        return HUMBLE_ALONE if ros_distro == "humble" else HUMBLE_HERE
    return None
