"""Files: meshes, landmarks, maps, per-vertex values and exports, each read strictly and written whole."""

from kfmaps.io.atomic import atomic_output, check_output, remove_unfinished
from kfmaps.io.bake import projected_uv
from kfmaps.io.export import grid_picture, write_colored, write_textured
from kfmaps.io.index_files import (
    read_landmark_names,
    read_landmarks,
    read_vertex_numbers,
    write_landmarks,
    write_vertex_numbers,
)
from kfmaps.io.mapcontent import check_map
from kfmaps.io.mapfile import load_map, save_map
from kfmaps.io.meshes import read_mesh, read_mesh_file, write_mesh
from kfmaps.io.record import MeshFile
from kfmaps.io.text import read_text
from kfmaps.io.transfer import transfer
from kfmaps.io.vertex_data import Values, read_values, write_values

__all__ = [
    "MeshFile",
    "Values",
    "atomic_output",
    "check_map",
    "check_output",
    "grid_picture",
    "load_map",
    "projected_uv",
    "read_landmark_names",
    "read_landmarks",
    "read_mesh",
    "read_mesh_file",
    "read_text",
    "read_values",
    "read_vertex_numbers",
    "remove_unfinished",
    "save_map",
    "transfer",
    "write_colored",
    "write_landmarks",
    "write_mesh",
    "write_textured",
    "write_values",
    "write_vertex_numbers",
]
