"""Inverse design: from what a tube shall do to the tubes that do it.

``wishes`` reads goals and limits, ``freedom`` what may change, a ``space`` of designs; ``predict`` says what designs do,
many at a time; ``look`` searches widely and tells basins apart, ``polish`` and ``least`` go down into them; ``candidates``
puts what was found into a Dataset. :func:`freesweep.design` is in ``designing``.
"""
