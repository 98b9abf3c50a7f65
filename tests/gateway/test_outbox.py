"""The frames that wait for one client."""

from __future__ import annotations

from aionode.gateway.session.delivery.outbox import (
    LONG_BYTES,
    Frame,
    LongFrame,
    Outbox,
    binary_frame,
)


def test_long_data_are_not_copied() -> None:
    """They may be an image, and many clients may receive it."""
    data = memoryview(bytes(LONG_BYTES + 1))

    frame = binary_frame(b"head", data)

    assert isinstance(frame, LongFrame)
    assert frame.pieces[1] is data
    assert bytes(frame) == b"head" + bytes(data)


async def test_no_frame_overtakes_the_one_that_is_being_written() -> None:
    """The writer has taken it, and waits until the client has read more."""
    outbox = Outbox()
    outbox.put("/t", "first")
    leaving = aiter(outbox)
    assert await anext(leaving) == "first"
    direct: list[Frame] = []

    def send(frame: Frame) -> bool:
        direct.append(frame)
        return True

    outbox.direct = send

    outbox.put("/t", "second")

    assert direct == []
    assert await anext(leaving) == "second"
