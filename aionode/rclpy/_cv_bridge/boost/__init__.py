"""Where cv_bridge has what is compiled."""
