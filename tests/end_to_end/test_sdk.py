"""Interoperation with zenoh-ros2-sdk, which shares no code with aionode."""

from __future__ import annotations

import os

import pytest

from tests.end_to_end.process import Process, member


def test_messages_and_calls_go_both_ways() -> None:
    """Two independent implementations of the format agree."""
    pytest.importorskip("zenoh_ros2_sdk")
    port = os.environ["AIONODE_MEETING_PORTS"].split(",")[0]
    with member("ours") as ours:
        ours.expect("open")
        with Process("tests/end_to_end/sdk_peer.py", port) as sdk:
            sdk.expect("open", "heard ours", "sum 5")
            ours.expect("heard sdk")
            ours.write("call sdk 7")
            ours.expect("sum 7")
