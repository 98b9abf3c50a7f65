"""HTTP for curl and programs."""
