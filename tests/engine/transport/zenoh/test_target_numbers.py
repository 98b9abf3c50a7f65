"""Numbers of publishers of ROS 2 Lyrical, which count each target of a message."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.transport.zenoh._target_numbers import TargetNumbers

GID = b"g" * 16


def lost(numbers: list[int]) -> int:
    """Return how many numbers are missing."""
    return sum(after - before - 1 for before, after in pairwise(numbers))


def heard(others: int, taken: list[int]) -> list[int]:
    """Return how the numbers of a publisher are interpreted."""
    numbers = TargetNumbers(lambda: others)
    return [numbers.number(GID, each, by_target=True) for each in taken]


@given(
    known=st.integers(0, 5),
    gone=st.integers(0, 5),
    start=st.integers(1, 1000),
    losses=st.sets(st.sampled_from([n for n in range(10, 90) if n % 7 < 4])),
)
def test_only_what_is_lost_is_missing(known: int, gone: int, start: int, losses: set[int]) -> None:
    """Whether the other targets are known here, or went before: the publisher keeps them all."""
    rise = 1 + known + gone
    taken = [start + n * rise for n in range(100) if n not in losses]

    assert lost(heard(known, taken)) == len(losses)


@given(st.lists(st.integers(0, 3), min_size=2, max_size=50))
def test_subscriptions_that_come_lose_nothing(joining: list[int]) -> None:
    """Each takes a number from then on, for as long as the publisher lives."""
    others, taken, numbers = 0, 1, TargetNumbers(lambda: others)
    given_numbers = []
    for number in joining:
        given_numbers.append(numbers.number(GID, taken, by_target=True))
        others += number
        taken += 1 + others

    assert lost(given_numbers) == 0


def test_a_loss_is_missing_before_the_rise_is_known() -> None:
    """The first messages are no exception, if the subscriptions are known."""
    assert heard(1, [1, 5, 7, 9]) == [1, 2, 4, 5]


def test_a_subscription_that_went_long_ago_is_a_target() -> None:
    """A viewer that was restarted before this program started is one."""
    assert heard(0, [3, 6, 9, 12, 15]) == [3, 4, 5, 6, 7]


def test_a_subscription_that_came_and_went_unseen_is_a_target_after_a_while() -> None:
    """An echo of one message is one: from the fifth message on, apparent losses end."""
    assert lost(heard(0, [1, 2, 3, 5, 7, 9, 11, 13, 15, 17])) == 4


def test_messages_on_the_key_of_all_are_numbered_one_by_one() -> None:
    """A publisher uses it while it has a subscription that it has not discovered."""
    numbers = TargetNumbers(lambda: 1)
    taken = [(1, True), (3, True), (5, True), (7, False), (8, False), (9, True), (11, True)]

    assert [numbers.number(GID, each, by_target=key) for each, key in taken] == [*range(1, 8)]


@pytest.mark.parametrize("again", [5, 7])
def test_a_message_that_comes_late_or_again_is_no_new_one(again: int) -> None:
    """Its number is not above the last."""
    assert heard(1, [3, 5, 7, again])[-1] <= heard(1, [3, 5, 7])[-1]


def test_publishers_that_number_messages_keep_their_numbers() -> None:
    """Nodes of aionode and of ROS 2 before Lyrical do so, and use the key of all."""
    numbers = TargetNumbers(lambda: 3)

    assert [numbers.number(GID, n, by_target=False) for n in (4, 5, 9)] == [4, 5, 9]


def test_only_so_many_publishers_are_remembered() -> None:
    """Messages may carry any number of invented gids."""
    numbers = TargetNumbers(lambda: 1)
    for n in range(3_000):
        numbers.number(n.to_bytes(16), 7, by_target=True)

    assert numbers.number((2_999).to_bytes(16), 9, by_target=True) == 8
    assert numbers.number((0).to_bytes(16), 9, by_target=True) == 9
