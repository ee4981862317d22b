"""Occupancy networks in PyTorch: data, models, losses, training, evaluation and ONNX export.

All modules need ``pip install 'world2minecraft[train]'``. Trained networks are exported as ONNX,
which the commands ``occupy`` and ``label`` run without PyTorch.
"""
