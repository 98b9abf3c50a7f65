"""AMCL: where a robot is on a map, by a cloud of particles that laser scans judge."""
