"""The rover learns to drive to the ball: ``python -m aionode.examples.rover.learn VERB``.

``record`` records ten demonstrations by a script, and writes `contract.yaml`, which says what the
policy sees and commands, beside them. `aionode learn export` turns them into a data set. ``train``
fits a policy to it by least squares, and ``drive`` lets that policy drive. The rover has to run
meanwhile. It needs ``pip install 'aionode[bag,gateway,lerobot]'``.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import random
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import aionode
from aionode import Node
from aionode.errors import LeaseExpiredError, StaleError
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.learn import Contract

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    import numpy.typing as npt

    from aionode.learn import ActorStats, Episodes, Observations

    Numbers = npt.NDArray[np.float64]

__all__ = ["demonstrate", "drive", "fitted", "main"]

CONTRACT = Path(__file__).with_name("contract.yaml")
DEMONSTRATIONS, DATA_SET, WEIGHTS = Path("demonstrations"), Path("ball"), Path("ball.npy")
EPISODES = 10
MAX_SEC = 20.0
PARTS = 16
CHUNK = 4
MAX_CHUNKS = 200
"""Maximum number of chunks, which last about a minute and a half."""

NEAR = 2_400
"""The number of red pixels when the ball is half a metre ahead."""


def is_ball(picture: npt.NDArray[np.uint8]) -> npt.NDArray[np.bool_]:
    """Return which pixels are red."""
    red, green, blue = np.moveaxis(picture.astype(int), 2, 0)
    mask: npt.NDArray[np.bool_] = red - np.maximum(green, blue) > 60
    return mask


def look(picture: npt.NDArray[np.uint8]) -> Numbers:
    """Return what the policy sees: the position of the ball in the picture, and its size."""
    columns = is_ball(picture).sum(axis=0).reshape(PARTS, -1).sum(axis=1)
    size = columns.sum()
    return np.array([*columns / max(size, 1), min(1.0, size / NEAR), size > 0, 1.0])


# Record


def script(picture: npt.NDArray[np.uint8]) -> tuple[float, float]:
    """Return the speed and turn of an expert: turn towards the ball, and stop in front of it."""
    columns = is_ball(picture).sum(axis=0)
    size = columns.sum()
    if not size:
        return 0.0, 0.8
    middle = columns @ np.linspace(1.0, -1.0, len(columns)) / size  # 1 is on the left
    return 0.4 * max(0.0, 1 - size / NEAR), 1.5 * middle


async def turn_away(node: Node, seed: int) -> None:
    """Put the rover back, and turn it to a random heading."""
    contract = Contract.load(CONTRACT)
    reset = node.create_client(Trigger, "/simulator/reset")
    await reset.wait_for_service()
    await reset.call(Trigger.Request())
    turn_sec = random.Random(seed).uniform(0.5, 5.5)  # noqa: S311  # no secret
    async with contract.observe(node) as observations, contract.act(node) as actor:
        async for seconds, _ in timed(observations):
            if seconds > turn_sec:
                return
            actor.send([0.0, 1.0])


async def demonstrate(node: Node, episodes: Episodes, seed: int) -> float:
    """Record one episode, and return how many seconds it took."""
    await turn_away(node, seed)
    contract = episodes.contract
    async with (
        contract.observe(node) as observations,
        episodes.record(),
        contract.act(node) as actor,
    ):
        async for seconds, picture in timed(observations):
            speed, turn = script(picture)
            actor.send([speed, turn])
            if seconds > MAX_SEC or (0 < speed < 0.02 and abs(turn) < 0.05):
                break
    return seconds


async def record(node: Node) -> None:
    """Record ten episodes; one in which the camera stalls is a failure, and is recorded again."""
    from aionode.learn import Episodes  # the others need no bags

    shutil.copy(CONTRACT, CONTRACT.name)
    done = failed = 0
    async with Episodes(DEMONSTRATIONS, Contract.load(CONTRACT)) as episodes:
        while done < EPISODES:
            try:
                seconds = await demonstrate(node, episodes, done)
            except (LeaseExpiredError, StaleError) as error:
                failed += 1
                if failed == EPISODES:
                    raise
                print(f"once more: {error}")
                continue
            print(f"episode {done}: {seconds:.1f} s")
            done += 1


async def timed(
    observations: Observations,
) -> AsyncIterator[tuple[float, npt.NDArray[np.uint8]]]:
    """Yield each picture, and how many seconds have passed."""
    began = None
    async for seen in observations.at():
        began = began or seen.at
        yield (seen.at - began).nanoseconds / 1e9, seen.values["observation.images.front"]


# Train


def fitted(data_set: Path) -> Numbers:
    """Return the weights of the policy: from what it sees to the next four commands."""
    import av  # these two are in the extra lerobot
    from pyarrow import parquet

    rows = parquet.read_table(data_set / "data/chunk-000/file-000.parquet")
    commands, episodes = np.stack(rows["action"].to_numpy()), rows["episode_index"].to_numpy()
    with av.open(data_set / "videos/observation.images.front/chunk-000/file-000.mp4") as video:
        pictures = (each.to_ndarray(format="rgb24") for each in video.decode(video=0))
        seen = np.array([look(picture.astype(np.uint8)) for picture in pictures])
    starts = np.arange(len(seen) - CHUNK + 1)
    starts = starts[episodes[starts] == episodes[starts + CHUNK - 1]]  # none goes over an end
    chunks = np.array([commands[start : start + CHUNK].ravel() for start in starts])
    weights: Numbers = np.linalg.lstsq(seen[starts], chunks, rcond=None)[0]
    return weights


# Drive


class Arrived(Exception):  # noqa: N818  # not an error
    """The ball is near, and the rover stands."""


async def drive(node: Node, weights: Numbers) -> ActorStats:
    """Let the policy drive until the ball is near, and return what was sent."""
    asked = itertools.count()

    def policy(observation: dict[str, npt.NDArray[Any]]) -> Numbers:
        if next(asked) == MAX_CHUNKS:
            raise LookupError("the policy does not find the ball; record more demonstrations")
        seen = look(observation["observation.images.front"])
        chunk = (seen @ weights).reshape(CHUNK, 2)
        if seen[PARTS] > 0.9 and abs(chunk).max() < 0.1:
            raise Arrived
        return chunk

    async with Contract.load(CONTRACT).act(node) as actor:
        with contextlib.suppress(Arrived):
            await actor.run(policy)
        return actor.stats


# The command


async def main() -> None:
    """Do what the command line says."""
    parser = argparse.ArgumentParser(description="The rover learns to drive to the ball.")
    parser.add_argument("verb", choices=["record", "train", "drive"])
    given, _ = parser.parse_known_args(sys.argv[1:])  # the others are ROS's
    if given.verb == "train":
        np.save(WEIGHTS, fitted(DATA_SET))
        print(f"trained: {WEIGHTS}")
        return
    async with Node("learner") as node:
        if given.verb == "drive":
            await turn_away(node, EPISODES)  # as no demonstration began
            print(f"arrived: {await drive(node, np.load(WEIGHTS))}")
            return
        await record(node)


if __name__ == "__main__":
    aionode.run(main)
