"""ros2_control: the controller manager, its hardware, its controllers, and what spawns them."""
