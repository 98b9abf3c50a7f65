"""Interfaces of gazebo_msgs: models, links and joints of Gazebo Classic."""
