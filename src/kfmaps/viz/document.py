"""One self-contained HTML document: bundled script and style, data, and a policy that allows no more."""

from __future__ import annotations

import base64
import hashlib
import re
from html import escape
from importlib.resources import files
from typing import Any

from kfmaps.viz.pack import json_block


def asset(name: str) -> str:
    """The text of a file of the package's ``static`` folder."""
    return files("kfmaps.viz").joinpath("static", name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii") + "'"


def policy(script: str, style: str, *, connect: bool) -> str:
    """The content security policy: this script, this style, images made in the page, and nothing else.

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


def document(body: str, *, title: str, data: Any, connect: bool = False) -> str:
    """The whole page.

    Parameters
    ----------
    body : str
        Name of the file of ``static`` with the page's HTML.
    title : str
        Any text; it is escaped.
    data : mapping
        What :func:`kfmaps.viz.pack.plain` can turn into JSON; the script reads it as data only.
    connect : bool
        Whether the page may send requests to its own server. A page for the disk may send none at all.
    """
    script, style = asset("viewer.js"), asset("viewer.css")
    parts = {
        "policy": escape(policy(script, style, connect=connect), quote=True),
        "title": escape(title),
        "style": style,
        "body": asset(body),
        "data": json_block(data),
        "script": script,
    }
    # One pass, so that nothing in a part is read as a placeholder again.
    return re.sub(r"\{\{(\w+)\}\}", lambda match: parts[match[1]], asset("page.html"))
