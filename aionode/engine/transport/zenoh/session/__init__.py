"""Sessions of Zenoh: how they open, find one another, and close."""
