"""The parts of which all endpoints are built: queue, callback runner, graph entry."""
