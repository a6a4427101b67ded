"""Surfaces of the human brain: ``python benchmarks/brains.py --data DIR``.

DIR has the GIFTI files of two atlases: `fsaverage5` (10,242 vertices a side; white, pial and inflated surfaces, as the
package nilearn brings them) and `conte69_32k` (32,492 vertices, as brainspace does). Nothing was chosen on them but
:attr:`kfmaps.matching.score.Scoring.isometry_factor`, on the first pair of sides. Vertices of the target are in random
order and turned at random.

Surfaces of one side of fsaverage5, and both sides of conte69, have the same numbering: errors are mean geodesic
distances × 100. Between others the distance in space is printed, in millimetres, of the two atlases as they lie,
centred and with one side mirrored where the sides differ. It includes how far the atlases differ.
"""

from __future__ import annotations

import argparse
import base64
import gzip
import time
import zlib
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from scipy.spatial.transform import Rotation

import kfmaps

PAIRS = (
    ("conte69_32k_lh", "conte69_32k_rh"),
    ("pial_left", "pial_right"),
    ("white_left", "white_right"),
    ("white_left", "pial_left"),
    ("white_right", "pial_right"),
    ("conte69_32k_lh", "white_left"),
    ("white_right", "conte69_32k_rh"),
    ("conte69_32k_lh", "pial_right"),
    ("pial_left", "infl_left"),
    ("white_right", "infl_right"),
)


def read_gifti(folder: Path, name: str) -> kfmaps.Mesh:
    """The surface of ``name.gii`` or ``name.gii.gz``."""
    path = next(path for path in folder.rglob(f"{name}.gii*"))
    content = path.read_bytes()
    arrays = {}
    for one in ElementTree.fromstring(gzip.decompress(content) if path.suffix == ".gz" else content).iter("DataArray"):
        kind = {"NIFTI_TYPE_FLOAT32": np.float32, "NIFTI_TYPE_INT32": np.int32}[one.attrib["DataType"]]
        text = one.findtext("Data", "")
        if one.attrib["Encoding"] == "ASCII":
            values = np.array(text.split(), dtype=kind)
        else:
            values = np.frombuffer(zlib.decompress(base64.b64decode(text)), dtype=kind)
        arrays[one.attrib["Intent"]] = values.reshape(-1, 3)
    return kfmaps.Mesh(arrays["NIFTI_INTENT_POINTSET"].astype(float), arrays["NIFTI_INTENT_TRIANGLE"].astype(np.int64))


def is_left(name: str) -> bool:
    return name.endswith(("left", "lh"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    folder = parser.parse_args().data
    print(f"{'source':16} {'target':16} difference            orientation  verdict             CPU s")
    for a, b in PAIRS:
        rng = np.random.default_rng([*a.encode(), *b.encode()])
        source, fixed = read_gifti(folder, a), read_gifti(folder, b)
        order = rng.permutation(len(fixed.vertices))
        turned = fixed.vertices[order] @ Rotation.random(rng=rng).as_matrix().T
        target = kfmaps.Mesh(turned, np.argsort(order)[fixed.faces])
        start = time.process_time()
        found = kfmaps.match(source, target, kfmaps.Config(threads=1))
        seconds = time.process_time() - start
        if len(source.vertices) == len(target.vertices) and ("conte" in a or is_left(a) == is_left(b)):
            error = kfmaps.geodesic_errors(source, found.target_to_source, order).mean()
            off = f"{100 * error:.2f} % of √area"
        else:
            places, own = source.vertices, fixed.vertices[order] * [1 if is_left(a) == is_left(b) else -1, 1, 1]
            apart = (places - places.mean(axis=0))[found.target_to_source] - (own - own.mean(axis=0))
            off = f"{np.median(np.linalg.norm(apart, axis=1)):.1f} mm in the median"
        told = f"{found.verdict}, {found.confidence:.3f}"
        print(f"{a:16} {b:16} {off:21} {found.orientation:12} {told:18} {seconds:6.1f}", flush=True)


if __name__ == "__main__":
    main()
