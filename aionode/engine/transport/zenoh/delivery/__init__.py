"""Message delivery between contexts: limits, acknowledgements, histories, cancellations."""
