"""Geometry on points, masks and pictures: planes, boxes, morphology, colour, rotations."""
