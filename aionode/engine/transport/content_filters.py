"""The content filters that subscriptions of other contexts have announced, for their publishers.

A subscription announces its filter beside itself, and publishers leave out what no subscription
wants. Nothing depends on it: a publisher that does not know a filter sends everything, and each
subscription applies its own filter to what arrives.

A filter counts for a subscription only if its token names that one's context and topic as well, so
that rules for the topic bind it, and no other context's filters come into it.
"""

from __future__ import annotations

import asyncio
import base64
import json
import re
from collections import Counter
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from aionode.content_filter import ContentFilterOptions, compile_filter
from aionode.engine.wire._key_expression import demangle, mangle
from aionode.errors import ContentFilterError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from collections.abc import Set as AbstractSet

__all__ = ["ContentFilters", "filter_from_text", "filter_token", "text_of_filter"]

GID: Final = re.compile("[0-9a-f]{32}")

MAX_SIZE: Final = 4096
"""Longer filters, as text, are not announced, nor taken from others."""

KIND: Final = "filter/2/"
"""The part of a filter's token after the participant: a word, and the version of its form."""

CHUNKS: Final = 3
"""Number of chunks after that: topic as in tokens of ROS, gid of the subscription, filter."""

MAX_FILTERS: Final = 2_000
"""Number of announced filters at most, of all other contexts: 8 MB of text."""

MAX_FILTERS_PER_CONTEXT: Final = 1_000
"""Number of filters of one context at most: it must not take the place of all others."""

MAX_FILTERS_PER_READER: Final = 4
"""Number of filters of one subscription at most; it has two while it changes its filter."""

MAX_APPLIED: Final = 100
"""Number of filters that one publisher applies; with more, every subscription gets everything."""

WORK_PER_MESSAGE: Final = 200_000
"""Work of others' filters for one message at most, in units of about a nanosecond."""

MESSAGES_UNFILTERED: Final = 100
"""Number of messages that go to everyone after one whose filters cost too much."""


def text_of_filter(content_filter: ContentFilterOptions) -> str:
    """Return a filter as text of letters, digits, ``-`` and ``_``; empty if it is not announced."""
    plain = [content_filter.filter_expression, list(content_filter.expression_parameters)]
    text = base64.urlsafe_b64encode(json.dumps(plain).encode()).decode().rstrip("=")
    return text if content_filter.filter_expression and len(text) <= MAX_SIZE else ""


def filter_token(domain_id: int, participant: str, topic: str, gid: bytes, text: str) -> str:
    """Return the liveliness token that announces the filter of a subscription."""
    return f"@aionode/{domain_id}/{participant}/{KIND}{mangle(topic)}/{gid.hex()}/{text}"


def filter_from_text(text: str) -> ContentFilterOptions | None:
    """Return the filter that `text_of_filter` wrote; None if it is malformed."""
    if len(text) > MAX_SIZE:
        return None
    try:
        plain = json.loads(base64.urlsafe_b64decode(text + "=" * (-len(text) % 4)))
    except (ValueError, RecursionError):
        return None
    match plain:
        case [str(expression), list(parameters)] if all(isinstance(p, str) for p in parameters):
            return ContentFilterOptions(expression, parameters)
    return None


class OverBudgetError(Exception):
    """The filters cost more than a message allows."""


class Budget:
    """The work that filters of others may cost for the present message."""

    def __init__(self) -> None:
        self._left = 0

    def begin(self) -> None:
        """Begin with a new message."""
        self._left = WORK_PER_MESSAGE

    def spend(self, work: int) -> None:
        """Take the work for one comparison.

        Raises:
            OverBudgetError: there is not so much left.
        """
        self._left -= work
        if self._left < 0:
            raise OverBudgetError


class AnnouncedFilter:
    """A filter of one subscription of another context, compiled once for each type."""

    def __init__(self, options: ContentFilterOptions, budget: Budget) -> None:
        self._options = options
        self._budget = budget
        self._compiled: dict[type[Any], Callable[[Any], bool] | None] = {}

    def predicate(self, msg_type: type[Any]) -> Callable[[Any], bool] | None:
        """Return whether a message passes; None if the filter does not fit the type."""
        if msg_type not in self._compiled:
            options = self._options
            try:
                compiled = compile_filter(
                    msg_type,
                    options.filter_expression,
                    options.expression_parameters,
                    spend=self._budget.spend,
                )
            except ContentFilterError:
                self._compiled[msg_type] = None
            else:
                self._compiled[msg_type] = compiled
        return self._compiled[msg_type]


class Subscriber(NamedTuple):
    """Whose filter a token announces."""

    participant: str
    topic: str
    gid: bytes


class ContentFilters:
    """The announced filters of subscriptions.

    While a subscription changes its filter, both are known, and what either wants is sent. A filter
    of another process may cost this one little: a publisher that would do too much work for them
    sends everything.

    Attributes:
        changes: Incremented whenever a filter is added or removed.
        on_change: Called soon after that with the topics, once for many changes: others decide how
            many there are.
    """

    def __init__(self) -> None:
        self.changes = 0
        self.on_change: list[Callable[[AbstractSet[str]], None]] = []
        self._changed_topics: set[str] = set()
        self._by_subscriber: dict[Subscriber, dict[str, AnnouncedFilter]] = {}
        self._counts: Counter[str] = Counter()  # of all filters, by context
        # Subscriptions that announced more than a subscription may have: they get everything.
        self._excessive: set[Subscriber] = set()
        self._budget = Budget()

    def __bool__(self) -> bool:
        return bool(self._by_subscriber)

    def take_token(self, participant: str, what: str, *, present: bool) -> None:
        """Add or remove what a token announces; others than those of filters are ignored.

        Args:
            participant: The context of which the token says that it is its own.
            what: The token without the participant and what is before it.
            present: Whether the token was declared, and not undeclared.
        """
        chunks = what.removeprefix(KIND).split("/")
        if not what.startswith(KIND) or len(chunks) != CHUNKS or not GID.fullmatch(chunks[1]):
            return
        topic, gid_text, text = chunks
        subscriber = Subscriber(participant, demangle(topic), bytes.fromhex(gid_text))
        known = self._by_subscriber.get(subscriber, {})
        if present:
            if not self._add(subscriber, known, text):
                return
        elif text in known:
            del known[text]
            self._counts[participant] -= 1
            if not known:
                del self._by_subscriber[subscriber]
        else:
            return
        self._changed({subscriber.topic})

    def _add(self, subscriber: Subscriber, known: dict[str, AnnouncedFilter], text: str) -> bool:
        """Take a well-formed filter, unless there are too many; return whether it counts."""
        options = filter_from_text(text)
        if options is None or text in known:
            return False
        participant = subscriber.participant
        if (
            len(known) >= MAX_FILTERS_PER_READER
            or self._counts[participant] >= MAX_FILTERS_PER_CONTEXT
            or self._counts.total() >= MAX_FILTERS
        ):
            if subscriber in self._excessive:
                return False
            if len(self._excessive) < MAX_FILTERS:
                self._excessive.add(subscriber)
                return True
            # Nor is there room to note that: then none of its filters may count.
            self._counts[participant] -= len(known)
            return self._by_subscriber.pop(subscriber, None) is not None
        known[text] = AnnouncedFilter(options, self._budget)
        self._by_subscriber[subscriber] = known
        self._counts[participant] += 1
        return True

    def clear(self) -> None:
        """Forget all filters: the session has ended."""
        if self._by_subscriber:
            topics = {subscriber.topic for subscriber in self._by_subscriber}
            self._by_subscriber.clear()
            self._counts.clear()
            self._excessive.clear()
            self._changed(topics)

    def _changed(self, topics: AbstractSet[str]) -> None:
        self.changes += 1
        if self.on_change and not self._changed_topics:
            asyncio.get_running_loop().call_soon(self._tell)
        self._changed_topics |= topics

    def _tell(self) -> None:
        topics, self._changed_topics = self._changed_topics, set()
        for listener in self.on_change:
            listener(topics)

    def wanted_by(
        self, topic: str, readers: Mapping[bytes, str], msg_type: type[Any]
    ) -> Callable[[Any], bool] | None:
        """Return whether a message is wanted by any of some subscriptions.

        None if one of them wants all messages, if there are none, or if a filter does not fit the
        type: then everything is sent.

        Args:
            topic: The topic.
            readers: The subscriptions, by gid, each with its context.
            msg_type: The type of the messages.
        """
        predicates: list[Callable[[Any], bool]] = []
        for gid, participant in readers.items():
            subscriber = Subscriber(participant, topic, gid)
            announced = self._by_subscriber.get(subscriber)
            if not announced or subscriber in self._excessive:
                return None
            for announcement in announced.values():
                predicate = announcement.predicate(msg_type)
                if predicate is None or len(predicates) >= MAX_APPLIED:
                    return None
                predicates.append(predicate)
        return any_of(predicates, self._budget) if predicates else None


def any_of(predicates: list[Callable[[Any], bool]], budget: Budget) -> Callable[[Any], bool]:
    """Return whether any of these predicates is true of a message, which may be invalid.

    A message whose predicates cost more than the budget is wanted, and so are those after it for a
    while: the subscriptions filter for themselves.
    """
    unfiltered = 0

    def wants(msg: Any) -> bool:
        nonlocal unfiltered
        if unfiltered:
            unfiltered -= 1
            return True
        budget.begin()
        try:
            return any(predicate(msg) for predicate in predicates)
        except OverBudgetError:
            unfiltered = MESSAGES_UNFILTERED
            return True
        except (TypeError, ValueError, AttributeError, LookupError):
            return True  # a value that does not fit its field: the encoder says which one

    return wants
