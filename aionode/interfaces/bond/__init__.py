"""Interfaces of bond: two processes that watch whether the other one lives."""
