"""From a message of the robot to a frame for one client, without slowing others down."""
