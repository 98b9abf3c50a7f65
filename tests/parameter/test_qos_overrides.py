"""QoS through parameters."""

from __future__ import annotations

import pytest

from aionode.clock import Duration
from aionode.errors import InvalidQosOverridesError
from aionode.interfaces.rcl_interfaces.msg import SetParametersResult
from aionode.parameter import (
    Parameter,
    ParameterStore,
    QoSOverridingOptions,
    declare_qos_overrides,
)
from aionode.qos import HistoryPolicy, QoSPolicyKind, QoSProfile, ReliabilityPolicy

DEFAULT = QoSOverridingOptions.with_default_policies()
START = "qos_overrides./chatter.publisher"


def store(**overrides: object) -> ParameterStore:
    """Return the parameters of a node that was started with these overrides of a publisher."""
    return ParameterStore(
        "/node", overrides={f"{START}.{name}": value for name, value in overrides.items()}
    )


def declare(parameters: ParameterStore, options: QoSOverridingOptions = DEFAULT) -> QoSProfile:
    """Declare the overrides of a publisher of /chatter."""
    return declare_qos_overrides(parameters, "/chatter", "publisher", QoSProfile(depth=10), options)


def test_without_overrides_the_profile_is_as_written_and_shown() -> None:
    """History, depth and reliability become read-only parameters."""
    parameters = store()

    assert declare(parameters) == QoSProfile(depth=10)
    shown = parameters.get_parameters_by_prefix(START)
    assert {name: each.value for name, each in shown.items()} == {
        "history": "keep_last",
        "depth": 10,
        "reliability": "reliable",
    }
    refused = parameters.set_parameters_atomically([Parameter(f"{START}.depth", value=5)])
    assert "read-only" in refused.reason


def test_overrides_change_the_profile() -> None:
    """Values may be words in upper or lower case, numbers, or nanoseconds."""
    options = QoSOverridingOptions((*DEFAULT.policy_kinds, QoSPolicyKind.DEADLINE))
    parameters = store(history="KEEP_ALL", depth=5, reliability="best_effort", deadline=10**9)

    assert declare(parameters, options) == QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        depth=5,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        deadline=Duration(seconds=1),
    )


def test_a_subscription_has_no_lifespan() -> None:
    """Only publishers have one."""
    parameters = store()
    options = QoSOverridingOptions([QoSPolicyKind.LIFESPAN], entity_id="left")

    declare_qos_overrides(parameters, "/a", "subscription", QoSProfile(depth=1), options)
    declare_qos_overrides(parameters, "/a", "publisher", QoSProfile(depth=1), options)

    assert list(parameters.get_parameters_by_prefix("")) == [
        "qos_overrides./a.publisher_left.lifespan"
    ]


def test_two_endpoints_without_ids_share_their_parameters() -> None:
    """The second finds them declared."""
    parameters = store(depth=5)

    assert declare(parameters) == declare(parameters) == QoSProfile(depth=5)


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        ({"reliability": "good"}, "'good' is unknown; it may be system_default, reliable"),
        ({"depth": -1}, "depth=-1 is negative"),
    ],
)
def test_a_value_that_does_not_fit_is_an_error(overrides: dict[str, object], says: str) -> None:
    """The error is raised when the endpoint is created."""
    with pytest.raises(InvalidQosOverridesError, match=says):
        declare(store(**overrides))


def test_the_node_may_reject_a_profile() -> None:
    """With its callback."""
    options = QoSOverridingOptions.with_default_policies(
        callback=lambda profile: SetParametersResult(successful=profile.depth > 5, reason="short")
    )

    assert declare(store(), options) == QoSProfile(depth=10)
    with pytest.raises(InvalidQosOverridesError, match=r"publisher of /chatter: .*: short"):
        declare(store(depth=5), options)
