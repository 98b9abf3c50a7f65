"""Ways for messages to travel, under their public names."""
