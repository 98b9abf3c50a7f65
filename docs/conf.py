"""How Sphinx builds these pages: ``make docs``."""

from __future__ import annotations

from importlib import metadata

project = "aionode"
author = "The aionode authors"
project_copyright = "2026, The aionode authors"
release = metadata.version("aionode")
version = release

extensions = [
    "myst_parser",  # pages in Markdown
    "sphinx.ext.autodoc",  # the reference, from docstrings
    "sphinx.ext.napoleon",  # … which have Google's form
    "sphinx_click",  # the command line, from its help
]
source_suffix = {".md": "markdown"}
root_doc = "index"
exclude_patterns = ["site"]

html_theme = "furo"
html_title = "aionode"
html_show_sphinx = False
html_copy_source = False

myst_heading_anchors = 3

default_role = "code"
add_module_names = False
autodoc_member_order = "bysource"
autodoc_class_signature = "mixed"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autodoc_default_options = {"members": True}
napoleon_google_docstring = True
napoleon_numpy_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
