"""The file formats of bags, and what they have in common."""
