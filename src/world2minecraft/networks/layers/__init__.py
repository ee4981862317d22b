"""What the networks are made of: backbones, ways to lift pictures into cells, 3D layers, heads."""
