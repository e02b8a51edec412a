"""The reference figure: the speed that a controller aims at, over the gap in front."""

from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.figure import Figure

from giveway.figures.style import BLACK, BLUE, GREY, quiet_grid, styled

ReferenceCurve = Callable[[float], float]
"""Function from a gap [m] to the reference speed [m/s]."""

_SHOWN = 1.25  # Length of the axis, as multiples of the distance from which the speed is v_r
_RESOLUTION = 0.02  # Distance [m] between points of the curve
_LOOKS = ((BLACK, (0, (4, 2))), (BLUE, "-"))  # Line styles, as many as curves are possible


@styled
def reference_figure(
    curves: Sequence[tuple[str, ReferenceCurve]], *, safe_distance: float, buffer_distance: float
) -> Figure:
    """Reference speeds over the gap (figure 3 of Yang & Özgüner 2019).

    Args:
        curves: Curves, at most two, each with its label.
        safe_distance: Gap d_safe [m] at which the curves begin to rise.
        buffer_distance: Distance d_buffer [m] over which the paper's curve rises to v_r.

    Raises:
        ValueError: there is no curve, or there are more than two.
    """
    if not 0 < len(curves) <= len(_LOOKS):
        raise ValueError(f"reference figure: {len(curves)} curves; pass one or two")
    figure = Figure(figsize=(5.6, 3.4), layout="constrained")
    axes = figure.subplots()
    quiet_grid(axes)
    end = safe_distance + buffer_distance
    gaps = np.arange(0.0, _SHOWN * end, _RESOLUTION)
    for (label, curve), (colour, line) in zip(curves, _LOOKS, strict=False):
        axes.plot(gaps, [curve(gap) for gap in gaps], color=colour, linestyle=line, label=label)
    places = {safe_distance: "$d_{safe}$", end: "$d_{safe} + d_{buffer}$"}
    for place, name in places.items():
        axes.axvline(place, color=GREY, linewidth=0.8, linestyle=":")
        axes.annotate(
            f"{name} = {place:g} m", xy=(place, 0.0), xycoords=axes.get_xaxis_transform(),
            xytext=(-4, 6), textcoords="offset points", rotation=90, ha="right", color="#505050",
        )  # fmt: skip
    axes.set(
        xlim=(0.0, gaps[-1]),
        ylim=(0.0, None),
        xlabel="Gap to who is in front [m]",
        ylabel="Reference speed [m/s]",
    )
    figure.legend(loc="outside upper center", ncols=2)
    return figure
