"""Pictures of surfaces and maps with matplotlib alone: no display and no graphics system is needed."""

from kfmaps.viz.camera import View, automatic_view, following_view, true_views, view_from
from kfmaps.viz.curves import Curve, curves_figure, mean_curve
from kfmaps.viz.figures import ERROR_MAP, error_colors, error_limit, picture_format, position_colors, save_figure
from kfmaps.viz.matches import Panel, grid_figure, match_figure, painted_errors
from kfmaps.viz.surfaces import draw_surface

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
    "view_from",
]
