"""AMCL: where a robot is on a map, by a cloud of guesses that laser scans judge."""
