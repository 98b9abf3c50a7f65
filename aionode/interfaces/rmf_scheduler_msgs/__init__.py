"""Interfaces of rmf_scheduler_msgs: schedules, and what they start."""
