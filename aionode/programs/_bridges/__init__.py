"""Programs in whose place the gateway serves clients."""
