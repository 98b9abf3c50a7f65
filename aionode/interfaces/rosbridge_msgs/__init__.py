"""Interfaces of rosbridge_msgs: the clients of a rosbridge."""
