"""Process-wide matters: signals, standard streams, concurrency, shutdown."""
