"""Matplotlib figures; only this module imports Matplotlib."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Protocol, Sequence

from ._kempf import KempfError
from ._quantity import Quantity


class Series(Protocol):
    """Heading and rudder over time: a record."""

    @property
    def name(self) -> str: ...
    @property
    def t_s(self) -> Any: ...
    @property
    def heading_deg(self) -> Any: ...
    @property
    def rudder_deg(self) -> Any: ...


class Labelled(Protocol):
    """The answer of a method: its estimates are read by their names."""

    @property
    def method(self) -> str: ...


class Interval(Protocol):
    """A median with its 50 and 90 % intervals, and what was measured."""

    @property
    def median(self) -> float: ...
    @property
    def ci50(self) -> Sequence[float]: ...
    @property
    def ci90(self) -> Sequence[float]: ...
    @property
    def measured(self) -> Optional[float]: ...


#: Colours of measurement, rudder and replays in order, distinguishable with colour vision deficiency.
MEASURED, RUDDER = "#222222", "#8a8a8a"
REPLAYS = ("#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#882255", "#44aa99")


def _figure(rows: int, columns: int = 1, **options: Any) -> tuple[Any, Any]:
    """A figure with its axes. A notebook shows what a cell returns, and must not show it twice."""
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise KempfError("matplotlib is not installed; install it with: pip install matplotlib") from error
    figure, axes = plt.subplots(rows, columns, squeeze=False, layout="constrained", **options)
    if "inline" in plt.get_backend().lower():
        plt.close(figure)
    return figure, axes


def _tidy(axes: Any) -> None:
    for panel in axes.flat:
        panel.spines[["top", "right"]].set_visible(False)
        panel.grid(True, color="#e4e4e4", linewidth=0.6)
        panel.set_axisbelow(True)


def _rudder(axes: Any, record: Series) -> None:
    axes.axhline(0.0, color="#bbbbbb", linewidth=0.6)
    axes.plot(record.t_s, record.rudder_deg, color=RUDDER, linewidth=1.2)
    axes.set_ylabel("rudder δ [deg]")


def record(shown: Series) -> Any:
    """Heading and rudder of a record."""
    figure, axes = _figure(2, figsize=(8, 4.5), sharex=True)
    heading, rudder = axes[:, 0]
    heading.plot(shown.t_s, shown.heading_deg, color=MEASURED, linewidth=1.2)
    heading.set_ylabel("heading ψ [deg]")
    heading.set_title(shown.name, loc="left")
    _rudder(rudder, shown)
    rudder.set_xlabel("time t [s]")
    _tidy(axes)
    return figure


def replays(shown: Series, curves: Mapping[str, Mapping[str, Any]]) -> Any:
    """Rudder, measured heading with its replays, and the residuals."""
    figure, axes = _figure(3, figsize=(8, 7), sharex=True, height_ratios=(1, 2.2, 1.4))
    rudder, heading, residual = axes[:, 0]
    _rudder(rudder, shown)
    rudder.set_title(shown.name, loc="left")
    heading.plot(shown.t_s, shown.heading_deg, ".", color=MEASURED, markersize=2.5, label="measured")
    residual.axhline(0.0, color="#bbbbbb", linewidth=0.6)
    for (name, curve), colour in zip(curves.items(), REPLAYS * 2):
        heading.plot(curve["t_s"], curve["heading_deg"], color=colour, linewidth=1.3, label=name)
        residual.plot(curve["t_s"], curve["residual_deg"], color=colour, linewidth=0.9)
    heading.set_ylabel("heading ψ [deg]")
    heading.legend(frameon=False, ncols=4, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2)
    residual.set_ylabel("measured − replay [deg]")
    residual.set_xlabel("time t [s]")
    _tidy(axes)
    return figure


def _ends(quantity: Quantity) -> Optional[tuple[float, float]]:
    if quantity.ci95 is None or quantity.ci95[0] is None or quantity.ci95[1] is None:
        return None
    return quantity.ci95[0], quantity.ci95[1]


def estimates(methods: Sequence[Labelled]) -> Any:
    """K, T and δ_r of every method with their 95 % intervals."""
    figure, axes = _figure(1, 3, figsize=(10, 1.2 + 0.34 * len(methods)), sharey=True)
    panels = (("K_per_s", "K [1/s]"), ("T_s", "T [s]"), ("delta_r_deg", "δ_r [deg]"))
    for panel, (name, label) in zip(axes[0], panels):
        for row, method in enumerate(methods):
            quantity: Optional[Quantity] = getattr(method, name)
            if quantity is None or quantity.value is None:
                continue
            ends = _ends(quantity)
            if ends is not None:
                panel.plot(ends, (row, row), color=REPLAYS[1], linewidth=2.0, solid_capstyle="butt")
            panel.plot(
                quantity.value,
                row,
                "o" if ends else "D",
                color=REPLAYS[1],
                markersize=5,
                fillstyle="full" if ends else "none",
            )
        panel.set_xlabel(label)
    axes[0][0].set_yticks(range(len(methods)), [method.method for method in methods])
    axes[0][0].invert_yaxis()
    figure.suptitle(
        "estimates with 95 % intervals; open diamonds: a method that gives none", fontsize=10, x=0.01, ha="left"
    )
    _tidy(axes)
    return figure


def intervals(rows: Sequence[tuple[str, str, str, Interval]]) -> Any:
    """Medians with their 50 and 90 % intervals: one panel for all figures of a manoeuvre in one unit."""
    panels: dict[tuple[str, str], list[tuple[str, Interval]]] = {}
    for what, name, unit, figure in rows:
        panels.setdefault((what, unit), []).append((name, figure))
    if not panels:
        raise KempfError("nothing was predicted that has a figure; name another manoeuvre")
    heights = [len(figures) + 1.6 for figures in panels.values()]
    canvas, axes = _figure(len(panels), figsize=(8, 0.3 * sum(heights) + 0.4), height_ratios=heights)
    for panel, ((what, unit), figures) in zip(axes[:, 0], panels.items()):
        for row, (_, figure) in enumerate(figures):
            panel.plot(figure.ci90, (row, row), color=REPLAYS[5], linewidth=2.0, solid_capstyle="butt")
            panel.plot(figure.ci50, (row, row), color=REPLAYS[1], linewidth=5.0, solid_capstyle="butt")
            panel.plot(figure.median, row, "o", color="white", markeredgecolor=REPLAYS[1], markersize=5)
            if figure.measured is not None:
                panel.plot(figure.measured, row, "x", color=REPLAYS[0], markersize=7, markeredgewidth=2)
        panel.set_yticks(range(len(figures)), [name for name, _ in figures])
        panel.set_ylim(len(figures) - 0.4, -0.6)
        panel.set_title(what, loc="left", fontsize=10)
        panel.set_xlabel(f"[{unit}]" if unit else "")
    legend = "circle: median; thick: 50 %; thin: 90 %"
    if any(figure.measured is not None for *_, figure in rows):
        legend += "; cross: measured"
    canvas.suptitle(legend, fontsize=10, x=0.01, ha="left")
    _tidy(axes)
    return canvas
