"""Branches of tubes that are the same all along, in two numbers."""
