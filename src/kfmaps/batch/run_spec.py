"""The specification of a run: everything besides the shapes that results depend on. An output folder has one."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path

import kfmaps
from kfmaps._arrays import refuse
from kfmaps.config import Config, as_dict
from kfmaps.io.atomic import write_text

FILE = "settings.json"


@dataclass(frozen=True)
class RunSpec:
    """Everything besides the shapes that results depend on."""

    config: Config
    seed: int = 0  # of every pair
    landmark_lines: tuple[int, ...] = ()  # lines of the truth, counted from 1, that serve as landmarks
    landmark_files: bool = True  # whether landmarks of the folder are used
    identity: bool = False  # whether the truth is "vertex i is vertex i"

    def __post_init__(self) -> None:
        if len(set(self.landmark_lines)) < len(self.landmark_lines):
            raise refuse("--landmarks", "each line once", "one twice", "leave it out")

    def as_dict(self) -> dict[str, object]:
        """Return plain values without the number of threads, which does not affect results."""
        config = as_dict(self.config)
        del config["threads"]
        plain = {f.name: getattr(self, f.name) for f in fields(self)}
        return {"version": kfmaps.__version__, **plain, "landmark_lines": list(self.landmark_lines), "config": config}

    @cached_property
    def digest(self) -> str:
        """The digest of these settings, 16 hexadecimal digits."""
        return digest_of(self.as_dict())


def digest_of(values: object, digits: int = 16) -> str:
    """Return the hexadecimal SHA-256 of plain values, cut to ``digits``."""
    text = json.dumps(values, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:digits]


def _flatten(values: object, name: str = "") -> dict[str, object]:
    """Return nested mappings as one mapping with dotted names."""
    if not isinstance(values, Mapping):
        return {name: values}
    flat: dict[str, object] = {}
    for key, value in values.items():
        flat |= _flatten(value, f"{name}.{key}" if name else str(key))
    return flat


def claim(folder: Path, spec: RunSpec) -> None:
    """Write ``spec`` into ``folder``, or check that the folder already has the same one."""
    path = folder / FILE
    now = spec.as_dict()
    if not path.exists():
        write_text(path, json.dumps({"digest": spec.digest, **now}, indent=2) + "\n")
        return
    then = read_run_spec(folder)
    if digest_of({k: v for k, v in then.items() if k != "digest"}) == spec.digest:
        return
    before, after = _flatten(then), _flatten(now)
    changed = [
        f"{name} {before.get(name, 'unset')!r}, now {after.get(name, 'unset')!r}"
        for name in sorted((before.keys() | after.keys()) - {"digest"})
        if before.get(name) != after.get(name)
    ]
    shown = "; ".join(changed[:4]) + (f"; and {len(changed) - 4} more" if len(changed) > 4 else "")
    remedy = "use the same settings, or another output folder"
    raise refuse(f"output {folder}", "the settings it was begun with", f"others ({shown})", remedy)


def read_run_spec(folder: Path) -> dict[str, object]:
    """Return the settings of an output folder, as plain values with their ``digest``."""
    path = folder / FILE
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise refuse(f"{folder}", "an output folder of kfmaps batch", f"no {FILE} in it", "check the path") from error
    except (OSError, ValueError, RecursionError) as error:
        raise refuse(f"{path}", "the settings of a run", str(error), "remove it to begin again") from error
    if not isinstance(values, dict) or "digest" not in values:
        raise refuse(f"{path}", "the settings of a run", "other content", "remove it to begin again")
    return values
