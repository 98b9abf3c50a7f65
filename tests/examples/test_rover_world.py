"""The physics of the rover's room, and what its sensors see."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.examples.rover.world import (
    BALL,
    BALL_RADIUS,
    RADIUS,
    WALLS,
    Place,
    World,
    clearance,
)

SPEEDS = st.floats(-1.0, 1.0)
TURNS = st.floats(-2.0, 2.0)
DRIVES = st.lists(st.tuples(SPEEDS, TURNS, st.floats(0.0, 3.0)), max_size=12)
PLACES = st.builds(Place, SPEEDS, SPEEDS, st.floats(-math.pi, math.pi))
ANGLES = np.linspace(-math.pi, math.pi, 60, endpoint=False)


def driven(drives: list[tuple[float, float, float]]) -> World:
    """Return the world after some drives."""
    world = World()
    for speed, turn, seconds in drives:
        world.drive(speed, turn, seconds)
    return world


@given(drives=DRIVES)
def test_nothing_is_inside_anything_else(drives: list[tuple[float, float, float]]) -> None:
    """Neither speed nor a corner brings the rover or the ball into a wall, or into each other."""
    world = driven(drives)
    rover, ball = world.rover, world.ball

    assert clearance(rover.x, rover.y) >= RADIUS
    assert clearance(*ball) >= BALL_RADIUS
    assert math.dist(rover[:2], ball) >= RADIUS + BALL_RADIUS - 1e-9
    assert all(abs(x) < 3.0 and abs(y) < 2.0 for x, y in (rover[:2], ball))


@given(place=PLACES, distance=SPEEDS, turn=TURNS)
def test_an_arc_is_its_two_halves(place: Place, distance: float, turn: float) -> None:
    """The size of a step is no matter of where the rover comes to."""
    half = place.moved(distance / 2, turn / 2).moved(distance / 2, turn / 2)
    whole = place.moved(distance, turn)

    assert half[:2] == pytest.approx(whole[:2], abs=1e-9)
    assert math.cos(half.heading - whole.heading) == pytest.approx(1.0)


@given(drives=DRIVES, seconds=st.floats(0.0, 5.0))
def test_a_rover_that_stands_moves_nothing(
    drives: list[tuple[float, float, float]], seconds: float
) -> None:
    """A stop is a stop: also for the ball."""
    world = driven(drives)
    before = world.rover, world.ball

    assert world.drive(0.0, 0.0, seconds) == 0.0
    assert (world.rover, world.ball) == before


@given(drives=DRIVES, speed=SPEEDS, turn=TURNS)
def test_the_rover_comes_no_further_than_its_wheels_turn(
    drives: list[tuple[float, float, float]], speed: float, turn: float
) -> None:
    """Odometry is the way of the rover, which an obstacle makes shorter and never longer."""
    world = driven(drives)
    before = world.rover
    distance = world.drive(speed, turn, 1.0)

    assert abs(distance) <= abs(speed) + 1e-9
    assert math.dist(before[:2], world.rover[:2]) <= abs(distance) + 1e-9


def test_the_rover_pushes_the_ball_as_far_as_the_wall() -> None:
    """The ball is heavy: it stands when the rover does, and holds the rover up at the wall."""
    world = World()
    world.rover = Place(-2.0, 1.4, math.pi)
    world.ball = (-2.5, 1.4)

    assert world.drive(0.5, 0.0, 10.0) < 1.0
    assert world.ball[0] == pytest.approx(-3.0 + BALL_RADIUS, abs=0.03)
    assert world.rover.x == pytest.approx(world.ball[0] + RADIUS + BALL_RADIUS)


@given(drives=DRIVES)
def test_each_beam_of_the_lidar_ends_where_something_is(
    drives: list[tuple[float, float, float]],
) -> None:
    """At its end is a wall or the ball, and nothing stands in its way."""
    world = driven(drives)
    x, y, heading = world.rover
    for angle, distance in zip(ANGLES, world.scan(world.rover, ANGLES), strict=True):
        for part in (1.0, 0.9, 0.5):
            end = (
                x + part * distance * math.cos(heading + angle),
                y + part * distance * math.sin(heading + angle),
            )
            free = min(clearance(*end), math.dist(end, world.ball) - BALL_RADIUS)
            if part == 1.0:
                assert abs(free) < 1e-6
            else:
                assert free > -1e-9


def test_the_camera_sees_the_ball_ahead_and_not_behind_a_wall() -> None:
    """What is nearer hides what is farther away."""
    world = World()
    world.ball = (-0.5, -1.0)
    seen = world.picture(Place(-1.5, -1.0))
    hidden = world.picture(Place(1.5, -1.0, math.pi))

    rows, columns = np.nonzero((seen == BALL).all(axis=2))
    assert 75 <= columns.mean() <= 85
    assert rows.mean() > 60, "it lies on the floor, below the horizon"
    assert not (hidden == BALL).all(axis=2).any()


@given(place=PLACES)
def test_every_pixel_has_a_color(place: Place) -> None:
    """No line of sight ends nowhere: neither along a wall nor in a corner."""
    picture = World().picture(place, 32, 24)

    assert picture.shape == (24, 32, 3)
    assert picture.any(axis=2).all()


def test_the_room_is_closed() -> None:
    """From the middle, each direction meets a wall within its diagonal."""
    world = World()
    assert (world.scan(Place(), ANGLES) < math.hypot(*np.ptp(WALLS[:, :2], axis=0))).all()
