"""The building blocks of all endpoints: queue, callback runner, graph entry."""
