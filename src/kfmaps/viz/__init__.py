"""Pictures of surfaces and maps with matplotlib alone: no display and no graphics system is needed."""

from kfmaps.viz.camera import View as View
from kfmaps.viz.camera import automatic_view as automatic_view
from kfmaps.viz.camera import following_view as following_view
from kfmaps.viz.camera import true_views as true_views
from kfmaps.viz.camera import view_from as view_from
from kfmaps.viz.curves import Curve as Curve
from kfmaps.viz.curves import curves_figure as curves_figure
from kfmaps.viz.curves import mean_curve as mean_curve
from kfmaps.viz.figures import ERROR_MAP as ERROR_MAP
from kfmaps.viz.figures import error_colors as error_colors
from kfmaps.viz.figures import error_limit as error_limit
from kfmaps.viz.figures import picture_format as picture_format
from kfmaps.viz.figures import position_colors as position_colors
from kfmaps.viz.figures import save_figure as save_figure
from kfmaps.viz.matches import Panel as Panel
from kfmaps.viz.matches import grid_figure as grid_figure
from kfmaps.viz.matches import match_figure as match_figure
from kfmaps.viz.matches import painted_errors as painted_errors
from kfmaps.viz.surfaces import draw_surface as draw_surface
