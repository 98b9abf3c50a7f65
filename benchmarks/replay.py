"""How many messages per second a robot of four nodes processes in a replay, and by itself.

The nodes are those of examples/replay: timers, an action, parameters, transforms, and a thread,
over 60 s of data. Alone, the same messages are published to the same nodes in the same stepped
time, from a list in memory: nothing is read, decoded or watched. In both cases the nodes' output is
recorded, and has to be the same. The rounds alternate; each has a new loop.

    python benchmarks/replay.py [--rounds 5] [--uvloop]
"""

from __future__ import annotations

import argparse
import asyncio
import json
import platform
import statistics
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import uvloop

from aionode import Context, Time, bag
from aionode.bag.replaying.outputs import Tap
from aionode.engine.bare_node import BareNode
from aionode.qos import QoSProfile
from aionode.testing import ManualClock, SteppedLoop, local_context
from examples.replay.robot import OUTPUTS, make_robot, record


async def in_a_replay(path: Path) -> tuple[float, str]:
    """Return the seconds of processor time of a replay, and its digest."""
    async with bag.replay(path) as run:
        make_robot()
        began = time.process_time()
        outputs = await run.play(record=OUTPUTS)
        return time.process_time() - began, outputs.digest()


async def alone(messages: list[tuple[str, int, Any]]) -> tuple[float, str]:
    """Return the seconds that the nodes take without a player, and the digest."""
    clock = ManualClock(Time(nanoseconds=messages[0][1]))
    async with local_context(clock=clock, seed=0) as context, asyncio.TaskGroup() as tasks:
        with Context.as_default(context), SteppedLoop(clock) as stepped, ExitStack() as stack:
            source = BareNode(context, "source")
            publishers = {
                topic: source.create_publisher(type(message), topic, QoSProfile(depth=10))
                for topic, _, message in reversed(messages)
            }
            for node in make_robot():
                tasks.create_task(node.run())
            tap = Tap(source, OUTPUTS)
            stack.enter_context(tap)
            await stepped.settle()
            began = time.process_time()
            for topic, time_ns, message in messages:
                await stepped.walk_to(time_ns)
                publishers[topic].publish(message, time_ns)
                await stepped.settle()
            took = time.process_time() - began
        context.shutdown()
    return took, tap.outputs.digest()


def main() -> None:
    """Measure, and print one line of JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--uvloop", action="store_true")
    options = parser.parse_args()
    run = uvloop.run if options.uvloop else asyncio.run
    with tempfile.TemporaryDirectory() as folder:
        path = record(Path(folder) / "run")
        with bag.open(path) as opened:
            messages = [(one.topic, one.time_ns, one.message) for one in opened.read()]
        runs = [(run(alone(messages)), run(in_a_replay(path))) for _ in range(options.rounds)]
    if len({digest for pair in runs for _, digest in pair}) != 1:
        raise SystemExit("the nodes published something else without the player")
    rounds = [(a, b) for (a, _), (b, _) in runs]
    rate_alone, rate_replay = (
        len(messages) / statistics.median(seconds) for seconds in zip(*rounds, strict=True)
    )
    result = {
        "messages": len(messages),
        "alone_per_s": round(rate_alone),
        "replay_per_s": round(rate_replay),
        "ratio": round(statistics.median(a / b for a, b in rounds), 3),
        "ratios": [round(a / b, 3) for a, b in rounds],
        "loop": "uvloop" if options.uvloop else "asyncio",
        "python": platform.python_version(),
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()
