"""The web server, and what each request passes first."""
