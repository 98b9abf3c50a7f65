"""Interfaces of ublox_msgs: messages of the receivers of u-blox."""
