"""Virtual sensors: depth cameras, phones and camera paths."""
