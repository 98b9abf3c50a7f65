"""The table of a managed node, and the machine that follows it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.rules.lifecycle_states import (
    ACTIVE,
    FINALIZED,
    STATES,
    TRANSITIONS,
    UNCONFIGURED,
    StateMachine,
    TransitionCallbackReturn,
)

SUCCESS = TransitionCallbackReturn.SUCCESS


def test_the_table_is_that_of_rcl_lifecycle() -> None:
    """Twenty-five transitions in the order in which `ros2 lifecycle list -a` prints them."""
    assert [one.transition_id for one in TRANSITIONS] == [
        *(1, 10, 11, 12, 2, 20, 21, 22, 3, 30, 31, 32, 4, 40, 41, 42),
        *(5, 6, 7, 50, 51, 52, 60, 61, 62),
    ]
    assert [state.state_id for state in STATES] == [0, 1, 2, 3, 4, 10, 11, 12, 13, 14, 15]


def test_a_label_wins_over_the_number() -> None:
    """`id=3, label='configure'` configures, as with rcl_lifecycle."""
    found = StateMachine().find("configure", 3)

    assert found is not None
    assert found.transition_id == 1


def test_success_of_each_transition_leads_to_the_next_state() -> None:
    """Configure, activate, and shut down from there."""
    machine = StateMachine()
    states = []
    for label in ("configure", "activate", "shutdown"):
        transition = machine.find(label)
        assert transition is not None
        machine.begin(transition)
        machine.finish(SUCCESS)
        states.append(machine.state.label)

    assert states == ["inactive", "active", "finalized"]


def test_nothing_is_available_when_finalized() -> None:
    """A finalized node can only be destroyed."""
    machine = StateMachine()
    machine.state = FINALIZED

    assert machine.available() == []


def test_a_transition_from_another_state_is_refused() -> None:
    """The machine never jumps."""
    machine = StateMachine()
    machine.state = ACTIVE

    with pytest.raises(ValueError, match=r"configure \[1\] starts in unconfigured"):
        machine.begin(TRANSITIONS[0])


def test_a_result_without_a_transition_is_refused() -> None:
    """No callback was running that could have returned it."""
    with pytest.raises(ValueError, match="no transition is in progress in unconfigured"):
        StateMachine().finish(SUCCESS)


@given(
    st.lists(st.tuples(st.integers(0, 8), st.sampled_from(TransitionCallbackReturn)), max_size=30)
)
def test_every_way_through_the_table_stays_in_it(
    steps: list[tuple[int, TransitionCallbackReturn]],
) -> None:
    """After each result the node is in a primary state, or processes an error."""
    machine = StateMachine()
    for transition_id, result in steps:
        transition = machine.find(transition_id=transition_id)
        if transition is None:
            continue
        machine.begin(transition)
        assert machine.in_transition
        machine.finish(result)
        if machine.in_transition:
            machine.finish(result)
        assert machine.state in STATES[:5]
        assert machine.state != STATES[0]
    assert machine.state == UNCONFIGURED or steps
