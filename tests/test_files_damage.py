"""Files cut short and files damaged: refused, or read for what they still say."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from conftest import fibonacci_sphere
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import MeshFile, read_mesh
from kfmaps.io.meshes import READERS
from kfmaps.io.obj import format_obj
from kfmaps.io.off import format_off
from kfmaps.io.ply import format_ply

MESH = fibonacci_sphere(20)
HEADER = "ply\nformat {}\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
HEADER += "element face {}\nproperty list uchar int vertex_indices\nend_header\n"
OFF_LINES = format_off(MeshFile(MESH)).split(b"\n", 2)[2]
CONTENTS = {
    ".off": format_off(MeshFile(MESH)),
    ".obj": format_obj(MeshFile(MESH)),
    ".ply": format_ply(MeshFile(MESH)),
    ".text.ply": HEADER.format("ascii 1.0", len(MESH.vertices), len(MESH.faces)).encode() + OFF_LINES,
}


def mesh_or_none(path: Path, cloud: bool = True) -> Mesh | None:
    """The mesh, or None when the file is refused in one line."""
    try:
        with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
            return read_mesh(path, cloud=cloud)
    except InvalidInput as error:
        if "\n" in str(error):
            raise
        return None


def cuts(content: bytes) -> Iterator[int]:
    """Every position in the first and last 200 bytes and many in between, the whole file excluded."""
    near = {*range(1, 200), *range(len(content) - 200, len(content)), *range(1, len(content), 37)}
    yield from sorted(i for i in near if 0 < i < len(content))


@pytest.mark.parametrize("suffix", CONTENTS)
def test_cut_anywhere(tmp_path: Path, suffix: str) -> None:
    """Refused, or the last number is only shorter; an OBJ file, which counts nothing, may lack whole faces."""
    content, path = CONTENTS[suffix], tmp_path / f"a{suffix}"
    last = len(content.rstrip()) - len(content.split()[-1])
    first_face = content.find(b"\nf ")
    for cut in cuts(content):
        path.write_bytes(content[:cut])
        mesh = mesh_or_none(path, cloud=False)
        if mesh is None:
            assert suffix == ".ply" or cut < len(content.rstrip()), cut
            continue
        assert suffix != ".ply", "a binary file cut anywhere is refused"
        assert suffix == ".obj" or cut > last, cut
        assert suffix != ".obj" or cut > first_face
        np.testing.assert_array_equal(mesh.vertices, MESH.vertices)
        whole = len(mesh.faces) - 1
        np.testing.assert_array_equal(mesh.faces[:whole], MESH.faces[:whole])
        np.testing.assert_array_equal(mesh.faces[whole, :2], MESH.faces[whole, :2])


HEADS = {
    ".off": b"OFF 3 1 0\n",
    ".obj": b"v ",
    ".ply": HEADER.format("binary_little_endian 1.0", 3, 1).encode(),
    ".glb": b"glTF\2\0\0\0",
    ".stl": b"solid ",
}


def check_sound(mesh: Mesh | None) -> None:
    if mesh is not None:
        assert np.isfinite(mesh.vertices).all()
        assert mesh.faces.size == 0 or (mesh.faces.min() >= 0 and mesh.faces.max() < len(mesh.vertices))


@given(st.sampled_from(sorted(READERS)), st.binary(max_size=300), st.booleans())
@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_garbage(tmp_path: Path, suffix: str, content: bytes, headed: bool) -> None:
    path = tmp_path / f"a{suffix}"
    path.write_bytes(HEADS.get(suffix, b"") + content if headed else content)
    check_sound(mesh_or_none(path))


@given(st.data())
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_damage(tmp_path: Path, data: st.DataObject) -> None:
    suffix = data.draw(st.sampled_from(sorted(CONTENTS)))
    content = bytearray(CONTENTS[suffix])
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at : at + data.draw(st.integers(0, 4))] = data.draw(
            st.one_of(st.binary(max_size=4), st.sampled_from([b"\n", b"-", b"/", b" nan ", b"1e308 ", b"99999999999"]))
        )
    path = tmp_path / f"a{suffix}"
    path.write_bytes(bytes(content))
    check_sound(mesh_or_none(path))
