"""One module for each noun: its commands, arguments and options."""
