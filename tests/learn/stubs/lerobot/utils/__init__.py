"""Names that all of LeRobot uses."""

__all__: list[str] = []
