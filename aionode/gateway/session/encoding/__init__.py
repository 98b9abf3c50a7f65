"""Messages in the forms that clients send and receive: JSON, CBOR, and images as pictures."""
