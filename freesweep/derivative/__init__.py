"""Exact derivatives of what is solved with respect to design and load: the solver's physics on dual numbers, one linear
solution for each parameter. NumPy only: nothing is compiled.
"""
