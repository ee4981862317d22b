"""What phone apps with LiDAR or AR tracking export: one file per app, and what they share."""
