"""What `aionode.Node` is made of."""
