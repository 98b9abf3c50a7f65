"""One module for each noun: its commands, with their arguments and options."""
