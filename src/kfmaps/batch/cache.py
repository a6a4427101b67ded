"""Prepared shapes on disk, found again by the content of the mesh and by the settings that matter."""

from __future__ import annotations

import hashlib
from contextlib import suppress
from pathlib import Path

import numpy as np

import kfmaps
from kfmaps._arrays import InvalidInput
from kfmaps.batch.settings import digest_of
from kfmaps.config import Config
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import atomic_output
from kfmaps.io.gltf import buffer_files
from kfmaps.io.text import read_bytes
from kfmaps.shape import Shape

LAYOUT = 2
"""Raised when what an entry holds changes."""


def file_digest(path: str | Path) -> str:
    """32 hexadecimal digits that stand for the content of a file, and of those that a .gltf keeps its numbers in."""
    with open(path, "rb") as file:
        digest = hashlib.file_digest(file, "sha256")
    if Path(path).suffix.lower() == ".gltf":
        with suppress(InvalidInput):  # what cannot be read is told when its shape is prepared
            for beside in buffer_files(read_bytes(path), str(path)):
                digest.update(hashlib.sha256(read_bytes(beside)).digest())
    return digest.hexdigest()[:32]


def shape_key(content: str, suffix: str, config: Config) -> str:
    """The name of an entry: ``content`` (digest of the mesh's file) with all settings that preparing depends on.

    ``suffix`` is the file's extension, which decides how its content is read.
    """
    return digest_of(
        {
            "layout": LAYOUT,
            "version": kfmaps.__version__,
            "content": content,
            "suffix": suffix.lower(),
            "laplacian": config.basis.laplacian,
            "eigenfunctions": config.eigenfunctions,
            "shot": config.descriptors.shot_radius if config.descriptors.shot else None,
        },
        digits=32,
    )


def save_shape(path: Path, shape: Shape) -> None:
    """Write a prepared shape, whole or not at all; an entry that is there is replaced by its equal."""
    arrays = {
        "vertices": shape.mesh.vertices,
        "faces": shape.mesh.faces,
        "eigenvalues": shape.basis.eigenvalues,
        "functions": shape.basis.functions,
        "mass": shape.basis.mass,
        "stages": np.array(list(shape.seconds)),
        "seconds": np.array(list(shape.seconds.values()), dtype=np.float64),
        "laplacian": np.array(shape.laplacian),
    }
    if shape.extent is not None:
        arrays["extent"] = np.float64(shape.extent)
    if shape.shot is not None:
        arrays |= {"shot": shape.shot, "shot_radius": np.float64(shape.shot_radius)}
    with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
        np.savez(file, allow_pickle=False, **arrays)


def load_shape(path: Path, name: str) -> Shape | None:
    """Read a prepared shape; ``None`` when there is none or the entry is damaged, so that it is made again."""
    try:
        with open(path, "rb") as file, np.load(file, allow_pickle=False) as arrays:
            seconds = dict(zip(arrays["stages"].tolist(), arrays["seconds"].tolist(), strict=True))
            return Shape(
                Mesh(arrays["vertices"], arrays["faces"]),
                Basis(arrays["eigenvalues"], arrays["functions"], arrays["mass"]),
                arrays["shot"] if "shot" in arrays.files else None,
                name,
                seconds,
                str(arrays["laplacian"]),
                float(arrays["shot_radius"]) if "shot" in arrays.files else None,
                float(arrays["extent"]) if "extent" in arrays.files else None,
            )
    except FileNotFoundError:
        return None
    except Exception:  # NumPy reports a damaged file by whatever it runs into
        return None
