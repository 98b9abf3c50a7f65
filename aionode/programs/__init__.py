"""Small programs from ROS's own packages that launch files use, as aionode nodes.

`aionode._packages` finds them under the names of ROS's package and executable, if neither the
workspace nor a sourced ROS 2 has that package. Each module is one program, with the parameters,
topics, arguments and messages of the original.
"""

__all__: list[str] = []
