"""Publishers, subscriptions, servers and clients over Zenoh."""
