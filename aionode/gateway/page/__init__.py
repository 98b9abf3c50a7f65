"""The gateway's built-in web page."""
