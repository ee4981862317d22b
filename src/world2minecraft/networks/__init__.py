"""Occupancy networks in PyTorch: data, models, losses, training, scoring and ONNX export.

Everything here needs ``pip install 'world2minecraft[train]'``. What is trained leaves as ONNX,
which ``occupy`` and ``label`` run without torch.
"""
