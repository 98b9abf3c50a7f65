"""Interfaces of rosapi_msgs: questions about the graph, for browsers beside rosbridge."""
