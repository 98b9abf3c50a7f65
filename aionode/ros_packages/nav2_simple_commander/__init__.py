"""Drive a robot through Nav2 from a program; a workspace's own package of this name comes first."""
