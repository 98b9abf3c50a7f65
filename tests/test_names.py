"""Names: validation with rcl's texts, expansion, remapping."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import names
from aionode.errors import (
    AionodeError,
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidRemapRuleError,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NameValidationException,
)
from aionode.names import RemapKind, RemapRule

if TYPE_CHECKING:
    from collections.abc import Callable

NUMBER = "topic name token must not start with a number"
CHARACTERS = (
    "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'"
)
BRACES = "topic name must not have unmatched (unbalanced) curly braces '{}'"
INSIDE = "substitution name must not contain characters other than alphanumerics or '_'"


@pytest.mark.parametrize(
    ("name", "message", "index"),
    [
        ("", "topic name must not be empty string", 0),
        ("/", "topic name must not end with a forward slash", 0),
        ("/foo/", "topic name must not end with a forward slash", 4),
        ("7foo", NUMBER, 0),
        ("foo/7bar", NUMBER, 4),
        ("/7", NUMBER, 1),
        ("foo bar", CHARACTERS, 3),
        ("/foo?", CHARACTERS, 4),
        ("föö", CHARACTERS, 1),
        ("foo/{bar", BRACES, 4),
        ("foo/bar}", BRACES, 7),
        ("foo/~", "topic name must not have tilde '~' unless it is the first character", 4),
        (
            "~foo",
            "topic name must not have a tilde '~' that is not followed by a forward slash '/'",
            1,
        ),
        ("foo/{b/r}", INSIDE, 6),
        ("foo/{{bar}_baz}", INSIDE, 5),
        ("foo/{b-r}", INSIDE, 6),
        ("foo/{4bar}", "substitution name must not start with a number", 5),
    ],
)
def test_an_invalid_name_is_refused_with_rcls_message_and_index(
    name: str, message: str, index: int
) -> None:
    """A web search for the message finds rcl's answer."""
    with pytest.raises(InvalidTopicNameException) as info:
        names.validate_topic_name(name)

    assert (info.value.error_msg, info.value.invalid_index) == (message, index)
    assert info.value.name == name


def test_the_error_points_at_the_place_as_rclpy_prints_it() -> None:
    """The caret stands under the character at fault."""
    with pytest.raises(InvalidServiceNameException) as info:
        names.validate_topic_name("foo/7bar", is_service=True)

    assert str(info.value) == f"Invalid service name: {NUMBER}:\n  'foo/7bar'\n       ^"
    assert isinstance(info.value, NameValidationException | ValueError)


@pytest.mark.parametrize(
    "name",
    ["chatter", "/chatter", "~", "~/a", "{node}/a", "a//b", "__a", "a__b/_c", "{ns}", "a1/b2"],
)
def test_a_valid_name_is_accepted(name: str) -> None:
    """Repeated slashes are found only after expansion; double underscores are valid in rcl."""
    assert names.validate_topic_name(name) is True


@pytest.mark.parametrize(
    ("name", "message", "index"),
    [
        ("", "topic name must not be empty", 0),
        ("foo", "topic name must be absolute, it must lead with a '/'", 0),
        ("/foo/", "topic name must not end with a '/'", 4),
        (
            "/{a}",
            "topic name must not contain characters other than alphanumerics, '_', or '/'",
            1,
        ),
        (
            "/~/a",
            "topic name must not contain characters other than alphanumerics, '_', or '/'",
            1,
        ),
        ("/a//b", "topic name must not contain repeated '/'", 3),
        ("/a/1b", "topic name must not have a token that starts with a number", 3),
        ("/" + "a" * 247, "topic length should not exceed '247'", 246),
    ],
)
def test_a_full_name_obeys_rmws_stricter_rules(name: str, message: str, index: int) -> None:
    """After expansion a name is absolute, plain and at most 247 characters long."""
    with pytest.raises(InvalidTopicNameException) as info:
        names.validate_full_topic_name(name)

    assert (info.value.error_msg, info.value.invalid_index) == (message, index)


@pytest.mark.parametrize(
    ("namespace", "message", "index"),
    [
        ("", "namespace must not be empty", 0),
        ("ns", "namespace must be absolute, it must lead with a '/'", 0),
        ("/ns/", "namespace must not end with a '/', unless only a '/'", 3),
        (
            "/n s",
            "namespace must not contain characters other than alphanumerics, '_', or '/'",
            2,
        ),
        ("/a//b", "namespace must not contain repeated '/'", 3),
        ("/1a", "namespace must not have a token that starts with a number", 1),
        ("/" + "a" * 245, "namespace should not exceed '245'", 244),
    ],
)
def test_an_invalid_namespace_is_refused(namespace: str, message: str, index: int) -> None:
    """A namespace is a full name that leaves room for a token."""
    with pytest.raises(InvalidNamespaceException) as info:
        names.validate_namespace(namespace)

    assert (info.value.error_msg, info.value.invalid_index) == (message, index)


def test_the_longest_names_are_valid() -> None:
    """Limits are inclusive."""
    assert names.validate_full_topic_name("/" + "a" * 246)
    assert names.validate_namespace("/" + "a" * 244)
    assert names.validate_node_name("a" * 255)
    assert names.validate_namespace("/")


@pytest.mark.parametrize(
    ("name", "message", "index"),
    [
        ("", "node name must not be empty", 0),
        ("a/b", "node name must not contain characters other than alphanumerics or '_'", 1),
        ("1a", "node name must not start with a number", 0),
        ("a" * 256, "node name length should not exceed '255'", 254),
    ],
)
def test_an_invalid_node_name_is_refused(name: str, message: str, index: int) -> None:
    """A node's name is one token."""
    with pytest.raises(InvalidNodeNameException) as info:
        names.validate_node_name(name)

    assert (info.value.error_msg, info.value.invalid_index) == (message, index)


@pytest.mark.parametrize(
    ("name", "namespace", "expanded"),
    [
        ("chatter", "/", "/chatter"),
        ("chatter", "/ns", "/ns/chatter"),
        ("/chatter", "/ns", "/chatter"),
        ("~", "/", "/node"),
        ("~", "/ns", "/ns/node"),
        ("~/a", "/ns", "/ns/node/a"),
        ("{node}/a", "/ns", "/ns/node/a"),
        ("/{node}_a", "/ns", "/node_a"),
        ("{ns}/a", "/ns", "/ns/a"),
        ("{namespace}/a", "/ns", "/ns/a"),
        ("~/{node}", "/ns", "/ns/node/node"),
    ],
)
def test_a_name_expands_as_in_rcl(name: str, namespace: str, expanded: str) -> None:
    """Tilde first, then substitutions, then the namespace."""
    assert names.expand(name, "node", namespace) == expanded


def test_an_unknown_substitution_is_an_error_that_shows_it() -> None:
    """A misspelled {nodename} must not become part of a topic."""
    with pytest.raises(
        InvalidTopicNameException, match=r"unknown substitution: \{nodename\}"
    ) as info:
        names.expand("a/{nodename}", "node", "/")

    assert info.value.invalid_index == len("a/")


def test_expanding_checks_node_and_namespace_too() -> None:
    """All three parts make the result."""
    with pytest.raises(InvalidNodeNameException):
        names.expand("a", "1", "/")
    with pytest.raises(InvalidNamespaceException):
        names.expand("a", "node", "ns")


def test_resolving_refuses_what_expansion_made_invalid() -> None:
    """`{ns}` in the root namespace makes two slashes."""
    with pytest.raises(InvalidServiceNameException, match="repeated '/'"):
        names.resolve("{ns}/a", "node", "/", is_service=True)


@pytest.mark.parametrize(
    ("name", "hidden"),
    [("/_a", True), ("/a/_action/status", True), ("_a", True), ("/a_/b", False), ("/a", False)],
)
def test_a_name_is_hidden_when_a_token_starts_with_an_underscore(
    name: str, *, hidden: bool
) -> None:
    """The command line leaves such names out unless asked."""
    assert names.is_hidden(name) is hidden


@pytest.mark.parametrize(
    ("given", "kept"), [(None, "/"), ("", "/"), ("/", "/"), ("ns", "/ns"), ("/a/b", "/a/b")]
)
def test_a_namespace_may_be_given_without_its_slash(given: str | None, kept: str) -> None:
    """As to rclpy's Node."""
    assert names.normalize_namespace(given) == kept


@pytest.mark.parametrize("full_name", ["/node", "/ns/node", "/a/b/node"])
def test_a_full_node_name_splits_and_joins(full_name: str) -> None:
    """Both directions agree."""
    namespace, node_name = names.split_node_name(full_name)

    assert names.fully_qualified_name(namespace, node_name) == full_name


# Remapping


def remapped(name: str, *rules: str, namespace: str = "/ns", is_service: bool = False) -> str:
    """Resolve `name` in node /ns/node under these rules."""
    parsed = [RemapRule.parse(rule) for rule in rules]
    return names.resolve(name, "node", namespace, parsed, is_service=is_service)


@pytest.mark.parametrize(
    ("name", "rule", "result"),
    [
        ("foo", "foo:=bar", "/ns/bar"),
        ("foo", "/ns/foo:=bar", "/ns/bar"),
        ("foo", "/foo:=/bar", "/ns/foo"),
        ("/foo", "/foo:=/bar", "/bar"),
        ("foo", "foo:=/bar", "/bar"),
        ("foo", "foo:=~/bar", "/ns/node/bar"),
        ("~/foo", "~/foo:=bar", "/ns/bar"),
        ("foo", "node:foo:=bar", "/ns/bar"),
        ("foo", "other:foo:=bar", "/ns/foo"),
        ("foo", "rostopic://foo:=bar", "/ns/bar"),
        ("foo", "rosservice://foo:=bar", "/ns/foo"),
        ("foo", "node:rostopic:///ns/foo:=bar", "/ns/bar"),
    ],
)
def test_a_topic_is_remapped_by_the_expanded_form_of_a_rule(
    name: str, rule: str, result: str
) -> None:
    """Both sides of a rule are expanded as the name is."""
    assert remapped(name, rule) == result


def test_a_service_rule_leaves_topics_alone_and_the_other_way_round() -> None:
    """The URL in front of a rule says which of the two it is for."""
    assert remapped("foo", "rosservice://foo:=bar", is_service=True) == "/ns/bar"
    assert remapped("foo", "rostopic://foo:=bar", is_service=True) == "/ns/foo"
    assert remapped("foo", "foo:=bar", is_service=True) == "/ns/bar"


def test_the_first_matching_rule_wins_and_is_the_only_one() -> None:
    """foo:=bar bar:=baz makes bar of foo, not baz."""
    assert remapped("foo", "foo:=bar", "bar:=baz", "foo:=late") == "/ns/bar"


@pytest.mark.parametrize(
    ("name", "rule", "result"),
    [
        ("/foo/bar", "/foo/*:=/new/\\1", "/new/bar"),
        ("/foo/bar/baz", "/foo/*:=/new/\\1", "/foo/bar/baz"),
        ("/foo", "/foo/*:=/new/\\1", "/foo"),
        ("/foo/bar/baz", "/foo/**:=/fizz/\\1", "/fizz/bar/baz"),
        ("/foo/bar", "/foo/**:=/fizz/\\1", "/fizz/bar"),
        ("/foo", "/foo/**:=/fizz/\\1", "/foo"),
        ("/foo", "**/foo:=\\1/bar", "/bar"),
        ("/buz/foo", "**/foo:=\\1/bar", "/buz/bar"),
        ("/biz/buz/foo", "**/foo:=\\1/bar", "/biz/buz/bar"),
        ("/foo/bar", "**/bar:=/bar/\\1", "/bar/foo"),
        ("/bar", "**/bar:=/bar/\\1", "/bar"),
        ("/bar/foo", "/bar/*:=\\1/bar", "/ns/foo/bar"),
        ("/a/x/b/y", "/a/*/b/*:=/\\2/\\1", "/y/x"),
        ("/a/corp/b", "**/corp/**:=\\1/base/\\2", "/a/base/b"),
        ("sub/foo", "sub/*:=\\1", "/ns/foo"),
        ("~/foo", "~/*:=/private/\\1", "/private/foo"),
        ("/a/fib/_action/status", "/a/fib/**:=/b/\\1", "/b/_action/status"),
    ],
)
def test_wildcards_match_whole_tokens_and_are_given_back(name: str, rule: str, result: str) -> None:
    """The examples of ROS's design article on remapping, which rcl never implemented."""
    assert remapped(name, rule) == result


def test_node_name_and_namespace_take_the_first_rule_that_applies() -> None:
    """Later rules of the same kind are ignored, not chained."""
    rules = [
        RemapRule.parse(text)
        for text in ("other:__node:=no", "__name:=new", "__node:=newer", "__ns:=/foo", "__ns:=/bar")
    ]

    assert names.remap_node_name(rules, "node") == "new"
    assert names.remap_namespace(rules, "new", "/") == "/foo"
    assert names.remap_node_name([], "node") == "node"
    assert names.remap_namespace([], "node", "/ns") == "/ns"


def test_special_rules_leave_topics_alone() -> None:
    """`__ns:=/foo` changes the node's namespace, not a topic that is called __ns."""
    assert remapped("__ns", "__ns:=/foo") == "/ns/__ns"


@pytest.mark.parametrize(
    ("rule", "says"),
    [
        ("foo", "no ':='"),
        ("", "no ':='"),
        (":=bar", "'' cannot be matched"),
        ("foo:=", "'' is not a name"),
        ("foo:=/bar/", "'/bar/' is not a name"),
        ("fo o:=bar", "'fo o' cannot be matched"),
        ("*foo:=bar", "'*foo' cannot be matched"),
        ("~foo:=bar", "'~foo' cannot be matched"),
        ("foo:=*", "'*' is not a name"),
        ("foo:=\\1", "'\\1' stands for wildcard 1, but 'foo' has 0"),
        ("*/foo:=\\2", "'\\2' stands for wildcard 2"),
        ("__node:=a/b", "'a/b' cannot be a node name"),
        ("__ns:=foo", "'foo' cannot be a namespace: namespace must be absolute"),
        ("__ns:=/foo/", "must not end with a '/'"),
        ("a:b:c:=d", "'b:c' cannot be matched"),
    ],
)
def test_a_rule_that_cannot_be_read_says_which_part(rule: str, says: str) -> None:
    """The error shows the side at fault and what fits."""
    with pytest.raises(InvalidRemapRuleError, match=re.escape(says)) as info:
        RemapRule.parse(rule)

    assert info.value.rule == rule


@pytest.mark.parametrize(
    "text",
    ["foo:=bar", "node:rostopic:///a/*:=/b/\\1", "rosservice://~/a:=b", "n:__node:=m", "__ns:=/"],
)
def test_a_rule_prints_as_it_is_written(text: str) -> None:
    """str() and parse() are inverse."""
    assert str(RemapRule.parse(text)) == text


def test_a_rule_is_a_value() -> None:
    """It can be compared, hashed and made without text."""
    made = RemapRule(RemapKind.TOPIC, "foo", "bar", "node")

    assert made == RemapRule.parse("node:rostopic://foo:=bar")
    assert len({made, RemapRule.parse("node:rostopic://foo:=bar")}) == 1


# Laws

words = st.text("ab1_/~{}*\\:= ü", max_size=12)


@given(words)
def test_any_text_is_a_valid_name_or_a_name_error(text: str) -> None:
    """Nothing but the documented errors, and a valid index in each."""
    for check in (
        names.validate_topic_name,
        names.validate_full_topic_name,
        names.validate_namespace,
        names.validate_node_name,
    ):
        try:
            check(text)
        except NameValidationException as error:
            index = error.invalid_index
        else:
            index = 0
        assert 0 <= index <= len(text)


@given(words, words)
def test_any_rule_and_name_give_a_valid_name_or_a_documented_error(rule: str, name: str) -> None:
    """Whatever resolve returns is a valid full name."""
    try:
        result = names.resolve(name, "node", "/ns", [RemapRule.parse(rule)])
    except AionodeError:
        return
    assert names.validate_full_topic_name(result)


tokens = st.from_regex("[a-z][a-z0-9_]{0,3}", fullmatch=True)


@given(st.lists(tokens, min_size=1, max_size=4), tokens)
def test_a_double_wildcard_moves_a_whole_tree(parts: list[str], root: str) -> None:
    r"""`/old/**:=/new/\\1` keeps everything below the root."""
    rule = RemapRule.parse(f"/{root}/**:=/moved/\\1")
    below = "/".join(parts)

    assert names.remap([rule], f"/{root}/{below}", "node", "/") == f"/moved/{below}"


@pytest.mark.parametrize(
    ("check", "what"),
    [
        (names.validate_topic_name, "topic name"),
        (lambda name: names.validate_topic_name(name, is_service=True), "service name"),
        (names.validate_node_name, "node name"),
        (names.validate_namespace, "namespace"),
        (names.normalize_namespace, "namespace"),
    ],
)
def test_a_name_that_is_no_text_is_a_type_error(check: Callable[[Any], object], what: str) -> None:
    """The message says which name it is, not what str cannot do."""
    with pytest.raises(TypeError, match=rf"^{what}: got 5 \(int\); a str is needed$"):
        check(5)
