"""Action servers and clients; their public names are in `aionode.action`."""
