"""Cartographer's maps: the submaps of a cartographer_node as one grid."""
