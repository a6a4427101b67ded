"""Self-contained HTML documents: bundled script and style, data as JSON, and a policy that allows nothing else."""

from __future__ import annotations

import base64
import hashlib
import json
import math
from collections.abc import Mapping
from importlib.resources import files
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from kfmaps._records import JsonObject

_UNSIGNED = (("uint8", "<u1"), ("uint16", "<u2"), ("uint32", "<u4"))


def _record(array: np.ndarray, name: str, code: str) -> JsonObject:
    raw = np.ascontiguousarray(array, dtype=code).tobytes()
    return {"type": name, "shape": list(array.shape), "base64": base64.b64encode(raw).decode("ascii")}


def encode_integers(numbers: np.ndarray) -> JsonObject:
    """Encode whole numbers from 0 on with one, two or four bytes each, as few as hold all of them."""
    numbers = np.asarray(numbers)
    largest = int(numbers.max(initial=0))
    name, code = next((n, c) for n, c in _UNSIGNED if largest <= np.iinfo(c).max)
    return _record(numbers, name, code)


def encode_floats(values: np.ndarray) -> JsonObject:
    """Encode real numbers as two-byte steps from the least to the greatest, with an error of 1/131068 of that range.

    NaN and infinities become one reserved code, which the page reads as "not known".
    """
    values = np.asarray(values, dtype=np.float64)
    is_finite = np.isfinite(values)
    low = float(values[is_finite].min(initial=np.inf)) if is_finite.any() else 0.0
    high = float(values[is_finite].max(initial=-np.inf)) if is_finite.any() else 0.0
    step = (high - low) / 65534 or 1.0
    codes = np.full(values.shape, 65535, dtype=np.uint16)
    codes[is_finite] = np.rint((values[is_finite] - low) / step).astype(np.uint16)
    return {**_record(codes, "uint16", "<u2"), "low": low, "step": step}


def to_json(value: object) -> Any:
    """Return ``value`` as types that JSON has.

    NaN and infinities become the strings ``"nan"``, ``"inf"`` and ``"-inf"``, and unknown objects their ``str``.
    """
    if isinstance(value, Mapping):
        return {str(k): to_json(v) for k, v in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return to_json(value.tolist())
    if isinstance(value, list | tuple | set | frozenset):
        return [to_json(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)


def _json_block(data: object) -> str:
    """Return JSON that is safe between ``<script>`` tags: no ``<``, ``>`` or ``&`` is left in it.

    So a mesh called ``</script><script>`` is only a name: these characters occur only inside JSON strings, where their
    escaped form means the same.
    """
    text = json.dumps(to_json(data), ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def data_address(kind: str, content: bytes) -> str:
    """Return a picture as a data address; ``kind``: its media type."""
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"


def environment(package: str) -> Environment:
    """Return the templates of a package's ``templates`` folder; they escape their values."""
    return Environment(loader=PackageLoader(package), autoescape=True, undefined=StrictUndefined, trim_blocks=True)


def asset(name: str) -> str:
    """Return the text of a file of the package's ``static`` folder."""
    return files("kfmaps.viz").joinpath("static", name).read_text(encoding="utf-8")


def _hash(text: str) -> str:
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii") + "'"


def policy(script: str, style: str, *, connect: bool) -> str:
    """Return the content security policy: this script, this style, images made in the page, and nothing else.

    ``connect``: whether the page may also send requests to its own server.
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


def document(template: str, *, title: str, data: object, connect: bool = False) -> str:
    """Return a whole page.

    ``template``: name of the template with the page's body; ``title``: any text; ``data``: of the script, converted by
    :func:`to_json`; ``connect``: whether the page may send requests to its own server.
    """
    script, style = asset("viewer.js"), asset("viewer.css")
    return _TEMPLATES.get_template(template).render(
        policy=policy(script, style, connect=connect),
        title=title,
        style=Markup(style),
        script=Markup(script),
        data=Markup(_json_block(data)),
    )


def forwarding_page(address: str) -> str:
    """Return a page that leads to ``address`` at once.

    Every user of the machine can see the browser's command line. Opening this page from a file that only its owner can
    read keeps the address out of it.
    """
    return _TEMPLATES.get_template("forward.html.j2").render(address=address)


_TEMPLATES = environment("kfmaps.viz")
