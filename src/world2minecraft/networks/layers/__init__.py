"""Network layers: backbones, projection, attention, 3D blocks, U-Nets and heads."""
