"""Plots and animations. matplotlib is imported here alone, when one is asked for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from . import _catena
from .tables import with_unit

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.figure import Figure

    from .results import Analysis, Origin

#: Width of the pages that are drawn, points of 1/72 inch; widths of lines belong to it.
PAGE = 460.0
#: Pictures a second of an animation at its true speed, at most.
RATE = 50.0


def plot(analysis: Analysis, y: str | Sequence[str] | None, x: str | None, figure: Figure | None) -> Figure:
    """See Analysis.plot."""
    import matplotlib.pyplot

    if len(analysis) == 0:
        raise ValueError(f"{analysis.type} has no rows to plot")
    across = analysis.columns[0] if x is None else x
    if y is None:
        names = [name for name in analysis.columns if name != across and analysis[name].dtype.kind == "f"]
    else:
        names = [y] if isinstance(y, str) else list(y)
    if not names:
        raise ValueError(f"{analysis.type} has no column to plot over {across}")
    for name in [across, *names]:
        if analysis[name].dtype.kind != "f":
            raise ValueError(f'column "{name}" of {analysis.type} holds words, which have no place in a plot')
    units = analysis.units
    panels: dict[str, list[str]] = {}
    for name in names:
        panels.setdefault(units[name], []).append(name)
    if figure is None:
        figure = matplotlib.pyplot.figure(figsize=(PAGE / 72, 2 + 1.8 * len(panels)), layout="constrained")
    axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axis, (unit, lines) in zip(axes, panels.items(), strict=True):
        for name in lines:
            axis.plot(analysis[across], analysis[name], label=name)
        axis.set_ylabel(with_unit(lines[0] if len(lines) == 1 else "", unit).strip())
        if len(lines) > 1:
            axis.legend()
    axes[-1].set_xlabel(with_unit(across, units[across]))
    return figure


def animate(
    origin: Origin,
    number: int,
    *,
    pictures: int = 100,
    traces: Sequence[str] = (),
    speed: float = 1.0,
    figure: Figure | None = None,
) -> FuncAnimation:
    """See Analysis.animate; `number` of the analysis, from 1; 0: the last one that has poses."""
    import matplotlib.pyplot
    from matplotlib.animation import FuncAnimation
    from matplotlib.collections import PolyCollection

    if pictures < 1:
        raise ValueError("an animation needs at least one picture")
    if not (speed > 0 and math.isfinite(speed)):
        raise ValueError("the speed of an animation must be a finite number above zero")
    film = _catena.film(origin.path, origin.text, origin.texts, origin.only, number, pictures, list(traces), PAGE)
    left, right, low, high = film.extent
    if figure is None:
        width = PAGE / 72
        figure = matplotlib.pyplot.figure(figsize=(width, width * (high - low) / (right - left)))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)
    lines = PolyCollection([], closed=False)
    axes.add_collection(lines)
    instant = axes.text(0.01, 0.01, "", transform=axes.transAxes)

    def show(number: int) -> list[Any]:
        corners, edges, faces, widths, dashed = film.picture(number)
        lines.set_verts(corners, closed=False)
        lines.set_edgecolor(edges)
        lines.set_facecolor(faces)
        lines.set_linewidth(widths)
        lines.set_linestyle([(0, (5, 3)) if one else "solid" for one in dashed])
        t = film.times[number]
        instant.set_text("" if math.isnan(t) else f"t = {t:.4g} s")
        return [lines, instant]

    times = film.times
    lasts = (times[-1] - times[0]) / speed if len(film) > 1 else 0.0
    between = max(lasts / (len(film) - 1), 1 / RATE) if lasts > 0 else 1 / RATE
    return FuncAnimation(figure, show, frames=len(film), interval=1000 * between, blit=True)
