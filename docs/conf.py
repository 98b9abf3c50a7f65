"""How Sphinx builds these pages: ``make docs``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

sys.path.insert(0, str(Path(__file__).parent.parent))
import aionode
from docs.contents import without_contents

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "aionode"
author = "The aionode authors"
project_copyright = "2026, The aionode authors"
release = aionode.__version__
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


def setup(app: Sphinx) -> None:
    """Leave out the lists for those who read the files."""
    app.connect("source-read", leave_out_contents)


def leave_out_contents(_app: Sphinx, _page: str, source: list[str]) -> None:
    """Change the text of one page before it is parsed."""
    source[0] = without_contents(source[0])
