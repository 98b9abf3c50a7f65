"""The report of an episode: how its messages were used, as numbers and as text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from aionode.errors import escaped
from aionode.learn._alignment import pictures_per_row
from aionode.learn._metadata import OUTCOME_KEY
from aionode.learn._scan import full_name
from aionode.learn._series import OTHER_CLOCK

if TYPE_CHECKING:
    from aionode.bag import Bag
    from aionode.learn._alignment import Aligned
    from aionode.learn._entries import Array
    from aionode.learn._series import Series
    from aionode.learn.contract import Action, Contract, Observation

__all__ = [
    "Limits",
    "counted",
    "lags",
    "over",
    "report_of",
    "text_of",
    "topic_of",
    "topic_text",
    "trouble_of",
]

CLEAR: Final = 0.8
"""The correlation from which a lag is certain enough to be reported."""


@dataclass(frozen=True, slots=True)
class Limits:
    """The limits beyond which an export counts as bad.

    Attributes:
        dropped: Maximum share of rows missing between the first and the last one because
            something was too old or an image was lost.
        repeated: Maximum share of rows that repeat an image, for each camera.
        rate: Maximum deviation of the rate of the rows from the contract's, as a share.
    """

    dropped: float = 0.05
    repeated: float = 0.2
    rate: float = 0.05


def report_of(
    opened: Bag,
    contract: Contract,
    series: list[Series],
    rows: Aligned,
    problems: list[str],
) -> dict[str, Any]:
    """Return the numbers of a report."""
    kept = len(rows.times) if rows.starts else 0
    steps = np.diff(rows.times)
    inside = np.delete(steps, [start - 1 for start in rows.starts if start])
    lost = {name: sum(each) for name, each in (opened.losses or {}).items()}
    topics = [
        topic_of(contract, entry, each, rows, position)
        | {
            "lost": lost.get(full_name(entry.topic), 0),
            "gone": opened.missing.get(full_name(entry.topic), 0),
        }
        for position, (entry, each) in enumerate(zip(contract.entries, series, strict=True))
    ]
    main = topics[contract.entries.index(contract.main)]
    return {
        "path": str(opened.path),
        "episodes": len(rows.starts),
        "rows": kept,
        "references": rows.references,
        "missing": missing(rows, inside) if kept else 0,
        "rate_hz": 1e9 / float(inside.mean()) if len(inside) else main["rate_hz"],
        "gaps_sec": rows.gaps,
        "topics": topics,
        "lag_sec": lags(contract, rows) if kept else {},
        "outcome": opened.custom_data.get(OUTCOME_KEY, ""),
        "problems": problems,
    }


def missing(rows: Aligned, steps: Array) -> int:
    """Return how many rows are missing between the first and the last one."""
    if not len(steps):
        return 0
    expected = (rows.times[-1] - rows.times[0]) / np.median(steps) + 1
    return max(round(float(expected)) - len(rows.times), 0)


def topic_of(
    contract: Contract, entry: Observation | Action, series: Series, rows: Aligned, position: int
) -> dict[str, Any]:
    """Return the numbers of one entry of the contract."""
    steps = np.diff(series.times) / 1e9
    offsets = series.offsets
    chosen = rows.chosen[position]
    used = len(np.unique(chosen))
    return {
        "topic": entry.topic,
        "feature": entry.feature,
        "is_image": bool(getattr(entry, "image", None)),
        "is_main": entry is contract.main,
        "messages": len(series.times),
        "rate_hz": float(1 / np.median(steps)) if len(steps) and np.median(steps) > 0 else 0.0,
        "offset_sec": spread(offsets) if series.is_captured else None,
        "ahead": int((offsets < -contract.max_age(entry)).sum()),
        "ahead_sec": float(max(-offsets.min(initial=0), 0)),
        "age_sec": spread(rows.ages[position]),
        "max_age_sec": contract.max_age(entry),
        "stale": rows.stale[position],
        "repeated": len(chosen) - used,
        "unused": int(chosen[-1] - chosen[0] + 1 - used) if len(chosen) else 0,
        "backwards": series.backwards,
        "unstamped": series.unstamped,
        "invalid": series.invalid,
        "problem": series.problem,
    }


def spread(values: Array) -> dict[str, float] | None:
    """Return the median, the 95th percentile and the maximum; None if there are no values."""
    if not len(values):
        return None
    p50, p95 = np.percentile(values, (50, 95))
    return {"p50": float(p50), "p95": float(p95), "max": float(values.max())}


def lags(contract: Contract, rows: Aligned) -> dict[str, float]:
    """Return how long each observation takes to follow its action, where that is clear, by name."""
    numbers = [each for each in contract.features.values() if each.kind == "numbers"]
    entries = contract.entries
    columns: tuple[dict[str, Array], dict[str, Array]] = ({}, {})
    for feature in numbers:
        for entry in feature.entries:
            position = entries.index(entry)
            is_action = position >= len(contract.observations)
            for label, column in zip(entry.labels, rows.values[position].T, strict=True):
                columns[is_action].setdefault(label, column)
    observed, commanded = columns
    span = slice(*longest_of(rows))
    found = {
        label: lag_of(commanded[label][span], observed[label][span], contract.fps)
        for label in commanded
        if label in observed
    }
    return {label: lag for label, lag in found.items() if lag is not None}


def longest_of(rows: Aligned) -> tuple[int, int]:
    """Return the first row of the longest episode, and the row after its last one."""
    return max(zip(rows.starts, rows.ends, strict=True), key=lambda each: each[1] - each[0])


def lag_of(commanded: Array, observed: Array, fps: int) -> float | None:
    """Return the seconds by which an observation follows its command; None if unclear.

    A command may set the observed value itself, or its derivative: a speed for a position.
    """
    best: tuple[float, float | None] = (CLEAR, None)
    for followed in (observed[:-1], np.diff(observed)):
        for rows in range(1, min(fps, len(followed) // 3) + 1):
            first, second = commanded[: len(followed) - rows], followed[rows:]
            if first.std() > 1e-6 and second.std() > 1e-9:
                likeness = float(np.corrcoef(first, second)[0, 1])
                best = max(best, (likeness, (rows - 1) / fps), key=lambda each: each[0])
    return best[1]


# As text


def over(report: dict[str, Any], limits: Limits, fps: int) -> list[str]:
    """Return what exceeds the limits."""
    found = [*report["problems"]]
    dropped = share(report["missing"], report["missing"] + report["rows"])
    is_short = not report["rows"] or dropped > limits.dropped
    if not report["rows"]:
        found.append("no rows")
    elif is_short:
        found.append(
            f"{dropped:.1%} of the rows between the first and the last are missing; "
            f"at most {limits.dropped:.1%} may be"
        )
    if report["rows"] > 1 and abs(report["rate_hz"] / fps - 1) > limits.rate:
        found.append(
            f"rows at {report['rate_hz']:.2f} Hz, and fps is {fps}: they would be played too "
            f"{'slowly' if report['rate_hz'] > fps else 'fast'}; set fps to the camera's rate"
        )
    for topic in report["topics"]:
        repeated = share(topic["repeated"], report["rows"])
        if topic["is_image"] and repeated > limits.repeated:
            found.append(f"{topic['topic']}: {repeated:.1%} of the rows repeat a picture")
        found += [
            f"{topic['topic']}: {counted(topic[kind], 'message')} {words}"
            for kind, words in (
                ("invalid", f"not as in the contract: {topic['problem']}"),
                ("backwards", "with a time out of order, left out"),
                ("lost", "lost by the recorder"),
                ("gone", "recorded, but no longer in the bag: its file is truncated or missing"),
            )
            if topic[kind]
        ]
        if is_short and topic["messages"] and topic["stale"] > limits.dropped * report["rows"]:
            found.append(stale_text(topic))
        found += stamp_problems(topic)
    return found


def stamp_problems(topic: dict[str, Any]) -> list[str]:
    """Return what is wrong with the header times of a topic, with what to do."""
    name, found = topic["topic"], []
    offset = topic["offset_sec"]
    if topic["unstamped"]:
        remedy = (
            "their times of arrival are used, as with stamp: receive"
            if offset is None
            else "they are left out"
        )
        found.append(
            f"{name}: {counted(topic['unstamped'], 'message')} without a time in the header; "
            f"{remedy}"
        )
    if offset is not None and abs(offset["p50"]) > OTHER_CLOCK:
        found.append(
            f"{name}: stamped {shifted(offset['p50'])}, by another clock; use stamp: receive"
        )
    elif topic["ahead"]:
        found.append(
            f"{name}: {counted(topic['ahead'], 'message')} stamped up to "
            f"{shifted(-topic['ahead_sec'])}, by a clock that is ahead; use stamp: receive"
        )
    return found


def shifted(sec: float) -> str:
    """Return how long before or after its arrival a message was stamped, as text."""
    amount = f"{abs(sec):.1f} s" if abs(sec) > OTHER_CLOCK else f"{abs(sec) * 1e3:.1f} ms"
    return f"{amount} {'before' if sec >= 0 else 'after'} arrival"


def counted(count: int, what: str) -> str:
    """Return a number with its noun."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def trouble_of(
    contract: Contract, entry: Observation | Action, topic: dict[str, Any], rows: int
) -> list[str]:
    """Return what is wrong with a topic of a running robot, with what to do.

    Args:
        contract: The contract.
        entry: Its entry.
        topic: The numbers of `topic_of`.
        rows: How many rows there could have been.
    """
    name = entry.topic
    found = []
    if topic["invalid"]:
        found.append(f"{name}: {counted(topic['invalid'], 'message')}: {topic['problem']}")
    if topic["backwards"]:
        found.append(f"{name}: times that go back; do two nodes publish it?")
    found += stamp_problems(topic)
    if topic["is_main"]:
        every = pictures_per_row(topic["rate_hz"], contract.fps)
        if topic["rate_hz"] and abs(topic["rate_hz"] / every / contract.fps - 1) > Limits().rate:
            found.append(
                f"{name}: {topic['rate_hz']:.1f} Hz, and fps is {contract.fps}; set the camera's "
                "rate, or fps"
            )
    elif topic["messages"] and topic["stale"] > Limits().dropped * rows:
        found.append(stale_text(topic | {"topic": name}))
    return found


def stale_text(topic: dict[str, Any]) -> str:
    """Return the text for a topic that is too old for rows, with what to do."""
    return (
        f"{topic['topic']}: too old for {counted(topic['stale'], 'row')}: max_age is "
        f"{topic['max_age_sec'] * 1e3:.0f} ms, and it has {topic['rate_hz']:.1f} Hz; raise its "
        "rate or max_age"
    )


def share(part: float, whole: float) -> float:
    """Return a part as a share of a whole; 0 if the whole is 0."""
    return part / whole if whole else 0.0


def text_of(report: dict[str, Any], limits: Limits, fps: int) -> str:
    """Return the report of one bag as text."""
    length = report["rows"] / fps
    outcome = f"; {report['outcome']}" if report["outcome"] else ""
    head = (
        f"{report['path']}: {report['rows']} of {report['references']} rows, {length:.1f} s, in "
        f"{counted(report['episodes'], 'episode')}{outcome}"
    )
    lines = [head]
    lines += [f"  {topic_text(topic, report['rows'])}" for topic in report["topics"]]
    if report["removed_bytes"]:
        lines.append(f"  repaired: {counted(report['removed_bytes'], 'byte')} could not be saved")
    if report["gaps_sec"]:
        gaps = counted(len(report["gaps_sec"]), "gap")
        lines.append(f"  {gaps}, the longest of {max(report['gaps_sec']):.3f} s")
    if report["lag_sec"]:
        named = ", ".join(f"{name} {lag * 1e3:.0f} ms" for name, lag in report["lag_sec"].items())
        lines.append(f"  observed after its command: {named}")
    lines += [f"  ! {problem}" for problem in over(report, limits, fps)]
    return "\n".join(escaped(line, one_line=True) for line in lines)


def topic_text(topic: dict[str, Any], rows: int) -> str:
    """Return one line about a topic."""
    if not topic["messages"]:
        there = f"{counted(topic['invalid'], 'message')}, none of them as in the contract"
        return (
            f"{topic['topic']} ({topic['feature']}): {there if topic['invalid'] else 'no messages'}"
        )
    parts = [f"{counted(topic['messages'], 'message')} at {topic['rate_hz']:.1f} Hz"]
    if topic["is_main"]:
        parts.append("each makes a row")
    elif topic["age_sec"]:
        age = topic["age_sec"]
        parts.append(
            f"age p50 {age['p50'] * 1e3:.1f}, p95 {age['p95'] * 1e3:.1f}, "
            f"max {age['max'] * 1e3:.1f} ms"
        )
    if topic["offset_sec"]:
        offset = topic["offset_sec"]
        parts.append(
            f"stamped {offset['p50'] * 1e3:.1f} ms before arrival (p95 {offset['p95'] * 1e3:.1f})"
        )
    if topic["stale"]:
        parts.append(f"too old for {counted(topic['stale'], 'row')}")
    if topic["is_image"] and not topic["is_main"]:
        parts.append(f"{topic['repeated']} of {rows} repeated, {topic['unused']} unused")
    return f"{topic['topic']} ({topic['feature']}): {'; '.join(parts)}"
