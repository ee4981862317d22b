"""Occupancy networks in PyTorch: what they see, what they say, how they are trained and exported.

Everything here needs ``pip install 'world2minecraft[train]'``. What is trained leaves as ONNX,
which ``occupy`` and ``label`` run without torch.
"""
