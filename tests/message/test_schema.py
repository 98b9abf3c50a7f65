"""Messages as JSON Schema, as fields of Pydantic models, and as bodies and responses of FastAPI."""

from __future__ import annotations

import subprocess
import sys
from typing import Annotated, Any

import httpx
import pytest
from fastapi import Body, FastAPI
from pydantic import BaseModel, ValidationError

from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.geometry_msgs.msg import Twist, Vector3
from aionode.interfaces.sensor_msgs.msg import Image, LaserScan
from aionode.message import Array, Bounded, Message, Sequence, byte, float64, json_schema, uint8


class Reading(Message, typename="tutorial/msg/Reading"):
    """What one sensor saw.

    Attributes:
        sensor: Which one,
            by its place.
        values: What it measured, in V.
    """

    sensor: Bounded[str, 16] = "front"
    values: Sequence[float64, 4]
    place: Vector3
    flags: uint8 = 3
    kind: byte = b"\x02"
    pair: Array[uint8, 2] = (1, 2)


# JSON Schema


def test_the_schema_of_a_message_is_an_object_for_tools() -> None:
    """It contains the docstring, ranges and defaults, without references."""
    assert json_schema(Reading) == {
        "title": "Reading",
        "type": "object",
        "description": "What one sensor saw.",
        "properties": {
            "sensor": {
                "type": "string",
                "maxLength": 16,
                "description": "Which one, by its place.",
                "default": "front",
            },
            "values": {
                "type": "array",
                "items": {"type": "number"},
                "maxItems": 4,
                "description": "What it measured, in V.",
            },
            "place": {
                "title": "Vector3",
                "type": "object",
                "description": (
                    "A direction with a length, in a unit that depends on its use; "
                    "a position is a Point."
                ),
                "properties": {axis: {"type": "number", "default": 0.0} for axis in "xyz"},
                "additionalProperties": False,
            },
            "flags": {"type": "integer", "minimum": 0, "maximum": 255, "default": 3},
            "kind": {"type": "integer", "minimum": 0, "maximum": 255, "default": 2},
            "pair": {
                "type": "array",
                "items": {"type": "integer", "minimum": 0, "maximum": 255},
                "minItems": 2,
                "maxItems": 2,
                "default": [1, 2],
            },
        },
        "additionalProperties": False,
    }


def test_limits_that_a_float_cannot_hold_are_left_out() -> None:
    """Written as 9.223372036854776e+18, the largest int64 would be one too large."""
    assert json_schema(AddTwoInts.Request)["properties"]["a"] == {"type": "integer", "default": 0}


def test_a_service_has_no_schema_but_its_halves_have() -> None:
    """The error says what to use instead."""
    with pytest.raises(TypeError, match=r"\.Request"):
        json_schema(AddTwoInts)  # type: ignore[arg-type]  # the mistake


# Pydantic


class Order(BaseModel):
    """A model with messages in it."""

    twist: Twist
    scan: LaserScan | None = None


def test_a_model_reads_and_writes_messages() -> None:
    """Arrays, bytes, NaN and infinity are written as by `to_json`."""
    order = Order.model_validate_json('{"twist": {"linear": {"x": 1}}, "scan": {"ranges": [2]}}')

    assert order.twist == Twist(linear=Vector3(x=1.0))
    order = Order(twist=Twist(), scan=LaserScan(ranges=[1.0, float("inf")]))
    assert '"ranges":[1.0,"Infinity"]' in order.model_dump_json()
    assert Order.model_validate_json(order.model_dump_json()).scan == order.scan


def test_a_model_as_python_has_plain_values() -> None:
    """As `to_builtins` gives them."""
    order = Order(twist=Twist(), scan=LaserScan(ranges=[float("inf")]))

    assert order.model_dump()["scan"]["ranges"] == [float("inf")]


def test_a_message_that_is_one_already_is_taken_as_it_is() -> None:
    """It is not copied, like any other object of a model."""
    twist = Twist()

    assert Order(twist=twist).twist is twist


def test_a_wrong_field_is_a_validation_error_with_its_path() -> None:
    """FastAPI turns it into a 422."""
    with pytest.raises(ValidationError, match=r"geometry_msgs/msg/Twist\.linear\.x: 'fast'"):
        Order.model_validate({"twist": {"linear": {"x": "fast"}}})


def test_bytes_are_lists_of_numbers() -> None:
    """As ROS prints them."""

    class Picture(BaseModel):
        image: Image

    picture = Picture(image=Image(data=b"\x00\xff"))

    assert '"data":[0,255]' in picture.model_dump_json()
    assert Picture.model_validate_json(picture.model_dump_json()).image == picture.image


def test_the_schema_of_a_model_names_each_message_once() -> None:
    """Generated clients have one type for each, in both directions."""
    schema = Order.model_json_schema()

    assert set(schema["$defs"]) == {"Twist", "Vector3", "LaserScan", "Header", "Time"}
    assert schema["properties"]["twist"] == {"$ref": "#/$defs/Twist"}
    twist = schema["$defs"]["Twist"]["properties"]
    assert twist["linear"]["allOf"] == [{"$ref": "#/$defs/Vector3"}]
    assert Order.model_json_schema(mode="serialization")["$defs"] == schema["$defs"]


def test_a_message_needs_no_pydantic() -> None:
    """It is not imported where it is not used."""
    code = (
        "import sys; from aionode.interfaces.std_msgs.msg import String; "
        "from aionode.message import json_schema; json_schema(String); "
        "sys.exit('pydantic' in sys.modules or 'pydantic_core' in sys.modules)"
    )

    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


# FastAPI


@pytest.fixture
def app() -> FastAPI:
    """An application with messages as body and response."""
    app = FastAPI()

    @app.post("/stretch")
    async def stretch(twist: Annotated[Twist, Body()]) -> LaserScan:
        return LaserScan(ranges=[twist.linear.x, float("inf")])

    return app


async def ask(app: FastAPI, body: Any, path: str = "/stretch") -> httpx.Response:
    """Send a request."""
    transport = httpx.ASGITransport(app)
    async with httpx.AsyncClient(transport=transport, base_url="http://robot") as client:
        return await client.post(path, json=body)


async def test_a_route_takes_and_returns_messages(app: FastAPI) -> None:
    """As it does with models."""
    response = await ask(app, {"linear": {"x": 0.5}})

    assert response.status_code == 200
    assert response.json()["ranges"] == [0.5, "Infinity"]


async def test_a_wrong_body_is_a_422_that_names_the_field(app: FastAPI) -> None:
    """The handler is not called."""
    response = await ask(app, {"linear": {"w": 0.5}})

    assert response.status_code == 422
    assert "geometry_msgs/msg/Twist.linear.w: no such field" in response.text


def test_openapi_has_the_messages_as_components(app: FastAPI) -> None:
    """By their names, for generated clients."""
    schema = app.openapi()
    post = schema["paths"]["/stretch"]["post"]
    body = post["requestBody"]["content"]["application/json"]["schema"]
    answer = post["responses"]["200"]["content"]["application/json"]["schema"]

    assert body == {"$ref": "#/components/schemas/Twist"}
    assert answer == {"$ref": "#/components/schemas/LaserScan"}
    ranges = schema["components"]["schemas"]["LaserScan"]["properties"]["ranges"]
    assert ranges["items"]["anyOf"][1]["enum"] == ["NaN", "Infinity", "-Infinity"]


@pytest.mark.parametrize("annotation", [None, Any, object, dict[str, Any]], ids=str)
async def test_messages_are_written_in_responses_that_no_annotation_describes(
    annotation: Any,
) -> None:
    """Bytes, arrays and NaN are written as by `to_json`, even without an annotation."""
    app = FastAPI()

    async def status():  # type: ignore[no-untyped-def]  # noqa: ANN202  # as users write it
        return {"seen": [LaserScan(ranges=[1.5, float("nan")])], "last": Image(data=b"\xff")}

    if annotation is not None:
        status.__annotations__["return"] = annotation
    app.post("/")(status)

    answer = await ask(app, None, "/")

    assert answer.status_code == 200
    assert answer.json()["seen"][0]["ranges"] == [1.5, "NaN"]
    assert answer.json()["last"]["data"] == [255]


async def test_a_message_alone_is_written_without_an_annotation() -> None:
    """The whole response is one."""
    app = FastAPI()
    app.post("/")(lambda: Vector3(x=1.5))

    answer = await ask(app, None, "/")

    assert answer.json() == {"x": 1.5, "y": 0.0, "z": 0.0}
