"""The lidars of Hokuyo, by the protocol SCIP 2.0."""
