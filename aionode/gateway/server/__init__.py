"""The web server, and the door that each request passes first."""
