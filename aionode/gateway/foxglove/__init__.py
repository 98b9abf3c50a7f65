"""The protocol of the Foxglove app."""
