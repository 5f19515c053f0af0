"""Vega-Lite specifications drawn by matplotlib: the part of that language which the figures of the report use."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .optional import required

if TYPE_CHECKING:
    import matplotlib.axes  # type: ignore[import]
    import matplotlib.figure  # type: ignore[import]

Row = dict[str, Any]

INCH = 96.0
"""Pixels of a specification per inch."""

_MARKERS = {"circle": "o", "triangle-up": "^", "diamond": "D", "square": "s"}
_STEPS = {"step-after": "steps-post"}
_FILTERS: list[tuple[str, Callable[[Any, str], bool]]] = [
    (r"datum\.(\w+)", lambda value, _: bool(value)),
    (r"!datum\.(\w+)", lambda value, _: not value),
    (r"datum\.(\w+) != '(.*)'", lambda value, text: bool(value != text)),
    (r"datum\.(\w+) == '(.*)'", lambda value, text: bool(value == text)),
    (r"indexof\(datum\.(\w+), '(.*)'\) >= 0", lambda value, text: text in value),
]


def drawn(specification: Mapping[str, Any]) -> matplotlib.figure.Figure:
    """Draw a specification.

    Parameters
    ----------
    specification : dict
        Vega-Lite with its data, as `Figure.specification` is.

    Returns
    -------
    matplotlib.figure.Figure
        Axes from top to bottom, one for each part of the figure.

    Raises
    ------
    NotImplementedError
        For a mark or a filter that the report does not use.
    """
    pyplot = required("matplotlib.pyplot", "a figure of matplotlib")
    views = specification.get("vconcat", [specification])
    heights = [float(view.get("height", 200)) for view in views]
    picture, axes = pyplot.subplots(
        len(views),
        squeeze=False,
        figsize=(600 / INCH, (sum(heights) + 70 * len(views)) / INCH),
        gridspec_kw={"height_ratios": heights},
        layout="constrained",
    )
    for place, (view, ax) in enumerate(zip(views, axes[:, 0])):
        _View(specification, view, ax).draw(with_legend=place == 0)
    pyplot.close(picture)  # a notebook shows what is returned, and not twice
    return picture


@dataclasses.dataclass
class _View:
    """A part of a figure: layers on common axes."""

    specification: Mapping[str, Any]
    view: Mapping[str, Any]
    axes: matplotlib.axes.Axes
    labels: dict[str, list[str]] = dataclasses.field(default_factory=dict)  # of the axes with names, in their order
    legend: dict[str, dict[str, Any]] = dataclasses.field(default_factory=dict)  # title → name → artist

    def draw(self, *, with_legend: bool) -> None:
        if "title" in self.view:
            self.axes.set_title(self.view["title"], loc="left", fontsize="small")
        for layer in self.layers():
            channels = {**self.view.get("encoding", {}), **layer.get("encoding", {})}
            # A position in pixels is an edge of the plot: the mark spans it.
            channels = {
                name: channel
                for name, channel in channels.items()
                if isinstance(channel, Mapping) and set(channel) != {"value"}
            }
            mark = layer["mark"] if isinstance(layer["mark"], Mapping) else {"type": layer["mark"]}
            colour: Mapping[str, Any] = layer.get("encoding", {}).get("color") or {}
            if "value" in colour:
                mark = {**mark, "color": colour["value"]}
            if mark.get("opacity", 1) == 0:  # it only carries the tooltips of a page
                continue
            _Layer(self, mark, channels, self.rows(layer)).draw()
            for name in ("x", "y"):
                self.set_axis(name, channels.get(name, {}))
        for name, labels in self.labels.items():
            axis = self.axes.xaxis if name == "x" else self.axes.yaxis
            if len(axis.get_ticklocs()) > 0:
                axis.set_ticks(range(len(labels)), labels)
        if "y" in self.labels:
            self.axes.set_ylim(len(self.labels["y"]) - 0.5, -0.5)  # the first on top
        for title, entries in self.legend.items() if with_legend else ():
            self.axes.legend(
                entries.values(),
                entries.keys(),
                title=title or None,
                fontsize="small",
                frameon=False,
                loc="lower left",
                bbox_to_anchor=(0, 1),
                ncols=max(1, 80 // (6 + max(map(len, entries)))),
                borderaxespad=0.2,
            )

    def layers(self) -> list[Mapping[str, Any]]:
        """The layers and theirs; a view without them is one itself."""
        return list(_flat(self.view))

    def rows(self, layer: Mapping[str, Any]) -> list[Row]:
        """The data of a layer, after its filters."""
        data: Any = layer.get("data") or self.view.get("data") or self.specification.get("data")
        rows = data["values"] if "values" in data else self.specification["datasets"][data["name"]]
        of_view = [] if "data" in layer else self.view.get("transform", [])
        for transform in [*of_view, *layer.get("transform", [])]:
            rows = [row for row in rows if _keeps(transform["filter"], row)]
        return list(rows)

    def set_axis(self, name: str, channel: Mapping[str, Any]) -> None:
        """Scale, limits, title and labels of an axis."""
        axis = self.axes.xaxis if name == "x" else self.axes.yaxis
        scale = channel.get("scale") or {}
        style = channel.get("axis") or {}
        kind = scale.get("type", "linear")
        if kind in ("log", "symlog"):
            options = {"linthresh": scale.get("constant", 1)} if kind == "symlog" else {}
            (self.axes.set_xscale if name == "x" else self.axes.set_yscale)(kind, **options)
        if "domain" in scale and channel.get("type") == "quantitative":
            (self.axes.set_xlim if name == "x" else self.axes.set_ylim)(*scale["domain"])
        if channel.get("title"):
            axis.set_label_text(channel["title"])
        if "labelExpr" in style:
            ticker = required("matplotlib.ticker", "a figure")
            scaled = re.search(r"format\(datum\.value(?: \* ([\d.e-]+))?, '\.\d~r'\)(?: \+ '(.*?)')?", style["labelExpr"])
            factor, suffix = (float(scaled[1] or 1), scaled[2] or "") if scaled else (1.0, "")
            axis.set_major_formatter(
                ticker.FuncFormatter(lambda value, _: f"{value * factor:.4g}{suffix}") if scaled else ticker.EngFormatter(sep="")
            )
        if style.get("labels") is False:
            axis.set_tick_params(labelleft=False, labelbottom=False)
            if name in self.labels:
                axis.set_ticks([])
        if style.get("grid"):
            self.axes.grid(axis=name, alpha=0.4)

    def place_of(self, name: str, label: Any) -> float:
        """Place of a label on an axis with names."""
        labels = self.labels.setdefault(name, [])
        if str(label) not in labels:
            labels.append(str(label))
        return float(labels.index(str(label)))


@dataclasses.dataclass
class _Layer:
    """A mark with its data."""

    view: _View
    mark: Mapping[str, Any]
    channels: Mapping[str, Any]
    rows: list[Row]

    def draw(self) -> None:
        kind = self.mark["type"]
        marks: dict[str, Callable[[list[Row], dict[str, Any]], Any]] = {
            "line": self.line,
            "area": self.area,
            "point": self.points,
            "circle": self.points,
            "rule": self.rules,
            "tick": self.ticks,
            "rect": self.rectangles,
            "bar": self.rectangles,
            "text": self.texts,
        }
        if kind not in marks:
            raise NotImplementedError(f"matplotlib draws no mark {kind!r}; save the figure as SVG or PNG instead")
        for name, rows, style in self.series():
            artist = marks[kind](rows, style)
            channel = self.channels.get("color", {})
            if name is not None and artist is not None and channel.get("legend", {}) is not None:
                self.view.legend.setdefault(channel.get("title") or "", {}).setdefault(name, artist)

    def series(self) -> Iterator[tuple[str | None, list[Row], dict[str, Any]]]:
        """The rows of each colour, shape and detail, with their style."""
        theme = self.view.specification["config"]
        own = self.mark.get("color") or self.mark.get("fill") or self.mark.get("stroke")
        default = own or theme.get(self.mark["type"], {}).get("color") or theme["range"]["category"][0]
        colour = self.channels.get("color", {})
        named = "field" in colour and colour.get("type") != "quantitative"
        shaded = "field" in colour and not named and self.mark["type"] == "line"
        fields = [self.channels[name]["field"] for name in ("shape", "detail", "strokeDash") if name in self.channels]
        groups: dict[tuple[Any, ...], list[Row]] = {}
        for row in self.rows:
            key = (row.get(colour["field"]) if named or shaded else None, *(row.get(field) for field in fields))
            groups.setdefault(key, []).append(row)
        for key, rows in groups.items():
            style: dict[str, Any] = {"color": default}
            if named:
                style["color"] = self.colour_of(key[0])
            elif shaded:
                style["color"] = self.shade_of(key[0])
            if "shape" in self.channels:
                scale = self.channels["shape"]["scale"]
                shape = scale["range"][scale["domain"].index(rows[0][self.channels["shape"]["field"]])]
                style["marker"] = _MARKERS[shape]
            yield (str(key[0]) if named else None), rows, style

    def colour_of(self, name: Any) -> Any:
        """Colour of a name."""
        channel = self.channels["color"]
        palette = self.view.specification["config"]["range"]["category"]
        scale = channel.get("scale", {})
        if "range" in scale:
            return scale["range"][scale["domain"].index(name) % len(scale["range"])]
        names: list[Any] = scale.get("domain") or list(dict.fromkeys(row.get(channel["field"]) for row in self.rows))
        if "scheme" in scale:
            place = names.index(name) / max(1, len(names) - 1)
            return required("matplotlib", "a figure").colormaps[scale["scheme"]](place)
        return palette[names.index(name) % len(palette)]

    def shade_of(self, value: float) -> Any:
        """Colour of a number, between the two of the scale."""
        channel = self.channels["color"]
        numbers = [row[channel["field"]] for row in self.rows]
        low, high = min(numbers), max(numbers)
        shades = required("matplotlib.colors", "a figure").LinearSegmentedColormap.from_list(
            channel["field"], channel["scale"]["range"]
        )
        return shades((value - low) / (high - low) if high > low else 0.0)

    def values(self, name: str, rows: list[Row]) -> Any:
        """The values of a position channel, NaN where there is none."""
        channel = self.channels[name]
        if "datum" in channel:
            return np.full(len(rows), float(channel["datum"]))
        axis = name[0]
        if channel.get("type", "quantitative") in ("quantitative", "temporal") or name[1:]:
            return np.array([np.nan if (v := row.get(channel["field"])) is None else v for row in rows])
        places = np.array([self.view.place_of(axis, row[channel["field"]]) for row in rows])
        offset = self.channels.get(f"{axis}Offset")
        if offset is not None:
            names = list(dict.fromkeys(row[offset["field"]] for row in self.rows))
            places = places + np.array([(names.index(row[offset["field"]]) + 0.5) / len(names) - 0.5 for row in rows]) * 0.6
        return places

    def line(self, rows: list[Row], style: dict[str, Any]) -> Any:
        if "order" in self.channels:
            rows = sorted(rows, key=lambda row: float(row[self.channels["order"]["field"]]))
        return self.view.axes.plot(
            self.values("x", rows),
            self.values("y", rows),
            drawstyle=_STEPS.get(self.mark.get("interpolate", ""), "default"),
            linewidth=self.mark.get("strokeWidth", 1.8) * 0.75,
            alpha=self.mark.get("opacity", 1),
            **style,
        )[0]

    def area(self, rows: list[Row], style: dict[str, Any]) -> None:
        step = "post" if self.mark.get("interpolate") == "step-after" else None
        x, low, high = self.values("x", rows), self.values("y", rows), self.values("y2", rows)
        alpha = self.mark.get("opacity", 1)
        self.view.axes.fill_between(x, low, high, step=step, alpha=alpha, linewidth=0, **style)

    def points(self, rows: list[Row], style: dict[str, Any]) -> Any:
        size = self.mark.get("size", 60) * 0.5
        return self.view.axes.scatter(
            self.values("x", rows), self.values("y", rows), s=size, alpha=self.mark.get("opacity", 1), zorder=3, **style
        )

    def rules(self, rows: list[Row], style: dict[str, Any]) -> Any:
        options = {
            "linewidth": self.mark.get("strokeWidth", 1) * 0.75,
            "alpha": self.mark.get("opacity", 1),
            "linestyles": "dashed" if "strokeDash" in self.mark else "solid",
        }
        axes = self.view.axes
        if "x" in self.channels and "y" in self.channels:
            x, y = self.values("x", rows), self.values("y", rows)
            if "x2" in self.channels:
                return axes.hlines(y, x, self.values("x2", rows), **options, **style)
            if "y2" in self.channels:
                return axes.vlines(x, y, self.values("y2", rows), **options, **style)
        across = {**style, "linewidth": options["linewidth"], "alpha": options["alpha"], "linestyle": options["linestyles"]}
        for value in self.values("x", rows) if "x" in self.channels else []:
            axes.axvline(value, **across)
        for value in self.values("y", rows) if "y" in self.channels else []:
            axes.axhline(value, **across)
        return None

    def ticks(self, rows: list[Row], style: dict[str, Any]) -> Any:
        half = self.mark.get("bandSize", 14) / 40
        y = self.values("y", rows)
        return self.view.axes.vlines(
            self.values("x", rows), y - half, y + half, linewidth=self.mark.get("thickness", 1) * 0.75, **style
        )

    def rectangles(self, rows: list[Row], style: dict[str, Any]) -> Any:
        collections = required("matplotlib.collections", "a figure")
        x, y = self.values("x", rows), self.values("y", rows)
        x2 = self.values("x2", rows) if "x2" in self.channels else np.zeros_like(x)
        y2 = self.values("y2", rows) if "y2" in self.channels else np.zeros_like(y)
        if "y" in self.view.labels:  # bars along an axis with names
            y, y2 = y - 0.35, y + 0.35
        corners = [[(a, c), (b, c), (b, d), (a, d)] for a, b, c, d in zip(x, x2, y, y2)]
        shapes = collections.PolyCollection(corners, linewidths=0, alpha=self.mark.get("opacity", 1))
        colour = self.channels.get("color", {})
        if colour.get("type") == "quantitative":
            shapes.set_array(np.array([row[colour["field"]] for row in rows], dtype=float))
            shapes.set_cmap(colour["scale"].get("scheme", "cividis"))
            shapes.set_clim(*colour["scale"].get("domain", (None, None)))
            self.view.axes.figure.colorbar(shapes, ax=self.view.axes, label=colour.get("title", ""))
        else:
            shapes.set_facecolor(style["color"])
        self.view.axes.add_collection(shapes)
        self.view.axes.autoscale_view()
        return None

    def texts(self, rows: list[Row], style: dict[str, Any]) -> None:
        text = self.channels.get("text")
        x = self.values("x", rows) if "x" in self.channels else np.zeros(len(rows))
        y = self.values("y", rows) if "y" in self.channels else np.zeros(len(rows))
        halo = required("matplotlib.patheffects", "a figure").withStroke(linewidth=2, foreground="black")
        for row, a, b in zip(rows, x, y):
            word = str(row[text["field"]]) if text else str(self.mark["text"])
            offset = (_number(self.mark.get("dx")), -_number(self.mark.get("dy")))
            side = row.get("side", "center")
            if isinstance(self.mark.get("dx"), Mapping):  # an expression: away from the side on which the text stands
                offset = (6.0 if side == "left" else -6.0, offset[1])
            effects = [halo] if "stroke" in self.mark else []
            self.view.axes.annotate(
                word, (a, b), offset, textcoords="offset points", ha=side, path_effects=effects, **style
            )


def _flat(view: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """A view without layers, or its layers and theirs."""
    if "layer" not in view:
        yield view
    for layer in view.get("layer", []):
        yield from _flat(layer)


def _number(value: Any) -> float:
    """A number of a mark; of an expression, none."""
    return float(value) if isinstance(value, (int, float)) else 0.0


def _keeps(expression: str | Mapping[str, Any], row: Row) -> bool:
    """Whether a filter keeps a row."""
    if isinstance(expression, Mapping):
        return bool(row.get(expression["field"]) == expression["equal"])
    for pattern, keeps in _FILTERS:
        if found := re.fullmatch(pattern, expression):
            return keeps(row.get(found[1]), found[2] if found.re.groups > 1 else "")
    raise NotImplementedError(f"matplotlib cannot filter by {expression!r}; save the figure as SVG or PNG instead")
