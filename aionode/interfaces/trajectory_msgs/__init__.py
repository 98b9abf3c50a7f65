"""Interfaces of trajectory_msgs: movements of joints."""
