"""From a message of the robot to a frame for one client, in queues that slow nobody else."""
