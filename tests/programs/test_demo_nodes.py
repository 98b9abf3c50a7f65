"""The talker and listener of ROS 2's tutorials."""

from __future__ import annotations

import pytest

from aionode.programs._demo_nodes.listener import Listener
from aionode.programs._demo_nodes.talker import Talker
from aionode.testing import ManualClock, settle
from tests.programs.conftest import Start


async def test_what_the_talker_says_the_listener_hears(
    start: Start, manual_clock: ManualClock, capfd: pytest.CaptureFixture[str]
) -> None:
    """In the originals' words, which tutorials show."""
    start(Talker)
    start(Listener)
    await manual_clock.advance(2.0)
    await settle()

    err = capfd.readouterr().err
    assert "[talker]: Publishing: 'Hello World: 2'" in err
    assert "[listener]: I heard: [Hello World: 2]" in err
