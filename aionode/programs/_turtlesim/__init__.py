"""``turtlesim``: turtles that draw, and programs that move them."""
