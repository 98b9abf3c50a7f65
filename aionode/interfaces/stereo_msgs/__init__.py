"""stereo_msgs."""
