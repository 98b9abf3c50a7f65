"""AMCL: estimates where a robot is on a map, with a cloud of particles that laser scans weigh."""
