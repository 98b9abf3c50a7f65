"""Interfaces of moveit_msgs: motion planning, planning scenes and robot states of MoveIt."""
