"""Interfaces of shape_msgs: solids, meshes and planes."""
