"""Interfaces of control_msgs: joint trajectories, grippers and states of controllers."""
