"""ROS 2's demos of quality of service: `deadline`, `lifespan`, `liveliness`, incompatible profiles.

Each module is a program: ``python -m aionode.examples.quality_of_service.deadline``.
"""
