"""Buckled tubes that are the same all along, as a swollen wave and a thinned one of one level."""
