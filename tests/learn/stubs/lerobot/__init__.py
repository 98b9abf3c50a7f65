"""The parts of LeRobot 0.6 that a plugin uses; the real one is 8 GB and needs Python 3.12."""

__all__: list[str] = []
