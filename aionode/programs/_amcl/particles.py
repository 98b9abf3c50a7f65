"""The cloud of particles: how it moves, and how the better particles replace the others."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from aionode.programs._poses import Array, wrapped

__all__ = ["Estimate", "Particles", "moved_differentially", "moved_sideways"]

BIN: Final = np.array([0.5, 0.5, math.radians(10.0)])
"""Particles within a box of this size count as one for clusters, and for how many are needed."""

Bins = npt.NDArray[np.int64]

AROUND: Final = np.array(list(np.ndindex(3, 3, 3)))[14:] - 1
"""The steps from a bin to half of the bins that touch it; the other half are the reverse steps."""

NO_WAY: Final = 0.01
"""A shorter move has no direction."""


@dataclass(frozen=True)
class Estimate:
    """Where most of the weight is.

    Attributes:
        pose: x, y and the heading of the heaviest cluster.
        covariance: Of all particles, for x, y and the heading.
    """

    pose: Array
    covariance: Array


class Particles:
    """Possible poses of the robot, with weights.

    Args:
        random: The random number generator.
        least: The lowest number of particles.
        most: The highest.
        error: How far their distribution may be off.
        z: The standard score of the confidence in that limit.
        slow: How fast the long-term average of likelihoods follows; 0 for no recovery.
        fast: The same for the short-term average.

    Attributes:
        poses: x, y and the heading of each.
        weights: Their sum is 1.
    """

    def __init__(
        self,
        random: np.random.Generator,
        *,
        least: int,
        most: int,
        error: float,
        z: float,
        slow: float = 0.0,
        fast: float = 0.0,
    ) -> None:
        self.random = random
        self.least, self.most = least, most
        self.error, self.z = error, z
        self.slow, self.fast = slow, fast
        self.slow_average = self.fast_average = 0.0
        self.spread(np.zeros((1, 3)))

    def spread(self, poses: Array) -> None:
        """Replace the particles by equally likely ones."""
        self.poses = poses
        self.weights: Array = np.full(len(poses), 1.0 / len(poses))
        self.slow_average = self.fast_average = 0.0

    def place(self, mean: Sequence[float], covariance: Array) -> None:
        """Spread particles around a pose."""
        self.spread(
            self.random.multivariate_normal(mean, covariance, self.most, check_valid="ignore")
        )

    def weigh(self, likelihood: Array) -> None:
        """Multiply the weights by how likely each particle is."""
        weights = self.weights * likelihood
        total = float(weights.sum())
        if not 0.0 < total < math.inf:
            self.weights = np.full(len(self.poses), 1.0 / len(self.poses))
            return
        self.weights = weights / total
        average = total / len(weights)
        for name, rate in (("slow_average", self.slow), ("fast_average", self.fast)):
            before = getattr(self, name)
            setattr(self, name, before + rate * (average - before) if before else average)

    def resample(self, anywhere: Callable[[int], Array]) -> None:
        """Draw new particles: heavier ones more often, and as many as their spread needs.

        Args:
            anywhere: Returns poses from all over the map: some are drawn when the particles fit
                much worse than usual, as the robot may have been carried away.
        """
        lost = 0.0
        if self.slow_average > 0.0:
            lost = max(0.0, 1.0 - self.fast_average / self.slow_average)
        poses = self.poses[self.random.choice(len(self.poses), self.most, p=self.weights)]
        is_random = self.random.random(self.most) < lost
        if is_random.any():
            poses[is_random] = anywhere(int(is_random.sum()))
        averages = self.slow_average, self.fast_average
        self.spread(poses[: self.needed(poses)])
        if not lost:
            self.slow_average, self.fast_average = averages

    def needed(self, poses: Array) -> int:
        """Return how many of these poses suffice: those drawn until few new bins appear."""
        _, first = np.unique(keys_of(bins_of(poses))[0], return_index=True)
        filled = np.zeros(len(poses), dtype=int)
        filled[first] = 1
        enough = np.arange(1, len(poses) + 1) > self.limits(np.cumsum(filled))
        return int(np.argmax(enough)) + 1 if enough.any() else len(poses)

    def limits(self, count: Bins) -> Array:
        """Return how many particles a number of filled bins needs, after Fox (2001)."""
        more = np.maximum(count - 1, 1)
        part = 2.0 / (9.0 * more)
        needed = np.ceil(more / (2.0 * self.error) * (1.0 - part + np.sqrt(part) * self.z) ** 3)
        result: Array = np.where(count <= 1, self.most, np.clip(needed, self.least, self.most))
        return result

    def estimate(self) -> Estimate:
        """Return where the heaviest cluster is."""
        clusters = clusters_of(bins_of(self.poses))
        heaviest = np.argmax(np.bincount(clusters, self.weights))
        mine = clusters == heaviest
        pose, _ = statistics(self.poses[mine], self.weights[mine])
        return Estimate(pose, statistics(self.poses, self.weights)[1])


def bins_of(poses: Array) -> Bins:
    """Return the bin of each pose."""
    result: Bins = np.floor(poses / BIN).astype(np.int64)
    return result


def keys_of(bins: Bins) -> tuple[Bins, Bins]:
    """Return a number for each bin, and how much it grows with each coordinate."""
    spans = np.ptp(bins, axis=0) + 3  # with room for a bin beyond each end
    strides = np.array([spans[1] * spans[2], spans[2], 1])
    return bins @ strides, strides


def clusters_of(bins: Bins) -> Bins:
    """Return the cluster of each bin: bins that touch each other, also by a corner, are one."""
    keys, strides = keys_of(bins)
    distinct, index = np.unique(keys, return_inverse=True)
    pairs = []
    for step in AROUND @ strides:
        at = np.searchsorted(distinct, distinct + step)
        touching = np.flatnonzero(distinct.take(at, mode="clip") == distinct + step)
        pairs.append((at[touching], touching))
    later, earlier = (np.concatenate(each) for each in zip(*pairs, strict=True))
    cluster = np.arange(len(distinct))
    while (apart := cluster[later] != cluster[earlier]).any():
        later, earlier = later[apart], earlier[apart]
        ends = cluster[later], cluster[earlier]
        np.minimum.at(cluster, np.maximum(*ends), np.minimum(*ends))
        while (cluster[cluster] != cluster).any():
            cluster = cluster[cluster]
    return cluster[index.reshape(-1)]


def statistics(poses: Array, weights: Array) -> tuple[Array, Array]:
    """Return mean and covariance of poses; the heading wraps around."""
    share = weights / weights.sum()
    x, y = share @ poses[:, :2]
    cosine, sine = share @ np.cos(poses[:, 2]), share @ np.sin(poses[:, 2])
    off = poses[:, :2] - (x, y)
    covariance = np.zeros((3, 3))
    covariance[:2, :2] = (share * off.T) @ off
    covariance[2, 2] = -2.0 * math.log(min(1.0, max(1e-12, math.hypot(cosine, sine))))
    return np.array([x, y, math.atan2(sine, cosine)]), covariance


Noise = Sequence[float]
"""alpha1 to alpha5: the noise that turns and distances add to turns, distances and sideways."""


def moved_differentially(
    poses: Array, before: Array, delta: Array, alpha: Noise, random: np.random.Generator
) -> Array:
    """Return poses after a move of a robot with two wheels: a turn, a straight line, a turn.

    Args:
        poses: The poses.
        before: The pose of the odometry before the move.
        delta: Its change.
        alpha: The noise.
        random: The random number generator.
    """
    way = math.hypot(delta[0], delta[1])
    first = 0.0 if way < NO_WAY else float(wrapped(math.atan2(delta[1], delta[0]) - before[2]))
    last = float(wrapped(delta[2] - first))
    # Driving backwards is not a turn by half a circle.
    first_size, last_size = (
        min(abs(float(wrapped(each))), abs(float(wrapped(each - math.pi))))
        for each in (first, last)
    )
    count = len(poses)

    def noise(*parts: float) -> Array:
        return random.normal(0.0, math.sqrt(sum(parts)), count)

    a1, a2, a3, a4, *_ = alpha
    first_turn = first - noise(a1 * first_size**2, a2 * way**2)
    moved = way - noise(a3 * way**2, a4 * first_size**2, a4 * last_size**2)
    last_turn = last - noise(a1 * last_size**2, a2 * way**2)
    heading = poses[:, 2] + first_turn
    x, y = poses[:, 0] + moved * np.cos(heading), poses[:, 1] + moved * np.sin(heading)
    return np.column_stack([x, y, wrapped(heading + last_turn)])


def moved_sideways(
    poses: Array, before: Array, delta: Array, alpha: Noise, random: np.random.Generator
) -> Array:
    """Return poses after a move of a robot that drives in any direction; see above."""
    way, turned = math.hypot(delta[0], delta[1]), float(delta[2])
    count = len(poses)

    def noise(*parts: float) -> Array:
        return random.normal(0.0, math.sqrt(sum(parts)), count)

    a1, a2, a3, a4, a5 = alpha
    bearing = math.atan2(delta[1], delta[0]) - before[2] + poses[:, 2]
    cosine, sine = np.cos(bearing), np.sin(bearing)
    moved = way + noise(a3 * way**2, a1 * turned**2)
    aside = noise(a1 * turned**2, a5 * way**2)
    x = poses[:, 0] + moved * cosine + aside * sine
    y = poses[:, 1] + moved * sine - aside * cosine
    yaw = poses[:, 2] + turned + noise(a4 * turned**2, a2 * way**2)
    return np.column_stack([x, y, wrapped(yaw)])
