"""The version of py_trees_ros whose sources this was compared with."""

__version__ = "2.2.2"
