"""Geometry of points, masks and images: planes, boxes, morphology, colour and rotations."""
