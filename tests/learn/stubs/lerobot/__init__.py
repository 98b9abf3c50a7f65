"""What a plugin uses of LeRobot 0.6, with its signatures: it is 8 GB and wants Python 3.12."""

__all__: list[str] = []
