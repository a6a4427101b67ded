"""Save Matplotlib figures of gallery examples that were made without pyplot.

The package's figures are plain ``Figure`` objects, which pyplot and sphinx-gallery do not see.
"""

from __future__ import annotations

from typing import Any

from matplotlib import pyplot
from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst


def scrape(_block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any], **_: Any) -> str:
    """Save the figures that an example made since its last block."""
    names = block_vars["example_globals"]
    shown = names.setdefault("__shown__", set())
    of_pyplot = {id(pyplot.figure(number)) for number in pyplot.get_fignums()}
    paths = []
    for value in [v for v in names.values() if isinstance(v, Figure)]:
        if id(value) in shown | of_pyplot:
            continue
        shown.add(id(value))
        path = next(block_vars["image_path_iterator"])
        value.savefig(path, dpi=130)
        paths.append(path)
    shown |= of_pyplot
    return figure_rst(paths, gallery_conf["src_dir"])


def _get_sg_image_scraper() -> Any:
    return scrape
