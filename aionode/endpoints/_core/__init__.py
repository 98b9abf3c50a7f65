"""What all endpoints are built from: queue, callback runner, graph entry."""
