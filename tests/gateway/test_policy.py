"""The policy: which rule decides, which field values are allowed, and which files are refused."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.errors import PolicyFileError, RefusedError
from aionode.gateway import Credentials, FieldLimit, Identity, Policy, Rule, Verb
from aionode.interfaces.geometry_msgs.msg import Point, Point32, Polygon, Twist, Vector3
from aionode.interfaces.std_msgs.msg import Float32MultiArray, String

OPERATOR = Identity("operator", frozenset({"drivers"}))
GUEST = Identity("guest")
SECRET = "secret"
VERBS: tuple[Verb, ...] = (
    "see",
    "subscribe",
    "publish",
    "call",
    "goal",
    "parameter",
    "advertise",
)
NAMES = st.from_regex(r"(/[a-z]{1,3}){1,3}", fullmatch=True)
NUMBERS = st.floats(allow_nan=True, allow_infinity=True)

EXAMPLE = """
hosts = ["robot.local"]
origins = ["https://dash.example"]

[[who]]
name = "operator"
groups = ["drivers"]
token = "secret"

[[who]]
name = "guest"
loopback = true

[[refuse]]
see = "/private/**"
because = "it is private"

[[allow]]
subscribe = ["/scan", "/camera/*/image"]

[[allow]]
who = "drivers"
publish = "/cmd_vel"
type = "geometry_msgs/msg/Twist"
rate_hz = 30
fields = { "linear.x" = { min = -0.5, max = 0.5 }, "angular.z" = { max = 1, outside = "clamp" } }
lease = { ttl_sec = 0.2, priority = 5 }

[[allow]]
who = "operator"
parameter = "/camera:exposure"
fields = { value = { min = 0.0, max = 1.0 } }

[limits]
clients = 5
"""


def credentials(**given: object) -> Credentials:
    """Return the credentials of a program on this host."""
    shown: dict[str, object] = {"address": "127.0.0.1", "host": "localhost:9090"}
    return Credentials(**(shown | given))  # type: ignore[arg-type]  # as given


@pytest.fixture
def policy() -> Policy:
    """The policy of the example."""
    return Policy.parse(EXAMPLE)


@given(verb=st.sampled_from(VERBS), name=NAMES)
def test_what_no_rule_allows_is_refused(verb: Verb, name: str) -> None:
    """A policy that omits something must not allow it."""
    assert not Policy().decide(OPERATOR, verb, name, "").allowed


@given(verb=st.sampled_from(VERBS), name=NAMES, other=NAMES)
def test_a_rule_allows_its_verb_and_its_name_only(verb: Verb, name: str, other: str) -> None:
    """Each verb is allowed by its own rule, which also lets the client see the name."""
    policy = Policy(allow=[Rule(**{verb: name})])  # type: ignore[arg-type]  # a name each

    for asked in VERBS:
        is_allowed = policy.decide(GUEST, asked, name, "a/msg/B").allowed
        assert is_allowed == (asked in {verb, "see"})
        is_other_allowed = policy.decide(GUEST, asked, other, "a/msg/B").allowed
        assert is_other_allowed == (is_allowed and other == name)


@pytest.mark.parametrize("verb", VERBS)
def test_a_rule_about_topics_shows_no_node(verb: Verb) -> None:
    """A client that reads all topics must not read all parameters, which may contain passwords."""
    policy = Policy(allow=[Rule(**{verb: "/**"})])  # type: ignore[arg-type]  # a name each

    for name in ("/driver", "/driver:password"):
        is_seen = policy.decide(GUEST, "see", name, "").allowed
        assert is_seen == (verb in {"see", "parameter"})


def test_a_rule_for_a_type_shows_no_node() -> None:
    """Nodes and parameters have no type that could match."""
    policy = Policy(allow=[Rule(see="/**", type="sensor_msgs/msg/Image")])

    assert policy.decide(GUEST, "see", "/camera/image", "sensor_msgs/msg/Image").allowed
    assert not policy.decide(GUEST, "see", "/driver:password", "").allowed


@given(verb=st.sampled_from(VERBS), name=NAMES)
def test_a_refusal_has_precedence(verb: Verb, name: str) -> None:
    """A broad allow must not override a refusal."""
    rule = Rule(**{verb: name})  # type: ignore[arg-type]  # a name each
    policy = Policy(allow=[Rule(**dict.fromkeys(VERBS, "/**"))], refuse=[rule])  # type: ignore[arg-type]

    assert not policy.decide(OPERATOR, verb, name, "").allowed


@given(verb=st.sampled_from(VERBS), name=NAMES)
def test_what_may_not_be_seen_may_not_be_used(verb: Verb, name: str) -> None:
    """A name that is hidden from a client is of no use to it."""
    everything = Rule(**dict.fromkeys(VERBS, "/**"))  # type: ignore[arg-type]  # a name each
    policy = Policy(allow=[everything], refuse=[Rule(see=name)])

    assert not policy.decide(OPERATOR, verb, name, "").allowed


@given(verb=st.sampled_from(VERBS), name=NAMES)
def test_a_rule_is_about_those_whom_it_names(verb: Verb, name: str) -> None:
    """By name, or by a group."""
    for who in ("operator", "drivers"):
        policy = Policy(allow=[Rule(who=who, **{verb: name})])  # type: ignore[arg-type]
        assert policy.decide(OPERATOR, verb, name, "").allowed
        assert not policy.decide(GUEST, verb, name, "").allowed


@given(value=NUMBERS, low=st.floats(-5, 0), high=st.floats(0, 5))
def test_what_passes_is_within_its_limits(value: float, low: float, high: float) -> None:
    """Whatever a client sends; a NaN would pass a comparison with either limit."""
    for outside in ("refuse", "clamp"):
        limit = FieldLimit(low, high, outside)
        policy = Policy(allow=[Rule(publish="/cmd_vel", fields={"linear.x": limit})])
        message = Twist(linear=Vector3(x=value))
        decision = policy.decide(GUEST, "publish", "/cmd_vel", "geometry_msgs/msg/Twist", message)

        if low <= value <= high:
            assert decision.message is message
        elif outside == "clamp" and math.isfinite(value):
            assert decision.message.linear.x == min(max(value, low), high)
            assert message.linear.x == value
        else:
            assert (decision.allowed, decision.code) == (False, "out_of_limits")


def test_fields_of_all_messages_in_an_array_are_limited() -> None:
    """A path leads through arrays, as in ``points.x``."""
    limit = {"points.x": FieldLimit(max=1.0, outside="clamp")}
    policy = Policy(allow=[Rule(publish="/area", fields=limit)])
    area = Polygon(points=[Point32(x=0.5), Point32(x=7.0)])
    decision = policy.decide(GUEST, "publish", "/area", "geometry_msgs/msg/Polygon", area)

    assert [point.x for point in decision.message.points] == [0.5, 1.0]


def test_numbers_of_an_array_are_limited() -> None:
    """Each of them, and a NaN among them refuses the message."""
    limit = {"data": FieldLimit(-1.0, 1.0, "clamp")}
    policy = Policy(allow=[Rule(publish="/x", fields=limit)])
    message = Float32MultiArray(data=np.array([0.0, -3.0, 2.0], np.float32))
    name = "std_msgs/msg/Float32MultiArray"

    assert policy.decide(GUEST, "publish", "/x", name, message).message.data.tolist() == [0, -1, 1]
    broken = Float32MultiArray(data=np.array([math.nan], np.float32))
    assert policy.decide(GUEST, "publish", "/x", name, broken).code == "out_of_limits"


def test_a_limit_of_a_field_that_is_not_there_refuses_the_message() -> None:
    """A mistake in a policy must not let everything pass."""
    for path in ("speed", "linear.w", "linear.x.y"):
        policy = Policy(allow=[Rule(publish="/x", fields={path: FieldLimit(max=1.0)})])
        assert not policy.decide(GUEST, "publish", "/x", "", Twist()).allowed
    policy = Policy(allow=[Rule(publish="/x", fields={"data": FieldLimit(max=1.0)})])
    assert not policy.decide(GUEST, "publish", "/x", "", String(data="9")).allowed


def test_an_integer_is_clamped_to_an_integer_within_the_limits() -> None:
    """It cannot have a fractional limit."""
    limit = FieldLimit(0.5, 2.5, "clamp")
    policy = Policy(allow=[Rule(parameter="/n:p", fields={"value": limit})])

    def set_to(value: int) -> object:
        return policy.decide(GUEST, "parameter", "/n:p", "", {"value": value}).message["value"]

    assert (set_to(0), set_to(1), set_to(9)) == (1, 1, 2)


@pytest.mark.parametrize(
    ("glob", "name", "fits"),
    [
        ("/scan", "/scan", True),
        ("/scan", "/scan2", False),
        ("/*", "/scan", True),
        ("/*", "/a/b", False),
        ("/a/**", "/a/b/c", True),
        ("/a/**", "/a", False),
        ("/**", "/a/b", True),
        ("/camera_?/image", "/camera_1/image", True),
        ("/a.b", "/axb", False),
        ("/n", "/n:p", True),
        ("/n:p", "/n:p", True),
        ("/n:p", "/n:q", False),
        ("/n:p", "/n", False),
    ],
)
def test_names_fit_globs(glob: str, name: str, fits: bool) -> None:
    """One star matches part of a name, two stars anything, and a node its parameters."""
    assert Policy(allow=[Rule(see=glob)]).decide(GUEST, "see", name, "").allowed == fits


def test_a_file_says_all_of_a_policy(policy: Policy) -> None:
    """A person reviews the file, and nothing else has an effect."""
    twist = "geometry_msgs/msg/Twist"
    fast = Twist(linear=Vector3(x=0.6))
    turning = Twist(angular=Vector3(z=9.0))

    assert policy.decide(GUEST, "subscribe", "/camera/left/image", "").allowed
    assert policy.decide(GUEST, "subscribe", "/private/scan", "").reason == "it is private"
    assert not policy.decide(GUEST, "publish", "/cmd_vel", twist).allowed
    assert not policy.decide(OPERATOR, "publish", "/cmd_vel", "std_msgs/msg/String").allowed
    assert not policy.decide(OPERATOR, "publish", "/cmd_vel", twist, fast).allowed
    decision = policy.decide(OPERATOR, "publish", "/cmd_vel", twist, turning)
    assert decision.message.angular.z == 1.0
    assert decision.lease is not None
    assert decision.lease.priority == 5
    assert policy.limits.clients == 5


@pytest.mark.parametrize(
    "text",
    [
        "allows = []",
        "[[allow]]\npublsh = '/x'",
        "[[allow]]\npublish = 'cmd_vel'",
        "[[allow]]\nwho = 'nobody'\nsee = '/**'",
        "[[allow]]\nrate_hz = 0",
        "[[refuse]]\npublish = '/x'\nrate_hz = 10",
        "[[allow]]\npublish = '/x'\nlease = { ttl_sec = 0 }",
        "[[who]]\nname = 'anyone'",
        "[[who]]\nname = 'x'\ntoken_sha256 = 'abc'",
        "path = '/etc/x'",
        "no toml",
    ],
)
def test_a_file_with_a_mistake_is_refused(text: str) -> None:
    """A rule without effect would look like protection."""
    with pytest.raises(PolicyFileError):
        Policy.parse(text, "policy.toml")


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    """The error has the path."""
    with pytest.raises(PolicyFileError, match=r"none\.toml"):
        Policy.load(tmp_path / "none.toml")


# Identities of clients


def test_a_token_identifies_a_client(policy: Policy) -> None:
    """From anywhere, even if other entries match without it."""
    for address in ("127.0.0.1", "192.168.0.7"):
        shown = credentials(token=SECRET, address=address, host="192.168.0.1:9090")
        assert policy.identify(shown).name == "operator"


def test_a_token_may_be_in_the_file_as_its_hash() -> None:
    """A widely readable file then contains no secret."""
    digest = "2bb80d537b1da3e38bd30361aa855686bde0eacd7162fef6a25fe97bf527a25b"
    policy = Policy.parse(f"[[who]]\nname = 'x'\ntoken_sha256 = '{digest}'")

    assert policy.identify(credentials(token=SECRET)).name == "x"
    with pytest.raises(RefusedError):
        policy.identify(credentials(token=SECRET.upper()))


@given(token=st.text(min_size=1).filter(lambda text: text != "secret"))
def test_a_wrong_token_is_refused_also_where_none_is_needed(token: str) -> None:
    """Otherwise a mistyped token would make it another client, with other rights."""
    with pytest.raises(RefusedError) as refused:
        Policy.parse(EXAMPLE).identify(credentials(token=token))
    assert refused.value.code == "unauthorized"
    assert token not in str(refused.value) or len(token) < 3


def test_another_machine_needs_a_secret(policy: Policy) -> None:
    """An address, or an origin that any program may claim, proves nothing."""
    by_origin = Policy.parse("[[who]]\nname = 'page'\norigin = 'https://a.example'")
    for each, origin in ((policy, None), (by_origin, "https://a.example")):
        with pytest.raises(RefusedError):
            each.identify(credentials(address="192.168.0.7", origin=origin))
    assert by_origin.identify(credentials(origin="https://a.example")).name == "page"


def test_a_certificate_identifies_a_client() -> None:
    """By its common name, which the server has verified."""
    policy = Policy.parse("[[who]]\nname = 'laptop'\ncertificate = 'laptop-1'")

    assert policy.identify(credentials(certificate="laptop-1", address="10.0.0.2")).name == "laptop"
    with pytest.raises(RefusedError):
        policy.identify(credentials(certificate="laptop-2"))


@pytest.mark.parametrize(
    ("shown", "passes"),
    [
        ({}, True),
        ({"host": "127.0.0.1:9090"}, True),
        ({"host": "[::1]:9090"}, True),
        ({"host": "robot.local:9090"}, True),
        ({"host": "evil.example:9090"}, False),
        ({"host": ""}, False),
        ({"host": "[::1"}, False),
        ({"origin": "http://localhost:9090"}, True),
        ({"origin": "https://localhost:9090"}, False),
        ({"origin": "http://localhost:3000"}, False),
        ({"origin": "http://evil.example"}, False),
        ({"origin": "null"}, False),
        ({"origin": ""}, False),
        ({"origin": "https://dash.example", "sec_fetch_site": "cross-site"}, True),
        ({"host": "evil.example", "origin": "http://evil.example"}, False),
        ({"sec_fetch_site": "same-origin"}, True),
        ({"sec_fetch_site": "none"}, True),
        ({"sec_fetch_site": "cross-site"}, False),
        ({"sec_fetch_site": "same-site"}, False),
    ],
)
def test_pages_of_other_origins_may_not_connect(
    policy: Policy, shown: dict[str, object], passes: bool
) -> None:
    """They may not even do so under their own name, rebound by their name server."""
    if passes:
        assert policy.identify(credentials(**shown)).name == "guest"
    else:
        with pytest.raises(RefusedError):
            policy.identify(credentials(**shown))


def test_without_a_policy_file_this_host_may_read_and_nobody_may_write() -> None:
    """The gateway is safe before anybody has configured it."""
    policy = Policy.default()
    local = policy.identify(credentials())

    assert policy.decide(local, "subscribe", "/scan", "sensor_msgs/msg/LaserScan").allowed
    for verb in ("publish", "call", "goal", "parameter", "advertise"):
        refused = policy.decide(local, verb, "/x", "")
        assert not refused.allowed
        assert "--allow-write" in refused.reason  # what to do
        assert Policy.default(allow_write=True).decide(local, verb, "/x", "").allowed
    with pytest.raises(RefusedError):
        policy.identify(credentials(address="192.168.0.7"))


def test_a_token_is_never_printed() -> None:
    """Errors do not print it, and neither does a debugger's list of variables."""
    assert "secret" not in repr(credentials(token=SECRET))


def test_points_of_a_message_are_left_as_they_are() -> None:
    """A message within its limits is passed on without a copy."""
    policy = Policy(allow=[Rule(publish="/x", fields={"x": FieldLimit(max=1.0)})])
    message = Point(x=0.5)

    assert policy.decide(GUEST, "publish", "/x", "", message).message is message
