"""Sphinx configuration of the manual.

`make docs` builds it into docs/_build/html. Neither the build nor the pages need a network.
"""

import sys
from importlib.util import find_spec
from pathlib import Path

import kfmaps

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

highlight_language = "text"  # commands, unless a block says that it is Python

project = "kfmaps"
author = "The kfmaps developers"
copyright = "The kfmaps developers"
version = release = kfmaps.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx_gallery.gen_gallery",
    "reference",
]
exclude_patterns = ["_build", "_ext", "gallery/README.rst"]

myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist"]
myst_heading_anchors = 3

autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_member_order = "bysource"
autodoc_type_aliases = {name: name for name in ("ArrayLike", "LandmarksLike", "MapLike", "ShapeLike", "TruthLike")}
python_maximum_signature_line_length = 90
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False
add_module_names = False

# MathJax comes with a Python package, so that equations need no network: one file, its letters drawn as SVG.
_mathjax = find_spec("sphinx-mathjax-offline")
assert _mathjax is not None, "install the extra 'docs'"
html_static_path = ["_static", str(Path(_mathjax.origin or "").parent / "static" / "mathjax" / "tex-svg.js")]
mathjax_path = "tex-svg.js"

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"plot_",
    "image_scrapers": ("gallery_figures", "matplotlib"),  # the second closes what it has shown
    "capture_repr": (),
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "show_signature": False,
    "download_all_examples": False,
    "plot_gallery": "True",
    "backreferences_dir": None,
    "min_reported_time": 0,
    "show_memory": False,
    "write_computation_times": False,
}

html_theme = "pydata_sphinx_theme"
html_title = "kfmaps"
html_css_files = ["kfmaps.css"]
html_show_sourcelink = False
html_sidebars = {"mathematics": []}  # it has no pages below it
html_theme_options = {
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "header_links_before_dropdown": 6,
    "secondary_sidebar_items": {"**": ["page-toc"], "settings": []},  # its tables are wide
    "footer_start": ["copyright"],
    "footer_end": [],
}
