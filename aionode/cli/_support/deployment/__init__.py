"""What `aionode deploy` ships, and how it gets to a robot.

The scripts beside these modules run on the robot, in this order, each in its own ``ssh`` session.
"""
