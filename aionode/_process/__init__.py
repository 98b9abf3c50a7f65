"""What belongs to the whole process: signals, standard streams, concurrency, its end."""
