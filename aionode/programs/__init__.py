"""Small programs of ROS's own packages that launch files name, as nodes of aionode.

`aionode._packages` has the table by which they are found: under the names of ROS's package and
executable, where neither a workspace nor a ROS 2 that is sourced has that package. Each module is
one program: its parameters, topics, arguments and texts are those of the original.
"""

__all__: list[str] = []
