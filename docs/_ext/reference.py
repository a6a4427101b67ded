"""Adapt Sphinx to the docstrings of this package."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.nodes import make_refnode

import kfmaps

ALIAS = re.compile(r"TypeAliasForwardRef\('(\w+)'\)")
SEVERAL = re.compile(r"^(\w+(?:, \w+)+) : (.*)$")


def separate(_app: Sphinx, _what: str, _name: str, _obj: Any, _options: Any, lines: list[str]) -> None:
    """Split attributes "a, b : type" into one entry each, as napoleon does for parameters."""
    result: list[str] = []
    i = 0
    while i < len(lines):
        found = SEVERAL.match(lines[i])
        end = i + 1
        if found:
            while end < len(lines) and lines[end].startswith("    "):
                end += 1
            names, kinds = found[1].split(", "), found[2]
            shapes = re.findall(r"\(.*?\)", kinds)
            for j, name in enumerate(names):
                own = kinds
                if len(shapes) == len(names):  # "(n,), (m,) float64": a shape for each
                    own = f"{shapes[j]} {kinds[kinds.rindex(')') + 1 :].strip()}".strip()
                result += [f"{name} : {own}", *(lines[i + 1 : end] if j == 0 else ())]
        else:
            result.append(lines[i])
        i = end
    lines[:] = result


def readable(
    _app: Sphinx, _what: str, _name: str, _obj: Any, _options: Any, signature: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """Replace default factories in signatures by ``...``, which can be parsed, and show aliases by their names."""
    parts = [ALIAS.sub(r"\1", part) if part else part for part in (signature, returned)]
    return (parts[0].replace("<factory>", "...") if parts[0] else parts[0]), parts[1]


def skipped(_app: Sphinx, what: str, name: str, obj: Any, skip: bool, _options: Any) -> bool | None:
    """Leave constants out of modules, and names that the reference has as ``kfmaps.NAME``."""
    if what == "module" and (getattr(kfmaps, name, None) is obj or not callable(obj)):
        return True
    return skip or None


def by_last_name(app: Sphinx, env: BuildEnvironment, node: pending_xref, content: nodes.Node) -> nodes.Node | None:
    """Resolve bare names in docstrings that belong to another documented module."""
    if node.get("refdomain") != "py" or not node.get("reftarget"):
        return None
    domain = env.domains.python_domain
    matches = domain.find_obj(env, "", "", node["reftarget"], None, 1)
    places = {(entry.docname, entry.node_id) for _, entry in matches}
    if len(places) != 1:
        return None
    docname, anchor = places.pop()
    return make_refnode(app.builder, node["refdoc"], docname, anchor, content, matches[0][0])


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", separate, priority=400)  # before napoleon
    app.connect("autodoc-process-signature", readable)
    app.connect("autodoc-skip-member", skipped)
    app.connect("missing-reference", by_last_name)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
