"""The lidars of YDLIDAR on a serial port."""
