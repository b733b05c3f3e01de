"""The census: random designs over the whole domain, every one solved or explained, and the error bounds audited.

Designs are drawn in blocks, each from its own seed, so that a larger census begins with the designs of a smaller one and
no number depends on the threads. A sample is solved again on a mesh four times finer, to an accuracy a hundred times
better, and the difference held against the bounds.
"""
