"""Files: meshes, landmarks, maps, per-vertex values and exports, each read strictly and written whole."""

from kfmaps.io.atomic import atomic_output as atomic_output
from kfmaps.io.atomic import check_output as check_output
from kfmaps.io.atomic import remove_unfinished as remove_unfinished
from kfmaps.io.bake import projected_uv as projected_uv
from kfmaps.io.export import grid_picture as grid_picture
from kfmaps.io.export import write_colored as write_colored
from kfmaps.io.export import write_textured as write_textured
from kfmaps.io.index_files import read_landmark_names as read_landmark_names
from kfmaps.io.index_files import read_landmarks as read_landmarks
from kfmaps.io.index_files import read_vertex_numbers as read_vertex_numbers
from kfmaps.io.index_files import write_landmarks as write_landmarks
from kfmaps.io.index_files import write_vertex_numbers as write_vertex_numbers
from kfmaps.io.mapcontent import check_map as check_map
from kfmaps.io.mapfile import load_map as load_map
from kfmaps.io.mapfile import save_map as save_map
from kfmaps.io.meshes import read_mesh as read_mesh
from kfmaps.io.meshes import read_mesh_file as read_mesh_file
from kfmaps.io.meshes import write_mesh as write_mesh
from kfmaps.io.record import MeshFile as MeshFile
from kfmaps.io.text import read_text as read_text
from kfmaps.io.transfer import transfer as transfer
from kfmaps.io.vertex_data import Values as Values
from kfmaps.io.vertex_data import read_values as read_values
from kfmaps.io.vertex_data import write_values as write_values
