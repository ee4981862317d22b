"""Scores: pure functions over grids, objects and boxes; sums add up over scenes.

``occupancy`` scores labelled cells as SSCMetrics does, ``surface`` two sets of cells with a
tolerance, ``objects`` found objects, ``layout`` physical sense, and ``truth`` carries a fine truth
into the frame and the cells in which a reconstruction is scored.
"""
