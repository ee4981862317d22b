"""MinecraftOcc: labelled images rendered from block worlds, with import and export."""
