"""robot_localization: what several sensors say of where a robot is, as one estimate."""
