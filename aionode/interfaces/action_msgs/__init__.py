"""Interfaces of action_msgs: what every action is carried out with."""
