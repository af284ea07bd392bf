# SPDX-License-Identifier: BSD-3-Clause
"""Settings of sphinx for the site; scripts/site makes the sources around it."""
import os

project = "libmps"
release = os.environ["MPS_SITE_VERSION"]
copyright = "the authors of libmps, BSD-3-Clause"
extensions = ["myst_parser", "breathe"]
breathe_projects = {"libmps": os.environ["MPS_SITE_XML"]}
breathe_default_project = "libmps"
breathe_domain_by_extension = {"h": "c"}
breathe_show_include = False
breathe_order_parameters_first = True
html_theme = "furo"
html_title = f"libmps {release}"
html_show_sourcelink = False
html_copy_source = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_extra_path = ["extra"]
myst_heading_anchors = 4
pygments_style = "friendly"
# "myst.header": documents begin a table under a third head where a second would be empty
suppress_warnings = ["myst.header"]
