"""Paths, poses, rectangles and angles: plane geometry as kernels and the types round them."""
