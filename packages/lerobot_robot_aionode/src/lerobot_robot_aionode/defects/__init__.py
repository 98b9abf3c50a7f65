"""LeRobot defects that the plugin works around, one module for each.

Each docstring says what LeRobot does, in which version and lines, and where it was reported.
`tests/learn/lerobot_defects.py` has a function of the same name for each module, which needs
nothing but LeRobot, and fails once LeRobot no longer has the defect: ``make lerobot``. Then the
workaround can go.
"""
