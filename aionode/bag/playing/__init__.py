"""Plays bags as their messages came."""
