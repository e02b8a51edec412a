"""Plane geometry: paths, poses, rectangles and angles, as kernels and types."""
