"""The frames that wait for one client."""

from __future__ import annotations

from aionode.gateway._outbox import Frame, Outbox


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
