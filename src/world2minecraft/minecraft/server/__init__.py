"""Building of volumes on a running server through the RCON protocol."""
