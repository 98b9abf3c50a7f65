"""Interfaces of dwb_msgs: trajectories and scores of Nav2's DWB controller."""
