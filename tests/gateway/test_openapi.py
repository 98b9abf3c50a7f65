"""The OpenAPI document: what a caller may do, and with which messages."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from aionode.gateway.http.openapi import Offer, openapi
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from aionode.interfaces.sensor_msgs.msg import Image

OFFERS = [
    Offer("topic", "/cmd_vel", frozenset({"publish"}), Twist),
    Offer("topic", "/camera/image", frozenset({"subscribe"}), Image),
    Offer("topic", "/pose", frozenset({"subscribe", "publish"}), PoseWithCovarianceStamped),
    Offer("topic", "/strange", frozenset({"subscribe"}), None),
    Offer("service", "/add", frozenset({"call"}), AddTwoInts),
    Offer("action", "/fibonacci", frozenset({"goal"}), Fibonacci),
    Offer("node", "/base", frozenset({"parameter"})),
]


def document() -> dict[str, Any]:
    """Return the document of all kinds of offers."""
    return openapi("robot", "1.0", OFFERS)


def values(part: Any, key: str) -> Iterator[Any]:
    """Yield each value of a key, however deep."""
    if isinstance(part, dict):
        if key in part:
            yield part[key]
        for each in part.values():
            yield from values(each, key)
    elif isinstance(part, list):
        for each in part:
            yield from values(each, key)


def test_a_path_has_only_what_the_caller_may_do() -> None:
    """The document tells a client what it can do."""
    paths = document()["paths"]

    assert set(paths["/topics/cmd_vel"]) == {"post"}
    assert set(paths["/topics/camera/image"]) == {"get"}
    assert set(paths["/topics/pose"]) == {"get", "post"}
    assert set(paths["/services/add"]) == {"post"}
    assert set(paths["/parameters/base/{parameter}"]) == {"parameters", "put"}


def test_every_reference_leads_to_a_schema() -> None:
    """Generators stop at a broken one."""
    whole = document()
    schemas = whole["components"]["schemas"]

    references = set(values(whole, "$ref"))

    assert "#/components/schemas/geometry_msgs.msg.Twist.sent" in references
    assert {each.removeprefix("#/components/schemas/") for each in references} <= set(schemas)
    assert all(re.fullmatch(r"[a-zA-Z0-9._-]+", name) for name in schemas)


def test_the_ids_of_operations_are_unique() -> None:
    """They become the names of methods."""
    ids = list(values(document(), "operationId"))

    assert len(ids) == len(set(ids))


def test_a_body_has_the_json_form_of_the_gateway() -> None:
    """Bytes are Base64, and null stands for NaN, including in arrays."""
    schemas = document()["components"]["schemas"]

    image = schemas["sensor_msgs.msg.Image"]["properties"]
    covariance = schemas["geometry_msgs.msg.PoseWithCovariance"]["properties"]["covariance"]
    vector = schemas["geometry_msgs.msg.Vector3"]["properties"]

    assert image["data"]["contentEncoding"] == "base64"
    assert image["height"] == {
        "type": "integer",
        "minimum": 0,
        "maximum": 2**32 - 1,
        "description": "Number of rows.",
        "default": 0,
    }
    assert covariance["items"] == {"type": ["number", "null"]}
    assert covariance["maxItems"] == 36
    assert vector["x"]["type"] == ["number", "null"]


def test_a_body_that_is_sent_has_no_null() -> None:
    """The gateway refuses it, since JavaScript writes null for an accidental NaN."""
    whole = document()
    schemas = whole["components"]["schemas"]
    pose = schemas["geometry_msgs.msg.PoseWithCovarianceStamped.sent"]["properties"]
    sent = [schema for name, schema in schemas.items() if name.endswith(".sent")]

    body = whole["paths"]["/topics/pose"]["post"]["requestBody"]["content"]["application/json"]
    assert body["schema"]["$ref"].endswith("PoseWithCovarianceStamped.sent")
    assert pose["header"]["$ref"].endswith("std_msgs.msg.Header")  # which has no such number
    assert not [type_ for type_ in values(sent, "type") if type_ == ["number", "null"]]
    assert len({schema["title"] for schema in sent}) == len(sent)


def test_an_image_is_also_a_picture() -> None:
    """A page then knows that it can show it."""
    (answer,) = (document()["paths"]["/topics/camera/image"]["get"]["responses"]["200"],)

    assert set(answer["content"]) == {
        "application/json",
        "text/event-stream",
        "image/jpeg",
        "image/png",
        "multipart/x-mixed-replace",
    }
