"""An undeclared AdvancedSubscriber goes on asking new publishers for their history."""

from __future__ import annotations

from typing import Any

import pytest
from zenoh import ext

from tests.zenoh_defects._support import endpoint, listening, session, until


def ignore(_: object) -> None:
    """Do nothing."""


@pytest.mark.parametrize(("handler", "asks"), [(ignore, True), ((ignore, None), False)])
def test_a_new_publisher_is_asked_by_a_subscriber_that_was_undeclared(
    handler: Any, *, asks: bool
) -> None:
    """Unless its handler keeps it out of the background."""
    asked: list[str] = []
    with session(listening(endpoint())) as one:
        subscriber = ext.declare_advanced_subscriber(
            one, "a", handler, history=ext.HistoryConfig(detect_late_publishers=True)
        )
        subscriber.undeclare()
        answering = one.declare_queryable(
            "a/@adv/**", lambda query: asked.append(str(query.key_expr))
        )

        token = one.liveliness().declare_token(f"a/@adv/pub/{one.zid()}/1/_")

        assert until(lambda: asked != [], 4.0 if asks else 0.5) is asks
        token.undeclare()
        answering.undeclare()
