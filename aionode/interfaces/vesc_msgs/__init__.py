"""Interfaces of vesc_msgs: what a VESC, the motor controller of F1TENTH's cars, measures."""
