"""Topics over HTTP: the next message, or a stream of them, as JSON or as pictures."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Final

from starlette.exceptions import HTTPException
from starlette.responses import Response

from aionode.gateway.http.answers import (
    ALIVE,
    EVENTS,
    HEADERS,
    MAX_SEC,
    Asked,
    Stream,
    event,
    json_response,
)
from aionode.gateway.session.encoding.image import BOUNDARY, IMAGE_TYPES, Form, part_of, picture_of
from aionode.gateway.session.encoding.large_json import prepare_json
from aionode.gateway.session.encoding.values import json_of

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator

    from aionode.gateway.session.delivery.outbox import Frame, Outbox
    from aionode.gateway.session.encoding.image import Picture
    from aionode.gateway.session.feed import Received

__all__ = ["answer_topic"]

PICTURES: Final = "multipart/x-mixed-replace"

ANY_PICTURE: Final = "image/*"
"""A JPEG, or a compressed image unchanged."""

MAX_WIDTH: Final = 8192

WAIT_SEC: Final = 5.0
"""How long a request waits for a message by default, in seconds."""

SUFFIXES: Final = {
    ".jpeg": "image/jpeg",
    ".jpg": "image/jpeg",
    ".png": "image/png",
    ".mjpeg": PICTURES,
}
"""The media type for each suffix of a path, which is the only way for an ``<img>`` to name one."""


async def answer_topic(asked: Asked) -> Response:
    """Return the next message of a topic, or a stream of its messages."""
    topic, media_type = topic_and_form(asked)
    type_name = asked.type_name
    if type_name is None and not asked.session.graph.types_of(topic, "topic"):
        raise HTTPException(404, f"{topic[:200]}: no such topic; ?type= waits for one of that type")
    if media_type == EVENTS:
        return await events(asked, topic)
    newest = await Newest.of(asked, topic)
    received = await newest.within(asked.number("timeout_sec", WAIT_SEC, MAX_SEC))
    if media_type == "application/json":
        return json_response(await asked.session.json_of(received))
    form = picture_form(asked, media_type)
    picture = await picture_or_refusal(received, form)
    if media_type == PICTURES:
        boundary = f"{PICTURES}; boundary={BOUNDARY}"
        return Stream(
            asked.session, pictures(asked, newest, form), boundary, first=part_of(picture)
        )
    return Response(bytes(picture.data), headers=HEADERS, media_type=picture.media_type)


def topic_and_form(asked: Asked) -> tuple[str, str]:
    """Return the name of a topic, and the media type in which the caller wants its messages.

    An image is a picture unless the caller asks for JSON.
    """
    path, accept = asked.name, asked.accept
    for suffix, media_type in SUFFIXES.items():
        if path.endswith(suffix):
            return path.removesuffix(suffix), media_type
    for media_type in (EVENTS, PICTURES, "application/json"):
        if media_type in accept:
            return path, media_type
    wanted = picture_type(accept)
    types = {asked.type_name, *asked.session.graph.types_of(path, "topic")}
    return path, wanted or (ANY_PICTURE if types & IMAGE_TYPES else "application/json")


def picture_type(accept: str) -> str | None:
    """Return the picture format that a caller prefers: JPEG or PNG; None for no picture.

    A browser lists all formats that it can show, including WebP, without preferring one.
    """
    given = {}
    for entry in accept.split(","):
        media_type, *parameters = (part.strip().lower() for part in entry.split(";"))
        weights = [part[2:] for part in parameters if part.startswith("q=")]
        try:
            given[media_type] = float(weights[0]) if weights else 1.0
        except ValueError:
            given[media_type] = 0.0
    if {"image/avif", "image/webp"} & given.keys():
        return None
    png, jpeg = given.get("image/png", 0.0), given.get("image/jpeg", 0.0)
    any_other = max(given.get("image/*", 0.0), given.get("*/*", 0.0))
    if png > max(jpeg, 0.0 if "image/jpeg" in given else any_other):
        return "image/png"
    return "image/jpeg" if jpeg else None


# Messages


async def events(asked: Asked, topic: str) -> Response:
    """Return the messages of a topic as server-sent events."""
    period_sec = asked.number("min_period_sec", 0.0, MAX_SEC)
    await asked.session.subscribe(
        topic,
        asked.type_name,
        frame=as_event,
        key=topic,
        # Messages that wait for their time are late: the newest is enough, unless more are
        # requested.
        depth=round(asked.number("depth", 1 if period_sec else 10, 1000)) or 1,
        min_period_sec=period_sec,
        prepare=prepare_json,
    )
    return Stream(asked.session, frames(asked.session.outbox), EVENTS, first=ALIVE, alive=ALIVE)


def as_event(received: Received) -> Frame:
    """Return a message as an event, encoded once for all clients."""
    return received.once(EVENTS, make_event)


def make_event(received: Received) -> bytes:
    """Return a message as an event."""
    return event("", received.once("json", lambda taken: json_of(taken.message)))


async def frames(outbox: Outbox) -> AsyncGenerator[Frame, None]:
    """Yield the frames that leave an outbox."""
    async for frame in outbox:
        yield frame


class Newest:
    """Holds the newest message of a topic; older ones are dropped.

    Unlike a frame in an outbox, it is encoded only when its client is ready for it.
    """

    def __init__(self, topic: str) -> None:
        self._topic = topic
        self._received: Received | None = None
        self._arrived = asyncio.Event()

    @classmethod
    async def of(cls, asked: Asked, topic: str) -> Newest:
        """Subscribe to a topic."""
        newest = cls(topic)
        period_sec = asked.number("min_period_sec", 0.0, MAX_SEC)
        await asked.session.subscribe(
            topic, asked.type_name, frame=newest.put, key=topic, depth=1, min_period_sec=period_sec
        )
        return newest

    def put(self, received: Received) -> None:
        """Keep a message; called by `Session.subscribe`, for which it returns no frame."""
        self._received = received
        self._arrived.set()

    async def get(self) -> Received:
        """Wait for a message that has not been returned yet."""
        while self._received is None:
            self._arrived.clear()
            await self._arrived.wait()
        received, self._received = self._received, None
        return received

    async def within(self, timeout_sec: float) -> Received:
        """Wait for a message.

        Raises:
            HTTPException: there was none within `timeout_sec` seconds (504).
        """
        try:
            async with asyncio.timeout(timeout_sec):
                return await self.get()
        except TimeoutError:
            text = f"{self._topic}: no message within {timeout_sec:g} s; ?timeout_sec= waits longer"
            raise HTTPException(504, text) from None


# Pictures


def picture_form(asked: Asked, media_type: str) -> Form:
    """Return the form in which the caller wants a picture.

    Raises:
        HTTPException: a parameter is invalid (400).
    """
    width = round(asked.number("width", 0.0, MAX_WIDTH))
    quality = None
    if "quality" in asked.request.query_params:
        quality = max(1, round(asked.number("quality", 0.0, 100.0)))
        if media_type == "image/png":
            raise HTTPException(400, "quality: a PNG loses nothing; only a JPEG has a quality")
    plain = None if media_type in {ANY_PICTURE, PICTURES} else media_type
    return Form(plain, width, quality)


async def picture_or_refusal(received: Received, form: Form) -> Picture:
    """Return the picture of an image.

    Raises:
        HTTPException: it is not an image (406), it cannot be converted to a picture (422), or
            Pillow is not installed (501).
    """
    if received.type_name not in IMAGE_TYPES:
        text = f"{received.topic} has {received.type_name}, which is not an image"
        raise HTTPException(406, text)
    try:
        return await picture_of(received, form)
    except ValueError as error:
        raise HTTPException(422, str(error)) from error
    except ModuleNotFoundError as error:
        raise HTTPException(501, str(error)) from error


async def pictures(asked: Asked, newest: Newest, form: Form) -> AsyncGenerator[Frame, None]:
    """Yield the pictures of a topic, as fast as the client reads them; a failed one is the last."""
    while True:
        try:
            picture = await picture_or_refusal(await newest.get(), form)
        except HTTPException as error:
            asked.session.rights.note_failure(error, f"GET {asked.request.url.path}")
            return
        yield part_of(picture)
