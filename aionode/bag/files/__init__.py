"""The files of a bag: their formats, and what all of them have."""
