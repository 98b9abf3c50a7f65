"""Ways for messages to travel: `base` is the contract, each other module one implementation."""
