"""Metrics as pure functions over grids, objects and boxes, with counts that can be summed.

``occupancy`` computes the scores of SSCMetrics for labelled cells, ``surface_scores`` compares two
sets of cells with a tolerance, ``objects`` scores detected objects, and ``truth_resampling``
transforms a fine ground truth into the frame and grid of a reconstruction.
"""
