"""Interfaces of pcl_msgs: indices, models and meshes of the Point Cloud Library."""
