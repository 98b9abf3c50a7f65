"""`nav2_simple_commander.line_iterator`: the points of a line, one after another."""

from __future__ import annotations

import math

__all__ = ["LineIterator"]

DIGITS = 5
"""How many digits of a point count."""


class LineIterator:
    """Goes along a line in steps of its abscissa, or of its ordinate where that does not change.

    Raises:
        TypeError: A coordinate or the step is not a number.
        ValueError: The step is not positive, or the line has no length.
    """

    def __init__(self, x0: float, y0: float, x1: float, y1: float, step_size: float = 1.0) -> None:
        given = {"x0": x0, "y0": y0, "x1": x1, "y1": y1, "step_size": step_size}
        for name, value in given.items():
            if type(value) not in (int, float):
                raise TypeError(f"{name} must be a number (int or float)")
        if step_size <= 0:
            raise ValueError("step_size must be a positive number")
        if (x0, y0) == (x1, y1):
            raise ValueError("Line has zero length (All 4 points have same coordinates)")
        self.x0_, self.y0_, self.x1_, self.y1_ = x0, y0, x1, y1
        self.x_, self.y_ = x0, y0
        self.step_size_ = step_size
        self.valid_ = True
        if x1 != x0:
            self.m_ = (y1 - y0) / (x1 - x0)
            self.b_ = y1 - self.m_ * x1

    def isValid(self) -> bool:
        """Return whether the end has not been passed."""
        return self.valid_

    def advance(self) -> None:
        """Go to the next point; the last one is the end of the line."""
        if self.x1_ != self.x0_:
            if self.x_ == self.x1_:
                self.valid_ = False
                return
            self.x_ = self.step(self.x_, self.x0_, self.x1_)
            self.y_ = round(self.m_ * self.x_ + self.b_, DIGITS)
        elif self.y_ == self.y1_:
            self.valid_ = False
        else:
            self.y_ = self.step(self.y_, self.y0_, self.y1_)

    def step(self, now: float, first: float, last: float) -> float:
        """Return a coordinate one step later, not beyond the last one."""
        after = now + math.copysign(self.step_size_, last - first)
        after = self.clamp(after, min(first, last), max(first, last))
        return last if after == last else round(after, DIGITS)

    def getX(self) -> float:
        """Return the abscissa of the point."""
        return self.x_

    def getY(self) -> float:
        """Return the ordinate of the point."""
        return self.y_

    def getX0(self) -> float:
        """Return the abscissa of the first point."""
        return self.x0_

    def getY0(self) -> float:
        """Return the ordinate of the first point."""
        return self.y0_

    def getX1(self) -> float:
        """Return the abscissa of the last point."""
        return self.x1_

    def getY1(self) -> float:
        """Return the ordinate of the last point."""
        return self.y1_

    def get_line_length(self) -> float:
        """Return the length of the line."""
        return math.hypot(self.x1_ - self.x0_, self.y1_ - self.y0_)

    def clamp(self, n: float, min_n: float, max_n: float) -> float:
        """Return a number, or the limit that it exceeds."""
        return min(max(n, min_n), max_n)
