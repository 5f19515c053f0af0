"""Figures of the report: drawn by matplotlib with the data of their specification, saved, and shown in a notebook."""

from __future__ import annotations

import functools
import json
import pathlib
import re
import shutil
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import matplotlib.collections
import matplotlib.figure
import numpy as np
import pytest
import zerocount as zc
import zerocount.figures
from support import by_program

ResultsOf = Callable[[str], zc.Results]
Row = dict[str, Any]
Drawn = tuple[zc.Figure, matplotlib.figure.Figure]

ALIKE = ("bode", "settled", "jerk-", "world-rate-2", "world-rate-3")
"""Figures that look alike in all studies: they are drawn of one."""
NAMED = ("nominal", "ordinal")
BY_NIGHT = ["unknown-friction", "paper-fig7", "k1-along-position", "paper-fig4"]
DRAWN = ["small", "stability-map", *(pytest.param(name, marks=pytest.mark.long) for name in BY_NIGHT)]


@pytest.fixture(scope="module", params=DRAWN)
def drawn(request: pytest.FixtureRequest, small: zc.Results, results_of: ResultsOf) -> Iterator[list[Drawn]]:
    """The figures of a study, and their pictures."""
    r = small if request.param == "small" else results_of(request.param)
    before = zerocount.figures.figure_names
    zerocount.figures.figure_names = functools.cache(before)
    names = [name for name in r.figures if request.param == "small" or not name.startswith(ALIKE)]
    figures = [r.plot(name) for name in names]
    zerocount.figures.figure_names = before
    assert [figure.name for figure in figures] == names and len(names) > 0
    yield [(figure, figure.matplotlib()) for figure in figures]


def kept(layer: dict[str, Any], view: dict[str, Any], rows: list[Row]) -> list[Row]:
    """The rows of a layer after its filters, and those of its view unless it has data of its own."""
    for transform in [*([] if "data" in layer else view.get("transform", [])), *layer.get("transform", [])]:
        if isinstance(transform["filter"], dict):
            rows = [row for row in rows if row[transform["filter"]["field"]] == transform["filter"]["equal"]]
            continue
        text = re.sub(r"indexof\(datum\.(\w+), ('.*?')\) >= 0", r"\2 in row['\1']", transform["filter"])
        text = re.sub(r"datum\.(\w+)", r"row['\1']", re.sub(r"!(?!=)", "not ", text))
        rows = [row for row in rows if eval(text, {"row": row})]
    return rows


def flat(view: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """A view without layers, or its layers and theirs."""
    if "layer" not in view:
        yield view
    for layer in view.get("layer", []):
        yield from flat(layer)


def layers_of(specification: dict[str, Any], view: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any], list[Row]]]:
    """Mark, channels and rows of the visible layers of a view."""
    for layer in flat(view):
        mark = layer["mark"] if isinstance(layer["mark"], dict) else {"type": layer["mark"]}
        data = layer.get("data") or view.get("data") or specification["data"]
        rows = data["values"] if "values" in data else specification["datasets"][data["name"]]
        if mark.get("opacity", 1) > 0:
            channels = {**view.get("encoding", {}), **layer.get("encoding", {})}
            yield mark["type"], {name: c for name, c in channels.items() if isinstance(c, dict) and set(c) != {"value"}}, kept(layer, view, rows)


def shown(axes: Any) -> tuple[set[tuple[float, float]], set[float], set[float]]:
    """All points that are drawn, and the places of lines across the axes."""
    points: list[np.ndarray] = [np.array(line.get_xydata()) for line in axes.lines]
    for collection in axes.collections:
        if isinstance(collection, matplotlib.collections.PathCollection):
            points.append(np.array(collection.get_offsets()))
        else:
            points += [path.vertices for path in collection.get_paths()]
    points += [np.array([text.xy]) for text in axes.texts]
    everything = {(float(x), float(y)) for some in points for x, y in np.asarray(some).reshape(-1, 2)}
    return everything, {x for x, _ in everything}, {y for _, y in everything}


def number(row: Row, channel: dict[str, Any]) -> float | None:
    """The value of a channel in a row; None where there is none, or a name."""
    value = channel["datum"] if "datum" in channel else row.get(channel.get("field"))
    return float(value) if isinstance(value, (int, float)) and channel.get("type") not in NAMED else None


def test_every_figure_is_drawn_with_its_data(drawn: list[Drawn]) -> None:
    """The axes of matplotlib hold every point, edge and end of every visible mark of the specification."""
    for figure, picture in drawn:
        views = figure.specification.get("vconcat", [figure.specification])
        compared = 0
        for view, axes in zip(views, picture.axes):
            points, across_x, across_y = shown(axes)
            for kind, channels, rows in layers_of(figure.specification, view):
                named = any(channels.get(axis, {}).get("type") in NAMED for axis in "xy")
                for row in rows:
                    for x, y in (("x", "y"), ("x2", "y"), ("x", "y2")):
                        place = [number(row, channels[c]) if c in channels else None for c in (x, y)]
                        if None not in place and not named:
                            assert tuple(place) in points, (figure.name, kind, row)
                        elif place[0] is not None:
                            assert place[0] in across_x, (figure.name, kind, row)
                        elif place[1] is not None:
                            assert place[1] in across_y, (figure.name, kind, row)
                        compared += place != [None, None]
        assert compared > 0, figure.name


def test_axes_have_the_titles_scales_and_limits_of_the_specification(drawn: list[Drawn]) -> None:
    """Titles, logarithmic scales, limits, and the names along an axis are those of the specification."""
    for figure, picture in drawn:
        views = figure.specification.get("vconcat", [figure.specification])
        assert len(picture.axes) >= len(views)
        for view, axes in zip(views, picture.axes):
            names: list[str] = []
            for _, channels, rows in layers_of(figure.specification, view):
                along = channels.get("y", {})
                if along.get("type") in NAMED and along.get("axis", {}).get("labels", True):
                    assert not along.get("sort")
                    names += [str(row[along["field"]]) for row in rows]
                for axis in "xy":
                    channel = channels.get(axis, {})
                    scale = channel.get("scale") or {}
                    if channel.get("title"):
                        assert getattr(axes, f"get_{axis}label")() == channel["title"], figure.name
                    if scale.get("type") in ("log", "symlog"):
                        assert getattr(axes, f"get_{axis}scale")() == scale["type"]
                    if "domain" in scale and channel["type"] == "quantitative":
                        assert list(getattr(axes, f"get_{axis}lim")()) == scale["domain"], figure.name
            if names:
                assert [text.get_text() for text in axes.get_yticklabels()] == list(dict.fromkeys(names))
                assert axes.get_ylim()[0] > axes.get_ylim()[1]  # the first on top


def test_colours_tell_the_series_apart(drawn: list[Drawn]) -> None:
    """Lines of different names have different colours; the legend of the first axes lists them."""
    for figure, picture in drawn:
        for view, axes in zip(figure.specification.get("vconcat", [figure.specification])[:1], picture.axes):
            for kind, channels, rows in layers_of(figure.specification, view):
                channel = channels.get("color", {})
                if kind != "line" or channel.get("type") != "nominal" or "scale" in channel or channel.get("legend", {}) is None:
                    continue
                names = list(dict.fromkeys(str(row[channel["field"]]) for row in rows))
                legend = axes.get_legend()
                assert legend is not None and [text.get_text() for text in legend.get_texts()] == names, figure.name
                colours = [matplotlib.colors.to_hex(handle.get_color()) for handle in legend.get_lines()]
                assert len(set(colours)) == len(names)


def test_a_picture_can_be_drawn_and_saved(drawn: list[Drawn], tmp_path: pathlib.Path) -> None:
    """matplotlib renders the pictures without a warning."""
    figure, picture = max(drawn, key=lambda each: len(json.dumps(each[0].specification)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        picture.savefig(tmp_path / f"{figure.name}.png", dpi=50)


def test_lines_have_the_arrays_of_the_data(small: zc.Results, results_of: ResultsOf) -> None:
    """The rates of the table and the counts of a record are lines of their figures."""
    (axes,) = small.plot("success").matplotlib().axes
    line = next(line for line in axes.lines if len(line.get_xdata()) == 3)
    assert np.allclose(line.get_xdata(), small.table["ki"], rtol=1e-5)
    assert np.allclose(line.get_ydata(), small.table["goal_rate"], rtol=1e-5)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("controller.ki (kN m/(rad s))", "rate of moves in goal")
    assert axes.get_ylim() == (0, 1) and axes.get_xlim() == (5e3, 4e4)
    r = results_of("paper-fig7")
    (axes,) = r.plot("paper-fig7").matplotlib().axes
    for point, line in enumerate(axes.lines[:10]):
        t = zc.trial(r, point, 0)
        counts = t.samples["count"][np.searchsorted(t.t, line.get_xdata())]
        assert len(counts) > 5 and np.ptp(counts) > 0 and np.ptp(line.get_ydata() - counts) == 0


def test_the_map_has_a_cell_for_each_point(results_of: ResultsOf) -> None:
    """The cells of a map have the rates of the table as their colours."""
    r = results_of("stability-map")
    axes = r.plot("stability-map").matplotlib().axes[0]
    cells = next(c for c in axes.collections if isinstance(c, matplotlib.collections.PolyCollection) and c.get_array() is not None)
    assert sorted(cells.get_array()) == pytest.approx(sorted(r.table["success_rate"]), abs=1e-5)
    assert cells.get_clim() == (0, 1)


def test_a_figure_is_saved_in_every_form(small: zc.Results, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """SVG, PNG, HTML and JSON are written, in place of an existing file, and are those of the program."""
    monkeypatch.chdir(tmp_path)
    figure = small.plot("success")
    starts = {"svg": b"<svg", "png": b"\x89PNG\r\n", "html": b"<!DOCTYPE html>", "json": b"{"}
    for ending, start in starts.items():
        pathlib.Path(f"f.{ending}").write_text("old", encoding="utf-8")
        assert figure.save(f"f.{ending}") == pathlib.Path(f"f.{ending}")
        content = pathlib.Path(f"f.{ending}").read_bytes()
        assert content.lstrip().startswith(start)
    assert json.loads(pathlib.Path("f.json").read_text(encoding="utf-8")) == figure.specification
    assert figure.svg == pathlib.Path("f.svg").read_text(encoding="utf-8") and figure.png == pathlib.Path("f.png").read_bytes()
    with pytest.raises(zc.ManifestError, match="pdf"):
        figure.save("f.pdf")


@pytest.mark.long
def test_a_notebook_shows_what_the_machine_can_draw(small: zc.Results, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A notebook gets a PNG; an SVG without the program that makes PNG of it; and a text without node."""
    text = "Figure(name='success')"
    data, metadata = small.plot("success")._repr_mimebundle_(include=None, exclude=None)
    assert data["image/png"].startswith(b"\x89PNG") and data["text/plain"] == text and metadata["image/png"]["width"] > 0
    figure = small.plot("success")
    (tmp_path / "node").symlink_to(shutil.which("node"))
    monkeypatch.setenv("PATH", str(tmp_path))
    data, metadata = figure._repr_mimebundle_()
    assert data == {"image/svg+xml": figure.svg, "text/plain": text} and metadata == {}
    (tmp_path / "node").unlink()
    data, _ = small.plot("settled")._repr_mimebundle_()
    assert list(data) == ["text/plain"] and data["text/plain"].startswith("Figure(name='settled'): ") and "node" in data["text/plain"]


def test_a_figure_is_named_by_its_start(small: zc.Results) -> None:
    """A figure is found by its name or a start of it, the first one without; an unknown name is refused with the known ones."""
    names = small.figures
    assert names == by_program("plot", small.path).split() and small.plot().name == names[0]
    for name in ("settled", "se", "jerk"):
        found = small.plot(name).name
        assert found == (name if name in names else next(other for other in names if other.startswith(name)))
    with pytest.raises(zc.ManifestError, match="there is no figure 'speed'; expected one of " + ", ".join(names)):
        small.plot("speed")


def test_a_figure_shows_the_trials_of_a_point(small: zc.Results) -> None:
    """The trials that are shown are those of the point, by its number or label."""
    by_number, by_label, of_another = (small.plot("response", point=point) for point in (2, "controller.ki=40000", 0))
    assert by_number.specification == by_label.specification != of_another.specification
    for wrong in (3, "none"):
        with pytest.raises(zc.ManifestError, match="expected 0 to 2 or a label"):
            small.plot("response", point=wrong)
