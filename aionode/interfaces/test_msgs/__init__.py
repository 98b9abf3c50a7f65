"""Interfaces of test_msgs: every kind of field, for tests."""
