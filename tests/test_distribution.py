"""Which distribution of ROS 2 a context belongs to."""

from __future__ import annotations

import pytest

from aionode._distribution import NO_TYPE_HASH, choose_distribution, other_distribution
from aionode.errors import ConfigurationError


@pytest.mark.parametrize(
    ("environ", "argument", "expected"),
    [
        ({}, None, "jazzy"),
        ({"ROS_DISTRO": ""}, None, "jazzy"),
        ({"ROS_DISTRO": "humble"}, None, "humble"),
        ({"ROS_DISTRO": "Humble "}, None, "humble"),
        ({"ROS_DISTRO": "humble"}, "kilted", "kilted"),
        ({"ROS_DISTRO": "not_released_yet"}, None, "jazzy"),
    ],
)
def test_the_argument_wins_over_the_environment(
    environ: dict[str, str], argument: str | None, expected: str
) -> None:
    """A distribution that is not known yet is newer, and has Jazzy's wire format."""
    assert choose_distribution(environ, argument) == expected


def test_an_argument_that_is_no_distribution_is_refused() -> None:
    """A misspelled humble would hear nothing."""
    with pytest.raises(ConfigurationError, match=r"ros_distro.*humbel.*use one of humble, iron"):
        choose_distribution({}, "humbel")


@pytest.mark.parametrize(
    ("own", "hashes", "hint"),
    [
        ("jazzy", set(), None),
        ("jazzy", {"RIHS01_1"}, None),
        ("jazzy", {"RIHS01_1", NO_TYPE_HASH}, None),
        ("jazzy", {NO_TYPE_HASH}, "set ROS_DISTRO=humble"),
        ("humble", {NO_TYPE_HASH}, None),
        ("humble", {NO_TYPE_HASH, "RIHS01_1"}, None),
        ("humble", {"RIHS01_1"}, "unset ROS_DISTRO"),
    ],
)
def test_only_other_distributions_are_worth_a_hint(
    own: str, hashes: set[str], hint: str | None
) -> None:
    """In a mixed network, a context hears its own kind."""
    found = other_distribution(own, hashes)

    assert found is None if hint is None else found is not None and hint in found
