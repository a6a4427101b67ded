"""Write parts of machines as CAD programs do, for solids.py: ``python benchmarks/solid_parts.py DIR``.

Needs CadQuery (``pip install cadquery==2.8.0``), in an environment of its own if need be. Each of 34 solids is
triangulated coarsely, finely and in between; in DIR/choice the first 18, which numbers were chosen on, in DIR/report
the others.
"""

from __future__ import annotations

import math
import sys
from importlib import import_module
from pathlib import Path
from typing import Any

cadquery: Any = import_module("cadquery")
at = cadquery.Workplane
MESHES = {"coarse": (0.3, 0.4), "fine": (0.03, 0.12), "middle": (0.1, 0.2)}
"""Tolerances of a triangulation: distance, and angle in radians."""


def block(x: float, y: float, z: float, *to: float) -> Any:
    return at("XY").box(x, y, z).translate(to or (0, 0, 0))


def disc(radius: float, height: float, *to: float, plane: str = "XY") -> Any:
    return at(plane, origin=to or (0, 0, 0)).circle(radius).extrude(height)


def outline(plane: str, points: str) -> Any:
    corners = [tuple(map(float, point.split(","))) for point in points.split()]
    return at(plane).polyline(corners).close()


def spokes(body: Any, lengths: tuple[float, ...], make: Any) -> Any:
    for i, length in enumerate(lengths):
        body = body.union(make(i, length).rotate((0, 0, 0), (0, 0, 1), 360 * i / len(lengths)))
    return body


def drilled(body: Any, *holes: tuple[float, float, float]) -> Any:
    for x, y, radius in holes:
        body = body.cut(disc(radius, 400, x, y, -200))
    return body


def bearing_block() -> Any:
    body = block(100, 30, 12).union(disc(24, 30, 0, 15, 20, plane="XZ")).cut(disc(14, 60, 0, 30, 20, plane="XZ"))
    return drilled(body, (-38, 0, 4.5), (38, 5, 4.5))


def bracket() -> Any:
    return drilled(block(80, 50, 6).union(block(80, 6, 47, 0, -28, 20)), (-25, 5, 4), (10, 12, 4), (28, -4, 4))


def clevis() -> Any:
    body = block(30, 40, 60).cut(block(40, 20, 50, 0, 0, 15)).cut(disc(5, 80, -40, 0, 18, plane="YZ"))
    return body.union(disc(8, -70, 0, 0, -30)).edges("|X").fillet(2)


def crank() -> Any:
    body = disc(10, 30).union(disc(10, 30, 40, 0, 30)).union(block(60, 26, 8, 20, 0, 30))
    return body.union(disc(7, 20, 20, 0, 34))


def elbow() -> Any:
    path = at("XZ").moveTo(0, 0).lineTo(0, 40).radiusArc((30, 70), 30).lineTo(90, 70)
    pipe = at("XY").circle(10).sweep(path).cut(at("XY").circle(7).sweep(path))
    return pipe.union(at("XY").circle(18).circle(7).extrude(5))


def enclosure() -> Any:
    body = block(100, 60, 30).edges("|Z").fillet(8).faces(">Z").shell(-3).cut(block(20, 14, 10, 48, 10, 0))
    for x, y in ((-40, -20), (40, -20), (-40, 20)):
        body = body.union(disc(4, 12, x, y, -14))
    return body


def flange() -> Any:
    holes = [(30 * math.cos(k * math.pi / 3), 30 * math.sin(k * math.pi / 3), 3.5) for k in range(6)]
    return drilled(disc(40, 10).union(disc(20, 40)), (0, 0, 12), *holes)


def flange_key() -> Any:
    return flange().union(block(30, 14, 10, 45, 0, 5))


def gear() -> Any:
    body = spokes(disc(20, 8), (8,) * 14, lambda _, length: block(length, 4, 8, 22, 0, 4))
    return drilled(body, (0, 0, 4)).cut(block(4, 3, 20, 5, 0, 4))


def heat_sink() -> Any:
    body = block(60, 50, 5)
    for k in range(7):
        body = body.union(block(3, 30 if k == 2 else 50, 25, 9 * k - 27, 0, 15))
    return body


def hook() -> Any:
    path = at("XZ").moveTo(0, 0).lineTo(0, 40).threePointArc((20, 60), (40, 40)).lineTo(40, 20)
    return at("XY").rect(10, 6).sweep(path).union(block(30, 20, 6)).edges("|Y").fillet(1.5)


def knob() -> Any:
    body = disc(20, 8).union(disc(12, 28)).edges(">Z").fillet(3)
    return body.cut(block(3, 10, 10, 0, 10, 28)).cut(disc(3, 15))


def lever() -> Any:
    body = disc(15, 12).union(disc(9, 20, 70, 0, 0)).union(block(60, 12, 8, 35, 0, 4))
    return drilled(body, (0, 0, 6), (70, 0, 4))


def manifold() -> Any:
    body = block(60, 40, 40).union(disc(9, 40, 10, 5, 0)).union(disc(9, 60, 0, 4, 6, plane="YZ"))
    return drilled(body.union(disc(9, 35, -12, 0, 3, plane="XZ")), (10, 5, 5))


def plate() -> Any:
    holes = ((-45, -20, 6), (0, 15, 6), (40, 20, 6), (30, -22, 6))
    return drilled(block(120, 70, 4), *holes).cut(block(30, 10, 10, -20, 20, 0))


def rib_bracket() -> Any:
    rib = outline("XZ", "-24,3 20,3 -24,50").extrude(5).translate((0, 20, 0))
    return drilled(block(60, 60, 6).union(block(6, 60, 60, -27, 0, 30)).union(rib), (10, -15, 4), (15, 20, 4))


def spanner() -> Any:
    body = block(120, 14, 8, 0, 0, 4).union(disc(18, 10, 60, 0, 0)).union(disc(14, 10, -60, 0, 0))
    return body.cut(block(24, 16, 30, 70, 0, 0)).cut(at("XY", origin=(-60, 0, -5)).polygon(6, 16).extrude(40))


def stand() -> Any:
    body = outline("YZ", "0,0 80,0 80,6 20,6 45,90 38,92 5,8").extrude(60)
    return body.cut(block(20, 30, 20, 30, 60, 0))


def angle_iron() -> Any:
    body = outline("XZ", "0,0 40,0 40,5 5,5 5,60 0,60").extrude(90).cut(disc(7, 10, 0, -70, 40, plane="YZ"))
    return body.cut(at("XY", origin=(22, -30, 0)).slot2D(30, 8, 90).extrude(10))


def bolt() -> Any:
    return at("XY").polygon(6, 20).extrude(8).union(disc(6, -50)).faces(">Z").chamfer(1)


def bottle() -> Any:
    half = at("XZ").moveTo(0, 0).lineTo(20, 0).lineTo(20, 45).threePointArc((17, 58), (8, 65)).lineTo(8, 80)
    body = half.lineTo(0, 80).close().revolve(360, (0, 0, 0), (0, 1, 0))
    return body.union(outline("XZ", "18,15 36,20 36,45 18,50 18,44 30,40 30,25 18,21").extrude(3, both=True))


def cam() -> Any:
    body = disc(8, 90)
    for x, angle in ((15, 0), (40, 110), (70, 230)):
        lobe = disc(14, 10, 0, 0, x).union(disc(9, 10, 9, 0, x))
        body = body.union(lobe.rotate((0, 0, 0), (0, 0, 1), angle))
    return body


def channel() -> Any:
    body = outline("YZ", "-20,0 20,0 20,30 17,30 17,3 -17,3 -17,30 -20,30").extrude(120)
    return body.cut(block(20, 30, 10, 30, -15, 18)).cut(disc(8, 10, 90, 5, 0))


def dovetail() -> Any:
    body = outline("XZ", "-30,0 30,0 30,20 12,20 18,32 -18,32 -12,20 -30,20").extrude(60)
    return body.cut(disc(5, 30, -20, -15, 0)).cut(block(8, 16, 30, 20, -45, 15))


def fan() -> Any:
    def blade(_: int, length: float) -> Any:
        return block(length, 3, 10, length / 2 + 8, 0, 7).rotate((0, 0, 0), (1, 0, 0), 25)

    return drilled(spokes(disc(12, 14), (34, 34, 34, 30, 34), blade), (0, 0, 3.5))


def hinge() -> Any:
    body = block(50, 40, 4)
    for y in (-14, 2):
        body = body.union(at("XZ", origin=(25, y, 2)).circle(5).circle(2.5).extrude(-12))
    return drilled(body, (-15, -10, 3), (-15, 10, 3), (5, 4, 3))


def mount() -> Any:
    body = block(70, 30, 6).union(block(8, 30, 40, -20, 0, 23)).union(block(8, 30, 28, 20, 0, 17))
    return body.cut(disc(6, 30, -40, 4, 30, plane="YZ")).edges("|Y and >Z").fillet(3)


def pulley() -> Any:
    half = outline("XZ", "5,0 30,0 24,7 30,14 14,14 14,26 5,26")
    return half.revolve(360, (0, 0, 0), (0, 1, 0)).cut(block(4, 4, 80, 6, 0, 0))


def rod() -> Any:
    body = disc(20, 14).union(disc(12, 10, 90, 0, 2)).union(block(90, 16, 6, 45, 0, 7))
    return drilled(body, (0, 0, 12), (90, 0, 5)).cut(block(40, 8, 5, 48, 0, 9.5))


def shelf() -> Any:
    side = at("XY").moveTo(0, 0).lineTo(80, 0).lineTo(80, 8).threePointArc((30, 30), (8, 80)).lineTo(0, 80)
    body = drilled(side.close().extrude(5), (10, 12, 4.5), (25, 10, 4.5), (12, 40, 4.5))
    return body.union(block(80, 8, 25, 40, 4, 12.5))


def snail() -> Any:
    body = disc(30, 20).union(block(60, 20, 20, 30, 20, 10)).cut(disc(12, 12, 0, 0, 8))
    return body.cut(block(30, 14, 14, 45, 20, 10))


def tee() -> Any:
    body = disc(12, 100, plane="YZ").union(disc(9, 35, 40, 0, 0)).union(disc(16, 5, 40, 0, 30))
    return body.cut(disc(9, 100, plane="YZ")).cut(disc(6, 40, 40, 0, 0))


def trigger() -> Any:
    path = at("XY").moveTo(0, 0).spline([(20, 5), (35, 25), (60, 30)], includeCurrent=True).lineTo(60, 42)
    body = path.spline([(30, 40), (10, 22), (-8, 12)], includeCurrent=True).close().extrude(12)
    return body.union(disc(9, 18, 2, 5, 0)).cut(disc(4, 30, 2, 5, 0))


def wheel() -> Any:
    rim = at("XY").circle(40).circle(32).extrude(12).union(disc(12, 20))
    return drilled(spokes(rim, (10, 6, 6, 6, 6), lambda _, width: block(30, width, 6, 22, 0, 5)), (0, 0, 5))


HALVES = {
    "choice": (
        bearing_block,
        bracket,
        clevis,
        crank,
        elbow,
        enclosure,
        flange,
        flange_key,
        gear,
        heat_sink,
        hook,
        knob,
        lever,
        manifold,
        plate,
        rib_bracket,
        spanner,
        stand,
    ),
    "report": (
        angle_iron,
        bolt,
        bottle,
        cam,
        channel,
        dovetail,
        fan,
        hinge,
        mount,
        pulley,
        rod,
        shelf,
        snail,
        tee,
        trigger,
        wheel,
    ),
}


def main() -> None:
    for half, parts in HALVES.items():
        folder = Path(sys.argv[1]) / half
        folder.mkdir(parents=True, exist_ok=True)
        for make in parts:
            for mesh, (tolerance, angle) in MESHES.items():  # each of a new solid, which keeps the finest that it had
                path = str(folder / f"{make.__name__}.{mesh}.stl")
                cadquery.exporters.export(make(), path, tolerance=tolerance, angularTolerance=angle)


if __name__ == "__main__":
    main()
