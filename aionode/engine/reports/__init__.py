"""Reports about the graph: nodes of one name, and endpoints that do not match."""
