"""The protocol of rosbridge, with the services of rosapi."""
