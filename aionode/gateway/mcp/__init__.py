"""An assistant for the robot: tools of the Model Context Protocol, bounded by the policy."""
