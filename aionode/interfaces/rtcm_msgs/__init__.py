"""Interfaces of rtcm_msgs: corrections for receivers of GNSS, as RTCM."""
