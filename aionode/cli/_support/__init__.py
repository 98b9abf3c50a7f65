"""What verbs and commands share."""
