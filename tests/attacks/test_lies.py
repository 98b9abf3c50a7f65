"""The fuzzer's lies fit the current protocol, so that they find the defects they are meant to."""

from __future__ import annotations

import random
from typing import Any

import pytest

from aionode.engine.transport.reliability import submessage as acknack
from aionode.engine.transport.reliability import writer_proxy
from aionode.engine.transport.reliability.submessage import SubmessageKind
from aionode.engine.transport.reliability.writer_proxy import WriterProxy
from tests.attacks.liar import Liar
from tests.attacks.lies import lie_in_submessage
from tests.attacks.planted import plant_submessages

GID = bytes(16)


class Told:
    """A reader that receives a liar's submessages as if over the wire."""

    def __init__(self) -> None:
        self.heard: list[int] = []
        self.now_ns = 10**9
        self.proxy = WriterProxy(
            GID, "a1", GID, self, lambda: self.now_ns, first=1, span=1 << 62, delivered=0
        )

    def put(self, _key: str, payload: bytes, _extra: bytes | None = None) -> None:
        """Process a submessage."""
        submessage = acknack.unpack(payload)
        if submessage is None:  # malformed
            return
        if submessage.kind is SubmessageKind.HEARTBEAT:
            self.proxy.heartbeat(submessage.first, submessage.last)
        else:
            self.proxy.gap(submessage.first, submessage.last)

    def accept(self, item: Any, _proxy: WriterProxy) -> bool:
        """Receive a message."""
        self.heard.append(item)
        return True

    def send(self, *_: object) -> None:
        """Send nothing."""

    refused = started_anew = send


@pytest.mark.parametrize("is_planted", [False, True], ids=["mended", "planted"])
def test_the_lies_about_messages_find_a_reader_that_believes_them(
    monkeypatch: pytest.MonkeyPatch, *, is_planted: bool
) -> None:
    """One HEARTBEAT or GAP with 2^62 silenced a topic; the fixed reader receives everything."""
    if is_planted:
        for name in ("_start_anew", "_start_at"):  # so that they are put back
            monkeypatch.setattr(WriterProxy, name, getattr(WriterProxy, name))
        monkeypatch.setattr(writer_proxy, "BELIEVED", writer_proxy.BELIEVED)
        plant_submessages()
    told, chance = Told(), random.Random(1)
    liar: Any = object.__new__(Liar)
    node = type("Node", (), {"participant": "a1"})()
    fields = {"name": "/chatter", "type_name": "a/msg/B", "type_hash": "", "gid": GID, "node": node}
    liar.domain, liar.put = 42, told.put
    liar.known = lambda *_: [type("Endpoint", (), fields)()]
    for number in range(1, 201):
        lie_in_submessage(liar, chance)
        told.now_ns += 10_000_000
        told.proxy.receive(number, number, 10)

    assert (told.heard == list(range(1, 201))) is not is_planted
