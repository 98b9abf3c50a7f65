"""What other contexts have announced over Zenoh."""
