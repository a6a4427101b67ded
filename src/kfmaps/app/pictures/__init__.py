"""Pictures of surfaces and maps with matplotlib alone: no display and no graphics system is needed."""

from kfmaps.app.pictures.camera import View, automatic_view, following_view, view
from kfmaps.app.pictures.colors import ERROR_MAP, error_colors, error_limit, position_colors
from kfmaps.app.pictures.curves import Curve, curves_figure, mean_curve
from kfmaps.app.pictures.errors import painted_errors, true_views
from kfmaps.app.pictures.grids import Panel, grid_figure
from kfmaps.app.pictures.matches import match_figure, picture_format, save_figure
from kfmaps.app.pictures.surfaces import draw_surface

__all__ = [
    "ERROR_MAP",
    "Curve",
    "Panel",
    "View",
    "automatic_view",
    "curves_figure",
    "draw_surface",
    "error_colors",
    "error_limit",
    "following_view",
    "grid_figure",
    "match_figure",
    "mean_curve",
    "painted_errors",
    "picture_format",
    "position_colors",
    "save_figure",
    "true_views",
    "view",
]
