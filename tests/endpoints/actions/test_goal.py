"""The states of a goal, row by row, and which goals a cancel request selects."""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.rules.goal import (
    ALL_GOALS,
    CancelCode,
    GoalEvent,
    GoalKey,
    GoalStatus,
    goals_to_cancel,
    next_status,
)
from aionode.errors import GoalTransitionError
from aionode.interfaces.action_msgs import msg, srv

LEGAL = [
    ("ACCEPTED", "EXECUTE", "EXECUTING"),
    ("ACCEPTED", "CANCEL_GOAL", "CANCELING"),
    ("EXECUTING", "CANCEL_GOAL", "CANCELING"),
    ("EXECUTING", "SUCCEED", "SUCCEEDED"),
    ("EXECUTING", "ABORT", "ABORTED"),
    ("CANCELING", "SUCCEED", "SUCCEEDED"),
    ("CANCELING", "ABORT", "ABORTED"),
    ("CANCELING", "CANCELED", "CANCELED"),
]
LEGAL_PAIRS = {(status, event) for status, event, _ in LEGAL}
ILLEGAL = [
    (status.name, event.name)
    for status, event in product(GoalStatus, GoalEvent)
    if (status.name, event.name) not in LEGAL_PAIRS
]
WORDS = [
    *("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING"),
    *("SUCCEEDED", "CANCELED", "ABORTED"),
]
ONE, TWO, THREE = (bytes([number]) * 16 for number in (1, 2, 3))


# Transitions


@pytest.mark.parametrize(("before", "event", "after"), LEGAL)
def test_each_row_of_the_table_leads_where_ros_says(before: str, event: str, after: str) -> None:
    """The table is the specification, and this is its second copy."""
    assert next_status(GoalStatus[before], GoalEvent[event]) is GoalStatus[after]


@pytest.mark.parametrize(("before", "event"), ILLEGAL)
def test_every_other_move_is_refused(before: str, event: str) -> None:
    """A goal that ends twice, or runs on after its end, would deceive its client."""
    with pytest.raises(GoalTransitionError) as caught:
        next_status(GoalStatus[before], GoalEvent[event], "c0ffee")

    assert (caught.value.status, caught.value.event) == (before, event)
    assert caught.value.goal_id == "c0ffee"


def test_an_illegal_move_says_what_is_possible() -> None:
    """The text is for a user who called succeed() too early."""
    with pytest.raises(
        GoalTransitionError,
        match="goal 42: cannot SUCCEED while ACCEPTED; only EXECUTE, CANCEL_GOAL is allowed",
    ):
        next_status(GoalStatus.ACCEPTED, GoalEvent.SUCCEED, "42")


def test_a_move_after_the_end_says_that_nothing_is_possible() -> None:
    """An empty list of possibilities would read like a mistake."""
    with pytest.raises(GoalTransitionError, match="no event is allowed"):
        next_status(GoalStatus.SUCCEEDED, GoalEvent.ABORT)


@pytest.mark.parametrize("word", WORDS)
def test_states_have_the_numbers_and_names_of_ros(word: str) -> None:
    """The numbers go over the wire, and users know the long names from rclpy."""
    number = getattr(msg.GoalStatus, f"STATUS_{word}")

    assert GoalStatus[word] == number
    assert GoalStatus[f"STATUS_{word}"] is GoalStatus[word]


def test_a_number_from_a_later_ros_reads_as_unknown() -> None:
    """A peer's new state must not break a client."""
    assert GoalStatus(42) is GoalStatus.UNKNOWN


def test_a_word_is_no_state() -> None:
    """Only numbers arrive from the wire; anything else is a mistake in a program."""
    with pytest.raises(ValueError, match="is not a valid GoalStatus"):
        GoalStatus("SUCCEEDED")  # type: ignore[arg-type]  # the mistake


@pytest.mark.parametrize("word", ["NONE", "REJECTED", "UNKNOWN_GOAL_ID", "GOAL_TERMINATED"])
def test_codes_have_the_numbers_of_ros(word: str) -> None:
    """They go over the wire."""
    assert CancelCode[word] == getattr(srv.CancelGoal.Response, f"ERROR_{word}")


@given(st.lists(st.sampled_from(list(GoalEvent))))
def test_no_sequence_of_events_leaves_an_end(events: list[GoalEvent]) -> None:
    """Whatever a server does, a goal ends once."""
    status, ends = GoalStatus.ACCEPTED, 0
    for event in events:
        try:
            status = next_status(status, event)
        except GoalTransitionError:
            continue
        ends += not status.is_active

    assert ends <= 1
    assert (ends == 0) is status.is_active


# Cancel requests


GOALS = [
    GoalKey(ONE, 100, GoalStatus.EXECUTING),
    GoalKey(TWO, 200, GoalStatus.ACCEPTED),
    GoalKey(THREE, 300, GoalStatus.EXECUTING),
]


@pytest.mark.parametrize(
    ("goal_id", "stamp_ns", "meant"),
    [
        pytest.param(TWO, 0, [TWO], id="one"),
        pytest.param(ALL_GOALS, 0, [ONE, TWO, THREE], id="all"),
        pytest.param(ALL_GOALS, 200, [ONE, TWO], id="up to a time, which counts itself"),
        pytest.param(ALL_GOALS, 99, [], id="up to a time before all"),
        pytest.param(THREE, 100, [ONE, THREE], id="up to a time, and one"),
        pytest.param(bytes(15) + b"\x01", 200, [ONE, TWO], id="up to a time, and an unknown goal"),
    ],
)
def test_a_request_means_these_goals(goal_id: bytes, stamp_ns: int, meant: list[bytes]) -> None:
    """The four forms of CancelGoal."""
    assert goals_to_cancel(GOALS, GoalKey(goal_id, stamp_ns)) == (CancelCode.NONE, meant)


def test_a_request_for_an_unknown_goal_says_so() -> None:
    """The client may have asked the wrong server."""
    assert goals_to_cancel([], GoalKey(ONE, 0)) == (CancelCode.UNKNOWN_GOAL_ID, [])


@pytest.mark.parametrize("status", ["SUCCEEDED", "CANCELED", "ABORTED", "CANCELING"])
def test_a_request_for_a_goal_that_cannot_be_cancelled_says_terminated(status: str) -> None:
    """As in rcl; also for one that is already being cancelled."""
    goals = [GoalKey(ONE, 100, GoalStatus[status])]

    assert goals_to_cancel(goals, GoalKey(ONE, 0)) == (CancelCode.GOAL_TERMINATED, [])


@pytest.mark.parametrize("asked", [GoalKey(ALL_GOALS, 0), GoalKey(ALL_GOALS, 500)])
def test_a_request_for_many_passes_over_those_that_have_ended(asked: GoalKey) -> None:
    """Cancelling all is not a mistake if some have ended."""
    goals = [GoalKey(ONE, 100, GoalStatus.SUCCEEDED), GoalKey(TWO, 200, GoalStatus.EXECUTING)]

    assert goals_to_cancel(goals, asked) == (CancelCode.NONE, [TWO])
