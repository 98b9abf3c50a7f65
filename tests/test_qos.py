"""QoS: profiles, presets, and which profiles are compatible."""

from __future__ import annotations

import copy
import re
from itertools import product

import pytest

from aionode import qos
from aionode.clock import Duration, Infinite
from aionode.errors import InvalidQoSProfileException
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSCompatibility,
    QoSPolicyKind,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)

AUTOMATIC = LivelinessPolicy.AUTOMATIC
MANUAL = LivelinessPolicy.MANUAL_BY_TOPIC


def profile(**policies: object) -> QoSProfile:
    """Return a profile in which nothing is left to the system."""
    return QoSProfile(depth=1, liveliness=AUTOMATIC).replace(**policies)


# Making profiles


def test_a_depth_alone_is_keep_last_reliable_volatile() -> None:
    """As in rclpy."""
    made = QoSProfile(depth=7)

    assert made.history is HistoryPolicy.KEEP_LAST
    assert made.depth == 7
    assert made.reliability is ReliabilityPolicy.RELIABLE
    assert made.durability is DurabilityPolicy.VOLATILE
    assert made.liveliness is LivelinessPolicy.SYSTEM_DEFAULT
    assert made.deadline == made.lifespan == made.liveliness_lease_duration == Duration()
    assert made.avoid_ros_namespace_conventions is False


def test_keep_all_needs_no_depth() -> None:
    """Its bound is the default depth, or what the subscription's depth says."""
    assert QoSProfile(history=HistoryPolicy.KEEP_ALL).depth == 10


def test_a_profile_without_history_and_depth_is_refused() -> None:
    """The size of a queue is a choice that its user makes."""
    with pytest.raises(InvalidQoSProfileException, match="depth"):
        QoSProfile()
    with pytest.raises(InvalidQoSProfileException, match="KEEP_LAST without a depth"):
        QoSProfile(history=HistoryPolicy.KEEP_LAST)


def test_a_policy_may_be_given_by_number() -> None:
    """As rclpy converts ints, and messages of the graph carry them."""
    assert QoSProfile(depth=1, reliability=2).reliability is ReliabilityPolicy.BEST_EFFORT


@pytest.mark.parametrize(
    ("name", "value", "error", "says"),
    [
        ("reliability", 9, InvalidQoSProfileException, "reliability=9 is unknown"),
        ("reliability", 9, ValueError, "best_effort (2)"),
        ("reliability", "reliable", TypeError, "must be a ReliabilityPolicy"),
        ("reliability", DurabilityPolicy.VOLATILE, TypeError, "must be a ReliabilityPolicy"),
        ("durability", True, TypeError, "must be a DurabilityPolicy"),
        ("liveliness", 2, InvalidQoSProfileException, "automatic (1), manual_by_topic (3)"),
        ("depth", -1, InvalidQoSProfileException, "depth=-1 is negative"),
        ("depth", 1.5, TypeError, "depth must be an int"),
        ("depth", True, TypeError, "depth must be an int"),
        ("deadline", 0.1, TypeError, "Duration(seconds=0.1)"),
        ("deadline", Duration(nanoseconds=-1), InvalidQoSProfileException, "negative"),
        ("avoid_ros_namespace_conventions", 1, TypeError, "True or False"),
    ],
)
def test_a_value_that_does_not_fit_names_the_field_and_what_fits(
    name: str, value: object, error: type[Exception], says: str
) -> None:
    """The mistake is found where it is made, when made and when changed."""
    made = QoSProfile(depth=1)

    with pytest.raises(error, match=re.escape(says)):
        setattr(made, name, value)
    assert made == QoSProfile(depth=1)


def test_a_misspelled_policy_is_refused() -> None:
    """`qos.reliabilty = …` would otherwise do nothing."""
    with pytest.raises(AttributeError, match="no 'reliabilty'; it has history, depth, reliability"):
        QoSProfile(depth=1).reliabilty = ReliabilityPolicy.RELIABLE  # type: ignore[attr-defined]


def test_a_depth_of_zero_warns_and_means_the_systems() -> None:
    """As in rclpy, which warns too; rmw_zenoh takes 42."""
    with pytest.warns(UserWarning, match="A zero depth with KEEP_LAST doesn't make sense"):
        made = QoSProfile(depth=0)

    assert made.resolved().depth == 42


def test_equal_profiles_are_equal_and_hash_alike() -> None:
    """A profile is a value."""
    one = QoSProfile(depth=1, deadline=Duration(seconds=2))
    same = QoSProfile(depth=1, deadline=Duration(seconds=2))

    assert one == same
    assert hash(one) == hash(same)
    assert one != QoSProfile(depth=1)
    assert one != "profile"


def test_a_profile_can_be_copied_and_changed() -> None:
    """A copy is independent."""
    made = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    other = copy.deepcopy(made)
    other.depth = 2

    assert made.depth == 1
    assert made.replace(depth=2) == other


def test_repr_makes_an_equal_profile() -> None:
    """It shows only what is not the default."""
    made = QoSProfile(
        history=HistoryPolicy.KEEP_ALL,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        deadline=Duration(seconds=1),
    )
    names = {"QoSProfile": QoSProfile, "Duration": Duration}
    policies = {"HistoryPolicy": HistoryPolicy, "ReliabilityPolicy": ReliabilityPolicy}

    assert eval(repr(made), names | policies) == made  # noqa: S307 - our own text
    assert repr(QoSProfile(depth=10)) == "QoSProfile(depth=10)"


def test_str_says_the_policies_in_a_few_words() -> None:
    """Log lines show profiles."""
    made = QoSProfile(depth=3, deadline=Duration(seconds=0.1), liveliness=MANUAL)

    assert str(made) == "keep_last(3) reliable volatile deadline=0.1 s manual_by_topic"
    assert str(profile(lifespan=Infinite)) == "keep_last(1) reliable volatile"


# What create_publisher and create_subscription take


def test_an_int_means_keep_last() -> None:
    """`create_publisher(String, "chatter", 10)`."""
    assert qos.as_profile(10) == QoSProfile(depth=10)


def test_an_entity_gets_a_copy_of_a_profile() -> None:
    """Presets are shared: one entity must not change another's."""
    taken = qos.as_profile(qos.qos_profile_sensor_data)
    taken.depth = 99

    assert qos.qos_profile_sensor_data.depth == 5


def test_a_negative_depth_is_a_value_error() -> None:
    """As in rclpy."""
    with pytest.raises(ValueError, match="greater than or equal to zero, not -1"):
        qos.as_profile(-1)


@pytest.mark.parametrize("value", ["10", 1.0, None, True, ReliabilityPolicy])
def test_anything_else_is_a_type_error_that_shows_it(value: object) -> None:
    """As in rclpy."""
    with pytest.raises(TypeError, match="Expected QoSProfile or int"):
        qos.as_profile(value)


# Presets


@pytest.mark.parametrize(
    ("preset", "text"),
    [
        ("default", "keep_last(10) reliable volatile"),
        ("sensor_data", "keep_last(5) best_effort volatile"),
        ("services_default", "keep_last(10) reliable volatile"),
        ("parameters", "keep_last(1000) reliable volatile"),
        ("parameter_events", "keep_last(1000) reliable volatile"),
        ("action_status_default", "keep_last(1) reliable transient_local"),
        ("rosout_default", "keep_last(1000) reliable transient_local lifespan=10 s"),
        ("system_default", "system_default(0) system_default system_default"),
        ("unknown", "unknown(0) unknown unknown unknown"),
    ],
)
def test_a_preset_is_what_rmw_says(preset: str, text: str) -> None:
    """Peers of other languages have the same presets."""
    assert str(QoSPresetProfiles.get_from_short_key(preset)) == text


def test_short_keys_are_found_in_any_case() -> None:
    """The command line takes them as typed."""
    assert QoSPresetProfiles.get_from_short_key("Sensor_DATA") is qos.qos_profile_sensor_data
    assert HistoryPolicy.short_keys() == ["system_default", "keep_last", "keep_all", "unknown"]
    assert HistoryPolicy.get_from_short_key("KEEP_last") == HistoryPolicy.KEEP_LAST
    assert HistoryPolicy.KEEP_ALL.short_key == "keep_all"
    assert "best_available" in QoSPresetProfiles.short_keys()


def test_rclpys_older_names_are_the_same_classes() -> None:
    """Code from rclpy keeps working."""
    assert qos.QoSReliabilityPolicy is ReliabilityPolicy
    assert qos.QoSDurabilityPolicy is DurabilityPolicy
    assert qos.QoSHistoryPolicy is HistoryPolicy
    assert qos.QoSLivelinessPolicy is LivelinessPolicy


def test_kinds_have_rmws_numbers_and_names() -> None:
    """Events carry them."""
    assert qos.qos_policy_name_from_kind(16) == "RELIABILITY"
    assert QoSPolicyKind(256) is QoSPolicyKind.LIVELINESS_LEASE_DURATION


def test_resolving_leaves_nothing_to_the_system() -> None:
    """What the graph shows of an endpoint is what it does."""
    resolved = qos.qos_profile_system_default.resolved()

    assert str(resolved) == "keep_last(42) reliable volatile"
    assert resolved.liveliness is AUTOMATIC
    assert resolved.deadline == Infinite


# Compatibility

RELIABILITY = [ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE]
DURABILITY = [DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL]
LIVELINESS = [AUTOMATIC, MANUAL]


@pytest.mark.parametrize(
    ("name", "weak", "strong", "kind"),
    [
        ("reliability", *RELIABILITY, QoSPolicyKind.RELIABILITY),
        ("durability", *DURABILITY, QoSPolicyKind.DURABILITY),
        ("liveliness", *LIVELINESS, QoSPolicyKind.LIVELINESS),
    ],
)
def test_only_a_weak_offer_to_a_strong_request_does_not_fit(
    name: str, weak: object, strong: object, kind: QoSPolicyKind
) -> None:
    """The table of ROS's documentation, row by row."""
    for offered, requested in product([weak, strong], repeat=2):
        found = qos.incompatibilities(profile(**{name: offered}), profile(**{name: requested}))
        fits = not (offered is weak and requested is strong)

        assert [each.kind for each in found] == ([] if fits else [kind])


@pytest.mark.parametrize("name", ["deadline", "liveliness_lease_duration"])
@pytest.mark.parametrize(
    ("offered", "requested", "fits"),
    [
        (Duration(), Duration(), True),
        (Duration(), Duration(seconds=1), False),
        (Infinite, Duration(seconds=1), False),
        (Duration(seconds=1), Duration(), True),
        (Duration(seconds=1), Infinite, True),
        (Duration(seconds=1), Duration(seconds=1), True),
        (Duration(seconds=1), Duration(seconds=2), True),
        (Duration(seconds=2), Duration(seconds=1), False),
    ],
)
def test_a_limit_of_time_may_be_tighter_than_requested_but_not_wider(
    name: str, offered: Duration, requested: Duration, *, fits: bool
) -> None:
    """Zero and infinite both mean no limit."""
    why = qos.mismatch(profile(**{name: offered}), profile(**{name: requested}))

    assert (why is None) is fits


def test_history_depth_and_lifespan_never_matter() -> None:
    """They are the business of one side."""
    one = profile(history=HistoryPolicy.KEEP_ALL, depth=1, lifespan=Duration(seconds=1))
    other = profile(depth=1000)

    assert qos.mismatch(one, other) is None
    assert qos.mismatch(other, one) is None


def test_the_reason_names_policy_offer_and_request() -> None:
    """One text for logs, command line and tests."""
    offered = profile(reliability=ReliabilityPolicy.BEST_EFFORT, deadline=Duration(seconds=1))
    requested = profile(deadline=Duration(seconds=0.5))

    assert qos.mismatch(offered, requested) == (
        "reliability: offered best_effort, requested reliable; "
        "deadline: offered 1 s, requested 0.5 s"
    )
    assert qos.incompatibilities(offered, requested)[-1].kind is QoSPolicyKind.DEADLINE


def test_what_is_left_to_the_system_counts_as_what_the_system_does() -> None:
    """Reliable, volatile, automatic: a request for more does not fit."""
    left = qos.qos_profile_system_default

    assert qos.mismatch(left, profile()) is None
    assert qos.mismatch(profile(reliability=ReliabilityPolicy.BEST_EFFORT), left) is not None
    assert qos.mismatch(left, profile(liveliness=MANUAL)) is not None


def test_the_warnings_have_rclpys_words() -> None:
    """A web search for them finds ROS's answers."""
    assert qos.incompatible_qos_text("/a", QoSPolicyKind.RELIABILITY, publisher=True) == (
        "New publisher discovered on topic '/a', offering incompatible QoS. "
        "No messages will be received from it. Last incompatible policy: RELIABILITY"
    )
    assert qos.incompatible_qos_text("/a", QoSPolicyKind.DURABILITY, publisher=False) == (
        "New subscription discovered on topic '/a', requesting incompatible QoS. "
        "No messages will be sent to it. Last incompatible policy: DURABILITY"
    )


def test_checking_a_pair_that_fits_is_ok_without_a_reason() -> None:
    """As rclpy's test_compatible."""
    pair = profile(deadline=Duration(seconds=1), liveliness_lease_duration=Duration(seconds=1))

    assert qos.qos_check_compatible(pair, pair) == (QoSCompatibility.OK, "")


def test_checking_a_pair_that_does_not_fit_is_an_error_with_all_reasons() -> None:
    """As rclpy's test_incompatible."""
    compatibility, reason = qos.qos_check_compatible(
        profile(reliability=ReliabilityPolicy.BEST_EFFORT),
        profile(durability=DurabilityPolicy.TRANSIENT_LOCAL),
    )

    assert compatibility is QoSCompatibility.ERROR
    assert reason == (
        "ERROR: reliability: offered best_effort, requested reliable;"
        "ERROR: durability: offered volatile, requested transient_local;"
    )


@pytest.mark.parametrize(
    ("offered", "requested"),
    [
        (qos.qos_profile_system_default, profile()),
        (profile(), qos.qos_profile_unknown),
        (qos.qos_profile_unknown, qos.qos_profile_unknown),
        (profile(reliability=ReliabilityPolicy.BEST_EFFORT), qos.qos_profile_system_default),
    ],
)
def test_a_policy_left_open_is_a_warning_where_it_matters(
    offered: QoSProfile, requested: QoSProfile
) -> None:
    """As rclpy's test_warn_of_possible_incompatibility."""
    compatibility, reason = qos.qos_check_compatible(offered, requested)

    assert compatibility is QoSCompatibility.WARNING
    assert reason.startswith("WARNING: ")


def test_a_policy_left_open_is_ok_where_it_cannot_matter() -> None:
    """The strongest offer serves any request; the weakest request takes any offer."""
    strongest = profile(durability=DurabilityPolicy.TRANSIENT_LOCAL, liveliness=MANUAL)
    weakest = profile(reliability=ReliabilityPolicy.BEST_EFFORT)

    assert qos.qos_check_compatible(strongest, qos.qos_profile_unknown)[0] is QoSCompatibility.OK
    assert qos.qos_check_compatible(qos.qos_profile_unknown, weakest)[0] is QoSCompatibility.OK


# Best available

BEST = qos.qos_profile_best_available


def test_best_available_alone_is_the_strongest_there_is() -> None:
    """No endpoint is visible that would not receive messages."""
    assert str(qos.best_available_for_subscription(BEST, [])) == (
        "keep_last(10) reliable transient_local manual_by_topic"
    )
    assert str(qos.best_available_for_publisher(BEST, [])) == (
        "keep_last(10) reliable transient_local"
    )


def test_a_subscription_takes_the_strongest_that_all_publishers_offer() -> None:
    """One weak publisher decides; the widest limit of time counts."""
    lease = Duration(seconds=9)
    publishers = [
        profile(
            liveliness_lease_duration=lease,
            deadline=Duration(seconds=1),
            durability=DurabilityPolicy.TRANSIENT_LOCAL,
        ),
        profile(deadline=Duration(seconds=3), reliability=ReliabilityPolicy.BEST_EFFORT),
    ]

    taken = qos.best_available_for_subscription(BEST, publishers)

    assert taken.reliability is ReliabilityPolicy.BEST_EFFORT
    assert taken.durability is DurabilityPolicy.VOLATILE
    assert taken.liveliness is AUTOMATIC
    assert taken.deadline == Duration(seconds=3)
    assert taken.liveliness_lease_duration == Duration()


def test_a_publisher_promises_what_the_most_demanding_subscription_asks() -> None:
    """The tightest limit of time counts."""
    subscriptions = [
        profile(deadline=Duration(seconds=1)),
        profile(deadline=Duration(seconds=3), liveliness=MANUAL),
        profile(),
    ]

    taken = qos.best_available_for_publisher(BEST, subscriptions)

    assert taken.reliability is ReliabilityPolicy.RELIABLE
    assert taken.durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert taken.liveliness is MANUAL
    assert taken.deadline == Duration(seconds=1)
    assert all(qos.mismatch(taken, each) is None for each in subscriptions)


def test_only_policies_that_are_best_available_are_resolved() -> None:
    """A policy that the user has chosen stays."""
    mixed = QoSProfile(
        depth=3,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.BEST_AVAILABLE,
    )

    taken = qos.best_available_for_subscription(mixed, [profile()])

    assert str(taken) == "keep_last(3) best_effort volatile"


def test_best_available_is_resolved_so_that_it_fits_every_publisher() -> None:
    """For every mixture of publishers a subscription with BEST_AVAILABLE hears all."""
    limits = [Duration(), Duration(seconds=1)]
    all_kinds = [
        profile(reliability=r, durability=d, liveliness=v, deadline=limit)
        for r, d, v, limit in product(RELIABILITY, DURABILITY, LIVELINESS, limits)
    ]
    for pair in product(all_kinds, repeat=2):
        taken = qos.best_available_for_subscription(BEST, pair)
        assert all(qos.mismatch(each, taken) is None for each in pair)
