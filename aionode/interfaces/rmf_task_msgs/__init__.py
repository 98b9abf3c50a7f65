"""Interfaces of rmf_task_msgs: tasks of fleets: requests, bids, dispatch and states."""
