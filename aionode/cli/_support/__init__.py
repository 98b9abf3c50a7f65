"""Code that verbs and commands share."""
