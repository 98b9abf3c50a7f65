"""The page that comes with the gateway."""
