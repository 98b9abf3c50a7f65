"""The identities of clients, and the rules for them."""
