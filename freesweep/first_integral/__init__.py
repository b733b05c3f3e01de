"""A second, independent method for tubes that are the same all along: the first integral, by quadrature.

Nothing here is shared with the finite-difference solver: no mesh, no Newton system, no line of its physics; NumPy only. It
checks atlases (``freesweep verify --resolve``) and never fills one.
"""
