"""Interfaces of ros_gz_interfaces: entities, contacts, lights and the control of worlds of Gazebo."""
