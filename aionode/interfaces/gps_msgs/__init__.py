"""Interfaces of gps_msgs: fixes and satellites of receivers, with all that gpsd knows."""
