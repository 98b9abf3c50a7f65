"""The OpenAPI 3.1 document of the requests that one caller may send.

It has a path for each topic, service, action and node that the policy lets the caller use, with the
schemas of the messages, so that a generated client has a typed method for each of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

from aionode.gateway.session.encoding.image import IMAGE_TYPES
from aionode.message import FieldType, Message, fields, json_schema, type_name

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["Kind", "Offer", "openapi"]

Kind: TypeAlias = Literal["topic", "service", "action", "node"]
"""The kinds of things that a caller may use."""

Schema = dict[str, Any]

SENT: Final = ".sent"
"""Suffix of the schema of a message as clients send it, where that differs."""

LISTS: Final = {
    "topics": "The topics that the caller sees, with their types.",
    "services": "The services that the caller sees, with their types.",
    "actions": "The actions that the caller sees, with their types.",
    "nodes": "The full names of the nodes that the caller sees.",
}

NAMED: Final = {
    "type": "array",
    "items": {
        "type": "object",
        "properties": {
            "name": {"type": "string"},
            "types": {"type": "array", "items": {"type": "string"}},
        },
        "required": ["name", "types"],
    },
}

ERROR: Final = {
    "title": "Error",
    "type": "object",
    "properties": {
        "code": {"type": "string", "description": "The kind of error, as a code for programs."},
        "error": {"type": "string", "description": "The error, as a sentence for people."},
    },
    "required": ["code", "error"],
}

VALUE: Final = {
    "title": "Value of a parameter",
    "anyOf": [
        {"type": ["boolean", "number", "string"]},
        {"type": "array", "items": {"type": ["boolean", "number", "string"]}},
    ],
}

TIMEOUT: Final = {
    "name": "timeout_sec",
    "in": "query",
    "description": "The longest wait, in seconds; by default 5 for a message, and the "
    "gateway's limit for a response.",
    "schema": {"type": "number", "exclusiveMinimum": 0},
}

CLIENT: Final = {
    "name": "client",
    "in": "query",
    "description": "A name chosen by the program, needed if it commands a topic over "
    "several connections.",
    "schema": {"type": "string", "maxLength": 100},
}

PERIOD: Final = {
    "name": "min_period_sec",
    "in": "query",
    "description": "The least time between two messages, in seconds; the newest is sent.",
    "schema": {"type": "number", "minimum": 0, "default": 0.0},
}


WIDTH: Final = {
    "name": "width",
    "in": "query",
    "description": "The largest width of a picture in pixels; the height follows.",
    "schema": {"type": "integer", "minimum": 0, "maximum": 8192, "default": 0},
}

QUALITY: Final = {
    "name": "quality",
    "in": "query",
    "description": "The quality of a JPEG.",
    "schema": {"type": "integer", "minimum": 1, "maximum": 100},
}


@dataclass(frozen=True, slots=True)
class Offer:
    """Something that the caller may use.

    Attributes:
        kind: What it is.
        name: Its full name.
        verbs: The uses that the policy allows the caller, such as ``subscribe`` and ``publish``.
        cls: The class of its type; None if no node describes it, and for a node.
    """

    kind: Kind
    name: str
    verbs: frozenset[str]
    cls: Any = None


def openapi(title: str, version: str, offers: Iterable[Offer]) -> dict[str, Any]:
    """Return the document.

    Args:
        title: The name of the robot or of its gateway.
        version: The version of the program that answers.
        offers: The names that the caller may use.
    """
    schemas: dict[str, Schema] = {"Error": dict(ERROR), "Value": dict(VALUE)}
    paths: dict[str, Schema] = {
        f"/{name}": {"get": operation(f"list/{name}", text, answer(listing(name)))}
        for name, text in LISTS.items()
    }
    for offer in offers:
        operations = {
            "topic": topic_operations,
            "service": service_operations,
            "action": action_operations,
            "node": node_operations,
        }[offer.kind](offer, schemas)
        if operations:
            paths[f"/{'parameters' if offer.kind == 'node' else f'{offer.kind}s'}{offer.name}"] = (
                operations
            )
        if offer.kind == "node" and "parameter" in offer.verbs:
            paths[f"/parameters{offer.name}/{{parameter}}"] = parameter_operations(offer)
    return {
        "openapi": "3.1.0",
        "info": {"title": title, "version": version},
        "servers": [{"url": "/"}],
        "security": [{}, {"token": []}],
        "paths": paths,
        "components": {
            "schemas": schemas,
            "securitySchemes": {"token": {"type": "http", "scheme": "bearer"}},
        },
    }


# Operations


def operation(name: str, summary: str, responses: Schema, **more: Any) -> Schema:
    """Return an operation with its responses, any of which may be an error.

    Args:
        name: The use and the name, such as ``publish/cmd_vel``: unique, as names of methods
            are made of it.
        summary: A description for people.
        responses: The answers to a request that succeeds.
        more: Other entries, such as ``parameters``.
    """
    error = {"description": "An error.", **content("application/json", ref("Error"))}
    return {
        "operationId": name.replace("/", "."),
        "summary": summary,
        **more,
        "responses": {**responses, "default": error},
    }


def content(media_type: str, schema: Schema, **others: Schema) -> Schema:
    """Return the content of a body in one media type."""
    return {"content": {media_type: {"schema": schema}, **others}}


def answer(schema: Schema, **others: Schema) -> Schema:
    """Return the success response of an operation, with a body."""
    return {"200": {"description": "Done.", **content("application/json", schema, **others)}}


def body(schema: Schema) -> Schema:
    """Return the schema of a request body; a message without fields may be omitted."""
    return {"requestBody": {"required": True, **content("application/json", schema)}}


def listing(name: str) -> Schema:
    """Return the schema of a list of names."""
    return {"type": "array", "items": {"type": "string"}} if name == "nodes" else dict(NAMED)


def topic_operations(offer: Offer, schemas: dict[str, Schema]) -> Schema:
    """Return the operations of a topic."""
    message = component(offer.cls, schemas)
    operations: Schema = {}
    if "subscribe" in offer.verbs:
        parameters = [TIMEOUT, PERIOD]
        others: Schema = {"text/event-stream": {"schema": {"type": "string"}}}
        if offer.cls is not None and type_name(offer.cls) in IMAGE_TYPES:
            others |= {"image/jpeg": {}, "image/png": {}, "multipart/x-mixed-replace": {}}
            parameters += [WIDTH, QUALITY]
        text = f"The next message of {offer.name}, or a stream of its messages."
        operations["get"] = operation(
            f"get{offer.name}",
            text,
            answer(message, **others),
            parameters=parameters,
        )
    if "publish" in offer.verbs:
        done = {"204": {"description": "The message is published."}}
        operations["post"] = operation(
            f"publish{offer.name}",
            f"Publish a message on {offer.name}.",
            done,
            parameters=[CLIENT],
            **body(component(offer.cls, schemas, is_sent=True)),
        )
    return operations


def service_operations(offer: Offer, schemas: dict[str, Schema]) -> Schema:
    """Return the operation that calls a service."""
    if "call" not in offer.verbs:
        return {}
    request, response = (
        component(offer.cls and getattr(offer.cls, part), schemas, is_sent=part == "Request")
        for part in ("Request", "Response")
    )
    called = operation(
        f"call{offer.name}",
        f"Call {offer.name}.",
        answer(response),
        parameters=[TIMEOUT],
        **body(request),
    )
    return {"post": called}


def action_operations(offer: Offer, schemas: dict[str, Schema]) -> Schema:
    """Return the operation that sends goals to an action."""
    if "goal" not in offer.verbs:
        return {}
    goal, result, feedback = (
        component(offer.cls and getattr(offer.cls, part), schemas, is_sent=part == "Goal")
        for part in ("Goal", "Result", "Feedback")
    )
    outcome: Schema = {
        "type": "object",
        "properties": {
            "goal_id": {"type": "string"},
            "status": {"type": "string", "enum": ["SUCCEEDED", "CANCELED", "ABORTED", "UNKNOWN"]},
            "error": {"type": "string"},
            "result": result,
        },
    }
    events = {"schema": {"type": "string"}, "x-feedback": feedback}
    sent = operation(
        f"goal{offer.name}",
        f"Send a goal to {offer.name}, and follow it.",
        answer(outcome, **{"text/event-stream": events}),
        description="The events are `accepted`, `feedback`, and `result` or `failure`. "
        "Closing the connection cancels the goal.",
        **body(goal),
    )
    return {"post": sent}


def node_operations(offer: Offer, _schemas: dict[str, Schema]) -> Schema:
    """Return the operation that reads a node's parameters."""
    values = {"type": "object", "additionalProperties": ref("Value")}
    text = f"The parameters of {offer.name}."
    return {"get": operation(f"get_parameters{offer.name}", text, answer(values))}


def parameter_operations(offer: Offer) -> Schema:
    """Return the operation that sets one parameter."""
    name = {"name": "parameter", "in": "path", "required": True, "schema": {"type": "string"}}
    done = {"204": {"description": "The parameter is set."}}
    text = f"Set a parameter of {offer.name}."
    changed = operation(f"set_parameter{offer.name}", text, done, **body(ref("Value")))
    return {"parameters": [name], "put": changed}


# Schemas of messages


def ref(name: str) -> Schema:
    """Return a reference to a component."""
    return {"$ref": f"#/components/schemas/{name}"}


def component(
    cls: type[Message] | None, schemas: dict[str, Schema], *, is_sent: bool = False
) -> Schema:
    """Return a reference to the schema of a message, adding that schema and those nested in it.

    Args:
        cls: The class of the message; None if no node knows it.
        schemas: The schemas so far.
        is_sent: Whether clients send the message, whose numbers may then not be null.
    """
    if cls is None:
        return {"type": "object", "description": "No node describes this type."}
    is_sent = is_sent and has_real(cls)
    name = type_name(cls).replace("/", ".") + (SENT if is_sent else "")
    if name not in schemas:
        schema = schemas[name] = json_schema(cls)
        schema["title"] += SENT if is_sent else ""  # generators derive names from it
        for field in fields(cls):
            shown = schema["properties"][field.name]
            schema["properties"][field.name] = in_json(field.type, shown, schemas, is_sent=is_sent)
    return ref(name)


def in_json(
    type_: FieldType, shown: Schema, schemas: dict[str, Schema], *, is_sent: bool
) -> Schema:
    """Return the schema of a field in the JSON form of the gateway.

    It differs from `json_schema` in three points: nested messages are references, byte arrays are
        Base64 text, and null stands for the NaN and the infinities of the robot.
    """
    notes = {key: shown[key] for key in ("description",) if key in shown}
    if type_.container != "single":
        if type_.kind in {"uint8", "char"}:
            return {**notes, "type": "string", "contentEncoding": "base64"}
        items = in_json(type_.element, shown["items"], schemas, is_sent=is_sent)
        return {**shown, "items": items}
    if type_.nested is not None:
        return {**component(type_.nested, schemas, is_sent=is_sent), **notes}
    if is_real(type_) and not is_sent:
        return {**shown, "type": ["number", "null"]}
    return shown


def is_real(type_: FieldType) -> bool:
    """Return whether a field has floating-point numbers."""
    return type_.kind in {"float32", "float64"}


def has_real(cls: type[Message]) -> bool:
    """Return whether a message has floating-point numbers, itself or in those nested in it."""
    return any(
        is_real(field.type) or (field.type.nested is not None and has_real(field.type.nested))
        for field in fields(cls)
    )
