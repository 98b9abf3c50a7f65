"""Interfaces of audio_common_msgs: sound, as samples and as a compressed stream."""
