"""A room with walls and a ball, seen from above: its physics, and the view of its sensors.

It contains no node, and time passes only by the given steps: lengths are in metres, angles in
radians, and the origin is the middle of the room.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Numbers = npt.NDArray[np.float64]

__all__ = ["BALL_RADIUS", "RADIUS", "WALLS", "Place", "World"]

RADIUS: Final = 0.18
BALL_RADIUS: Final = 0.12
WALL_HEIGHT: Final = 0.6
MAX_STEP: Final = 0.02
"""The largest distance that the rover moves between two checks for contact."""

WALLS: Final[Numbers] = np.array(
    [
        (-3.0, -2.0, 3.0, -2.0),
        (3.0, -2.0, 3.0, 2.0),
        (3.0, 2.0, -3.0, 2.0),
        (-3.0, 2.0, -3.0, -2.0),
        (0.5, -2.0, 0.5, -0.6),
        (-1.5, 2.0, -1.5, 0.8),
    ]
)
"""The ends of each wall: x and y of the first, x and y of the second."""

SKY, WALL, BALL = (190, 215, 235), (150, 120, 100), (210, 60, 40)
TILES: Final = np.array([(110, 115, 120), (160, 165, 170)])


class Place(NamedTuple):
    """A position, and the direction in which something faces."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0

    def moved(self, distance: float, turn: float) -> Place:
        """Return the place after a drive along an arc, during which it turns by `turn`."""
        chord = distance * float(np.sinc(turn / math.tau))  # the straight line between the ends
        along = self.heading + turn / 2
        return Place(
            self.x + chord * math.cos(along),
            self.y + chord * math.sin(along),
            math.remainder(self.heading + turn, math.tau),
        )


class World:
    """The room, the rover in it, and the ball that the rover pushes.

    Attributes:
        rover: Where the rover is.
        ball: The middle of the ball.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Move the rover and the ball back to their start."""
        self.rover = Place(-2.0, -1.0)
        self.ball = (-0.5, -1.0)

    def drive(self, speed: float, turn: float, seconds: float) -> float:
        """Drive for a while, and return the distance; the wheels slip if something is in the way.

        Args:
            speed: The speed, in metres a second.
            turn: The angular velocity, in radians a second.
            seconds: How long.
        """
        steps = max(1, math.ceil(abs(speed) * seconds / MAX_STEP))
        distance, angle = speed * seconds / steps, turn * seconds / steps
        return sum(self._step(distance, angle) for _ in range(steps))

    def _step(self, distance: float, angle: float) -> float:
        wanted = self.rover.moved(distance, angle)
        ball = pushed(self.ball, wanted)
        if clearance(wanted.x, wanted.y) < RADIUS or clearance(*ball) < BALL_RADIUS:
            self.rover = self.rover._replace(heading=wanted.heading)
            return 0.0
        self.rover, self.ball = wanted, ball
        return distance

    def scan(self, place: Place, angles: Numbers) -> Numbers:
        """Return the distance from a place to the next wall or ball, in each direction.

        Args:
            place: Where the scanner is.
            angles: The directions, from that of the place to the left.
        """
        directions = np.stack([np.cos(angles + place.heading), np.sin(angles + place.heading)], 1)
        return np.minimum(to_walls(place, directions), to_ball(place, directions, self.ball))

    def picture(self, place: Place, width: int = 160, height: int = 120) -> npt.NDArray[np.uint8]:
        """Return the view of a camera at a place, as an RGB array of shape (height, width, 3)."""
        above_floor = 0.25
        focal = width / 2  # of a lens that sees a right angle
        left = (width / 2 - 0.5 - np.arange(width)) / focal
        up = (height / 2 - 0.5 - np.arange(height, dtype=np.float64))[:, None] / focal
        cos, sin = math.cos(place.heading), math.sin(place.heading)
        directions = np.stack([cos - left * sin, sin + left * cos], 1)

        # The distance at which the line of sight of each pixel meets each thing.
        wall = to_walls(place, directions)
        meets_wall = above_floor + wall * up < WALL_HEIGHT
        with np.errstate(divide="ignore"):
            floor = np.where(up < 0, -above_floor / up, np.inf) + np.zeros(width)
        ball = to_sphere(place, directions, up, (*self.ball, BALL_RADIUS - above_floor))

        colors = np.full((height, width, 3), SKY)
        colors[meets_wall] = WALL
        is_floor = floor < wall
        spots = np.array(place[:2]) + floor[is_floor][:, None] * directions[np.nonzero(is_floor)[1]]
        colors[is_floor] = TILES[np.floor(spots / 0.5).sum(axis=1).astype(int) % 2]
        colors[ball < np.minimum(floor, wall)] = BALL
        return colors.astype(np.uint8)


def clearance(x: float, y: float) -> float:
    """Return the distance from a point to the next wall."""
    starts, lines = WALLS[:, :2], WALLS[:, 2:] - WALLS[:, :2]
    point = np.array([x, y])
    along = ((point - starts) * lines).sum(axis=1) / (lines**2).sum(axis=1)
    nearest = starts + np.clip(along, 0.0, 1.0)[:, None] * lines
    return float(np.hypot(*(point - nearest).T).min())


def pushed(ball: tuple[float, float], rover: Place) -> tuple[float, float]:
    """Return the position to which the rover pushes the ball: straight ahead of the contact."""
    away = math.hypot(ball[0] - rover.x, ball[1] - rover.y)
    touching = RADIUS + BALL_RADIUS
    if away >= touching or away == 0.0:
        return ball
    part = touching / away
    return rover.x + (ball[0] - rover.x) * part, rover.y + (ball[1] - rover.y) * part


def to_walls(place: Place, directions: Numbers) -> Numbers:
    """Return how many times each direction fits between a place and the next wall."""
    starts, lines = WALLS[:, :2] - place[:2], WALLS[:, 2:] - WALLS[:, :2]
    # A line beside a wall never meets it, or so far away that no number holds it.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        crossing = cross(directions[:, None], lines)
        along = cross(starts, lines) / crossing
        on_wall = cross(starts, directions[:, None]) / crossing
        hits = (along >= 0) & (on_wall >= 0) & (on_wall <= 1)
    nearest: Numbers = np.where(hits, along, np.inf).min(axis=1)
    return nearest


def cross(left: Numbers, right: Numbers) -> Numbers:
    """Return the cross products of vectors in the plane; 0 for parallel ones."""
    product: Numbers = left[..., 0] * right[..., 1] - left[..., 1] * right[..., 0]
    return product


def to_ball(place: Place, directions: Numbers, ball: tuple[float, float]) -> Numbers:
    """Return how many times each direction fits between a place and the ball, from above."""
    flat: Numbers = to_sphere(place, directions, np.zeros((1, 1)), (*ball, 0.0))[0]
    return flat


def to_sphere(
    place: Place, directions: Numbers, up: Numbers, ball: tuple[float, float, float]
) -> Numbers:
    """Return how many times each line of sight, by row and column, fits between eye and ball.

    Args:
        place: The position of the eye.
        directions: Across the floor, for each column of a picture.
        up: How much the lines of sight rise, for each row.
        ball: The middle of the ball; its height is that above the eye.
    """
    x, y, z = ball[0] - place.x, ball[1] - place.y, ball[2]
    square = (directions**2).sum(axis=1) + up**2
    toward = directions @ np.array([x, y]) + up * z
    inside = toward**2 - square * (x * x + y * y + z * z - BALL_RADIUS**2)
    nearest = (toward - np.sqrt(np.maximum(inside, 0.0))) / square
    return np.where((inside >= 0) & (nearest >= 0), nearest, np.inf)
