"""Tests the questions of `make tf-differential`, without tf2's core to compare with."""

from __future__ import annotations

from tests.tf.differential.__main__ import agree, cases, result


def test_each_random_question_has_an_answer() -> None:
    """It is a transform, a text or one of tf2's errors; any other exception is a defect."""
    kinds = set()
    for case in cases(60):
        for answer in case.answers:
            kinds.add(result(answer).split()[0])

    assert {"new", "set", "ok", "error", "can", "latest", "text"} <= kinds


def test_answers_agree_within_the_last_digits_and_up_to_the_sign_of_a_quaternion() -> None:
    """A quaternion and its negative are the same rotation; texts have to be equal."""
    assert agree("ok 1.0 2 3 0 0 0 1 5", "ok 1.0000000000001 2 3 -0 -0 -0 -1 5")
    assert not agree("ok 1.0 2 3 0 0 0 1 5", "ok 1.001 2 3 0 0 0 1 5")
    assert not agree("ok 1 2 3 0 0 0 1 5", "ok 1 2 3 0 0 0 1 6")
    assert not agree("error LookupException a", "error LookupException b")
