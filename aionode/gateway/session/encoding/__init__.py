"""Messages as clients send and get them: JSON, CBOR, and images as pictures."""
