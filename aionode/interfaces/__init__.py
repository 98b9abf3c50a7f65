"""ROS 2's standard interfaces as Python classes, under their ROS names.

``std_msgs/msg/String`` is `aionode.interfaces.std_msgs.msg.String`.
"""
