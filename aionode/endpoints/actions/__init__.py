"""Action servers and clients; the public names are in `aionode.action`."""
