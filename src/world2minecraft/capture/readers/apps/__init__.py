"""Readers of the exports of phone apps with LiDAR or AR tracking, one module per app."""
