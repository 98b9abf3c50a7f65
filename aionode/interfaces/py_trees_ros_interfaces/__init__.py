"""Interfaces of py_trees_ros_interfaces: behaviour trees, their blackboards, and the examples of their tutorials."""
