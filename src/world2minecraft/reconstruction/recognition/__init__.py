"""Recognition in pictures: the built-in segmentation network and its input channels."""
