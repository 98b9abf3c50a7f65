"""Interfaces of robot_controllers_msgs: which controllers run, and why one was stopped."""
