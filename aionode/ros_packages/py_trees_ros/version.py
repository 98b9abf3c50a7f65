"""The version of py_trees_ros with whose sources this was compared."""

__version__ = "2.2.2"
