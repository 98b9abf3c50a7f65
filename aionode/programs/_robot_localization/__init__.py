"""robot_localization: combines several sensors into one estimate of a robot's state."""
