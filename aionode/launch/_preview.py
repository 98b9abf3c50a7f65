"""Shows the processes and nodes of a plan, as records and as text, without starting them."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from typing import Any

import yaml

from aionode.launch._evaluation import evaluate
from aionode.launch.plan import (
    Call,
    Component,
    Emit,
    LoadNodes,
    Log,
    Opaque,
    ParameterValues,
    Process,
    Step,
    Timer,
    Watch,
)

__all__ = ["records", "text_of"]


def records(
    steps: list[Step], before: Mapping[str, str], when: tuple[str, ...] = ()
) -> Iterator[dict[str, Any]]:
    """Yield what steps start, in order, following timers and event handlers.

    Functions of event handlers and timers are only named, as they are called when something
    happens.

    Args:
        steps: The steps.
        before: The environment before the launch file was read.
        when: The events and times that lead to the steps.
    """
    for step in steps:
        match step:
            case Process():
                yield of_process(step, before, when)
            case LoadNodes():
                for component in step.components:
                    yield of_component(step, component, when)
            case Timer():
                later = evaluate(step.entities, step.context.fork(ahead=True))
                yield from records(later, before, (*when, f"after {step.period_sec:g} s"))
            case Watch(ends=False):
                yield from of_handler(step, before, when)
            case Call() | Opaque():
                yield {"when": list(when), "calls": step.text}
            case Log():
                yield {"when": list(when), "log": step.text}
            case Emit():
                yield {"when": list(when), "event": step.event.name}
            case _:
                pass


def of_handler(
    step: Watch, before: Mapping[str, str], when: tuple[str, ...]
) -> Iterator[dict[str, Any]]:
    """Yield what an event handler does."""
    condition = f"at the {step.handler.describe()}"
    if step.entities is None:
        yield {"when": [*when, condition], "calls": "a function"}
    else:
        later = evaluate(step.entities, step.context.fork(ahead=True))
        yield from records(later, before, (*when, condition))


def of_process(step: Process, before: Mapping[str, str], when: tuple[str, ...]) -> dict[str, Any]:
    """Return the record of one process."""
    return {
        "when": list(when),
        "name": step.name,
        "argv": [word.content if isinstance(word, ParameterValues) else word for word in step.argv],
        "env": step.changes(before),
        "cwd": step.cwd,
        "where": step.where,
    }


def of_component(step: LoadNodes, component: Component, when: tuple[str, ...]) -> dict[str, Any]:
    """Return the record of a node added to a container."""
    return {
        "when": list(when),
        "container": step.container,
        "plugin": component.plugin,
        "package": component.package,
        "node": component.name or "",
        "namespace": component.namespace or "",
        "remappings": [f"{source}:={target}" for source, target in component.remappings],
        "parameters": component.parameters,
        "where": step.where,
    }


def text_of(record: Mapping[str, Any]) -> str:
    """Format a record as readable lines."""
    prefix = "".join(f"{condition}: " for condition in record["when"])
    if "argv" in record:
        return prefix + "\n".join(process_lines(record))
    if "container" in record:
        return prefix + "\n".join(component_lines(record))
    if "log" in record:
        return f"{prefix}log: {record['log']}"
    if "calls" in record:
        return f"{prefix}{record['calls']}"
    return f"{prefix}event {record['event']}"


def process_lines(record: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of a process: its command, followed by what it gets."""
    words, files = [], []
    for word in record["argv"]:
        if isinstance(word, str):
            words.append(shlex.quote(word))
        else:
            files.append(word)
            words.append(f"<parameters {len(files)}>")
    yield f"{record['name']}: {' '.join(words)}"
    if record["cwd"]:
        yield f"    in {record['cwd']}"
    for name, value in record["env"].items():
        yield f"    {name} is not set" if value is None else f"    {name}={value}"
    for number, content in enumerate(files, start=1):
        yield f"    parameters {number}:"
        text = yaml.safe_dump(content, default_flow_style=False, sort_keys=False)
        yield from (f"        {line}" for line in text.splitlines())


def component_lines(record: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of a node of a container."""
    named = f" as {record['namespace'].rstrip('/')}/{record['node']}" if record["node"] else ""
    yield f"{record['container']} gets {record['plugin']} of {record['package']}{named}"
    for rule in record["remappings"]:
        yield f"    {rule}"
    for name, value in record["parameters"].items():
        yield f"    {name}: {value}"
