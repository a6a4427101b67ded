"""Self-contained HTML documents: bundled script and style, data, and a policy that allows no more."""

from __future__ import annotations

import base64
import hashlib
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from kfmaps.viz.encode import json_block


def environment(package: str) -> Environment:
    """Return the templates of a package's ``templates`` folder; whatever is put into them is escaped."""
    return Environment(loader=PackageLoader(package), autoescape=True, undefined=StrictUndefined, trim_blocks=True)


def asset(name: str) -> str:
    """Return the text of a file of the package's ``static`` folder."""
    return files("kfmaps.viz").joinpath("static", name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii") + "'"


def policy(script: str, style: str, *, connect: bool) -> str:
    """Return the content security policy: this script, this style, images made in the page, and nothing else.

    With ``connect`` the page may also speak to the server it came from.
    """
    return "; ".join(
        [
            "default-src 'none'",
            f"script-src {_hash(script)}",
            f"style-src {_hash(style)}",
            "img-src blob: data:",
            "connect-src 'self'" if connect else "connect-src 'none'",
            "base-uri 'none'",
            "form-action 'none'",
        ]
    )


def document(template: str, *, title: str, data: Any, connect: bool = False) -> str:
    """Return a whole page.

    Parameters
    ----------
    template : str
        Name of the template with the page's body.
    title : str
        Any text; it is escaped.
    data : mapping
        What :func:`kfmaps.viz.encode.to_json` can turn into JSON; the script reads it as data only.
    connect : bool
        Whether the page may send requests to its own server. A page for the disk may send none at all.
    """
    script, style = asset("viewer.js"), asset("viewer.css")
    return _TEMPLATES.get_template(template).render(
        policy=policy(script, style, connect=connect),
        title=title,
        style=Markup(style),
        script=Markup(script),
        data=Markup(json_block(data)),
    )


def forwarding_page(address: str) -> str:
    """Return a page that leads to ``address`` at once.

    Opened from a file that only its owner can read, it keeps the address out of the browser's command line, which
    every user of the machine can see.
    """
    return _TEMPLATES.get_template("forward.html.j2").render(address=address)


_TEMPLATES = environment("kfmaps.viz")
