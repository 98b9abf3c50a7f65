"""Trajectories of joints, and the controller that follows them."""
