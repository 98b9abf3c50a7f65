"""The rosbridge protocol, with the services of rosapi."""
