"""The explorer: an atlas in the browser. It draws and asks; every number is the atlas', a query's or a solver's.

``measures`` says what can be shown, ``desk`` answers what the page asks, ``wire`` packs it, ``exact`` and ``polish`` call
the solver, ``compiling`` hears of the compiler, ``table`` makes the smaller table of a page without a server, ``figures``
holds the Bokeh figures, ``page`` puts one HTML file together (from the scripts under ``page/``), ``server`` serves it to
this machine alone, ``notebook`` is ``fs.explore``.
"""
