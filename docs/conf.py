"""The documentation: ``python -m sphinx -W docs docs/_build``, offline; a warning is an error, a dead link a warning."""

import os

import freesweep

os.environ.pop("MPLBACKEND", None)  # notebooks show their plots

project = "freesweep"
author = "The freesweep authors"
copyright = "2026, the freesweep authors"
release = version = freesweep.__version__
extensions = ["myst_nb", "sphinx.ext.autodoc"]
exclude_patterns = ["_build", "packaging"]
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb", ".rst": "restructuredtext"}
myst_heading_anchors = 3
nb_execution_mode = "auto"  # notebooks are kept without outputs
nb_execution_in_temp = True
nb_execution_timeout = 300
nb_execution_raise_on_error = True
suppress_warnings = ["mystnb.unknown_mime_type"]
autodoc_typehints = "none"  # docstrings say it in words, with units
autodoc_member_order = "bysource"
autoclass_content = "class"
html_theme = "alabaster"
html_theme_options = {"description": "Statics of fiber-reinforced soft actuators", "page_width": "1260px"}
html_title = f"freesweep {release}"


def parameters(app, what, name, thing, options, lines):
    """Docstrings list ``name : meaning`` below "Parameters"; here as a list of definitions, prose goes on after it."""
    heads = [k for k, line in enumerate(lines[:-1]) if line == "Parameters" and set(lines[k + 1]) == {"-"}]
    for k in heads[:1]:
        made, rest = ["**Parameters**", ""], lines[k + 2 :]
        while rest and rest[0].strip():
            line = rest.pop(0)
            names, colon, meaning = line.partition(" : ")
            made += [f"``{names}``", f"    {meaning}"] if colon and not line.startswith(" ") else [line]
        lines[k:] = [*made, *rest]


def setup(app):
    """What Sphinx calls."""
    app.connect("autodoc-process-docstring", parameters)
