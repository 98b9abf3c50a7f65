"""What carries messages between contexts: limits, acknowledgements, histories, cancellations."""
