"""The reports of a node's endpoints, timers and actions for tools."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, Final

from aionode.endpoints.core.callback_runner import callback_name
from aionode.engine.observation import DurationReport, EntityReport
from aionode.graph import is_infrastructure

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["entity_reports"]

KINDS: Final = {
    "Publisher": "publisher",
    "Subscription": "subscription",
    "Service": "service",
    "Client": "client",
    "Timer": "timer",
    "ActionServer": "action server",
}
"""What entities with stats are called, by the names of their classes, which import this package."""

COUNTS: Final = (
    "published",
    "calls",
    "received",
    "dropped",
    "expired",
    "filtered",
    "lost",
    "errors",
)
DURATIONS: Final = ("queue_wait", "run_time", "blocking")


def entity_reports(entities: Iterable[Any]) -> list[EntityReport]:
    """Return the counts of what the author of a node has written, without infrastructure."""
    reports = (entity_report(entity) for entity in list(entities))
    return [report for report in reports if report is not None]


@cache
def kind_of(cls: Any) -> str | None:
    """Return the kind of the entities of a class, as text; None for those without stats."""
    return next((KINDS[base.__name__] for base in cls.__mro__ if base.__name__ in KINDS), None)


@cache
def named_in(cls: Any, names: tuple[str, ...]) -> tuple[str, ...]:
    """Return those of the given names that the stats of a class have."""
    have = {*dir(cls), *(name for base in cls.__mro__ for name in getattr(base, "__slots__", ()))}
    return tuple(name for name in names if name in have)


def entity_report(entity: Any) -> EntityReport | None:
    """Return the counts of an entity; None for infrastructure, and for what counts nothing."""
    cls: Any = type(entity)
    kind = kind_of(cls)
    if kind is None:
        return None
    name = type_name = ""
    if hasattr(entity, "_endpoint"):
        if is_infrastructure(entity._endpoint):
            return None
        name, type_name = entity._endpoint.name, entity._endpoint.type_name
    elif hasattr(entity, "action_type"):
        name, type_name = entity.action_name, entity.action_type.__ros_type__
    runner = getattr(entity, "_runner", None) or getattr(entity, "_execute", None)
    stats: Any = entity.stats
    counted: Any = type(stats)
    return EntityReport(
        kind,
        name,
        type_name,
        "" if runner is None else callback_name(runner.callback),
        {count: getattr(stats, count) for count in named_in(counted, COUNTS)},
        {
            duration: DurationReport(
                (measured := getattr(stats, duration)).buckets, measured.max_ns
            )
            for duration in named_in(counted, DURATIONS)
        },
    )
