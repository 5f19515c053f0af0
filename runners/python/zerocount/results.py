"""Results files as tables."""

from __future__ import annotations

import copy
import dataclasses
import functools
import os
import pathlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Generic, TypeVar, cast

from . import program
from .answer_types import JudgeAnswer, SummaryAnswer
from .asking import ask
from .checked import CheckedStudy, recorded_study
from .datasets import Column, ResultsDatasets, state_of
from .errors import DataError
from .figures import Figure, figure, figure_names
from .optional import required
from .tables import frame, short_name
from .traces import Trace, replayed
from .trial_columns import TrialColumns, flat
from .wording import counted

if TYPE_CHECKING:
    import pandas  # type: ignore[import]
    from xarray import Dataset

    from .studies import Study

T = TypeVar("T")

_TABLE = (
    "trials",
    "success_rate",
    "success_rate_low",
    "success_rate_high",
    "stable_rate",
    "stable_rate_low",
    "stable_rate_high",
    "arrival_time_median",
    "arrival_time_p95",
    "band_settling_time_p95",
    "tolerance_settling_time_p95",
    "jerk_count_mean",
)
_GOAL = {
    "goal": "whether the point meets the goal of the manifest: met, missed or undecided",
    "goal_rate": "proportion of moves that meet the goal",
    "goal_rate_low": "lower bound of that",
    "goal_rate_high": "upper bound of that",
}


def open_results(path: str | os.PathLike[str]) -> Results:
    """Open a results file.

    Parameters
    ----------
    path : path
        What ``Study.run`` or ``zerocount run`` made.

    Returns
    -------
    Results

    Raises
    ------
    DataError
        If it is not a results file.

    Examples
    --------
    >>> zc.open("my-axis.h5")
    <Results 'my-axis': 8 design points × 2000 trials>
    """
    return Results(path)


class _of_file(property, Generic[T]):  # a property for Python, and a descriptor with a type for mypy
    """A property that is read once for each state of the file."""

    def __init__(self, read: Callable[[Any], T]) -> None:
        @functools.wraps(read)
        def value(results: Any) -> T:
            state = state_of(results.path)
            if results._kept.get(read.__name__, (None,))[0] != state:
                results._kept[read.__name__] = (state, read(results))
            kept = results._kept[read.__name__][1]
            # The caller may change a table or a dict that it gets.
            return cast(T, copy.deepcopy(kept) if hasattr(kept, "copy") else kept)

        super().__init__(value)

    if TYPE_CHECKING:

        def __get__(self, results: object, owner: type | None = None) -> T: ...


class Results:
    """A results file. Rates are fractions; NaN stands where there is no value.

    The tables are pandas DataFrames. ``table.attrs["units"]`` and ``table.attrs["meanings"]`` tell the unit and
    the meaning of each column. Names are short where that is clear: ``ki`` for ``controller.ki``.

    Attributes
    ----------
    path : pathlib.Path
        The file, from the root: the results are the same in another folder and in another process.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._file = ResultsDatasets(path)
        self._kept: dict[str, Any] = {}
        self.path = self._file.path

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_kept": {}}

    def __repr__(self) -> str:
        attributes = self._file.attributes
        points, trials = attributes["points"], attributes["trials"]
        part = "" if attributes["complete"] else f"a part, {attributes['trial_count']} trials, of "
        return f"<Results {self.name!r}: {part}{counted(points, 'design point')} × {counted(trials, 'trial')}>"

    def _repr_html_(self) -> str:
        return f"<p>{self.name}: {self.path}</p>" + str(self.table.to_html())

    @property
    def name(self) -> str:
        """Name of the study."""
        return str(self._file.attributes["name"])

    @_of_file
    def study(self) -> Study:
        """The study that was run: its manifest and settings. What is made of it by `set` and the like finds the files
        that the manifest names from the folder of the results."""
        from .studies import Study

        overrides = self._file.texts("overrides")
        study = Study(self._file.text("manifest"), str(self.path), self.path.resolve().parent, overrides)
        study.checked = self.checked  # without the files that the manifest names
        return study

    @_of_file
    def checked(self) -> CheckedStudy:
        """The study as its trials were run, in this process."""
        return recorded_study(self.path)

    def command(self, name: str, *options: str, accepted: frozenset[int] = frozenset({0})) -> str:
        """What a command of the program says of this file.

        Parameters
        ----------
        name : str
            Such as ``"sensitivity"``.
        *options : str
            Such as ``"--point", "3"``.
        accepted : frozenset of int
            Exit codes that are no error.

        Returns
        -------
        str
            Standard output.
        """
        return program.run([name, str(self.path), *options], accepted=accepted)[1]

    @_of_file
    def summary(self) -> SummaryAnswer:
        """All statistics."""
        return ask("summary", self)

    @_of_file
    def statistics(self) -> pandas.DataFrame:
        """All statistics that the file stores, one row a design point.

        The bounds (``_low``, ``_high``) are those of the file, at 95 % confidence. They respect that trials of
        a machine are not independent. Of an error band of b counts the name ends in ``[b]``.
        """
        if not self._file.attributes["complete"]:
            raise DataError(f"{self.path}: a part of a study; expected one that 'zerocount merge' joined", 4)
        columns = self._group("point")
        points = columns.pop("point").values
        return frame("the table of points", self._columns.by_band(columns), points, "point")

    @_of_file
    def table(self) -> pandas.DataFrame:
        """The main statistics, one row a design point: a part of `statistics`, and the goal if there is one.

        Returns
        -------
        pandas.DataFrame
            Index ``point``, the number of the design point. Columns: ``label``; the swept keys; with a goal
            ``goal`` (met, missed, undecided), ``goal_rate`` and its bounds; ``trials``; ``success_rate``, the
            proportion of trials that end at zero counts, and ``stable_rate``, each with bounds;
            ``arrival_time_median`` and ``_p95`` (s), the arrival at zero; ``band_settling_time_p95[b]`` (s),
            after which the error stays within b counts, ``tolerance_settling_time_p95[t]`` (s), after which the
            position error stays within t; ``jerk_count_mean`` per trial. Quantiles are of all moves:
            the k-th smallest of n with k = ⌈p·n⌉, where a move that never arrives is later than any other.

        Examples
        --------
        >>> r = zc.open("my-axis.h5")
        >>> r.table.loc[2, ["ki", "goal", "goal_rate"]].to_list()
        [11767.7344682513, 'met', 0.97975]
        >>> r.table.attrs["units"]["arrival_time_p95"]
        's'
        """
        everything = self.statistics
        axes = [short_name(str(axis["name"]), list(everything)) for axis in self.checked.axes]
        wanted = [name for part in _TABLE for name in everything if name.partition("[")[0] == part]
        wanted += [name for name in everything if name == "machines_without_failure"]
        table = everything[["label", *axes, *wanted]].astype({"trials": int})
        table.attrs = {kind: {name: of[name] for name in table} for kind, of in everything.attrs.items()}
        if self.checked.goals:
            goals = [point["goal"] for point in self.summary["points"]]
            for place, (name, key) in enumerate(zip(_GOAL, ("status", "rate", "rate_low", "rate_high"))):
                table.insert(1 + len(axes) + place, name, [goal[key] for goal in goals])
                table.attrs["units"][name] = "1"
                table.attrs["meanings"][name] = _GOAL[name]
        return table

    @property
    def _columns(self) -> TrialColumns:
        return TrialColumns(self._file, self.checked)

    def _group(self, name: str, rows: slice | None = None) -> dict[str, Column]:
        """Datasets of a file whose checksum was compared."""
        self.checked
        return self._file.group(name, rows)

    def _rows(self, point: int | str | None) -> slice | None:
        """The rows of trials of a design point; all of them for None."""
        return None if point is None else self._file.rows_of_point(self.point(point))

    def point(self, point: int | str) -> int:
        """Number of a design point.

        Parameters
        ----------
        point : int or str
            Number or label.

        Returns
        -------
        int

        Raises
        ------
        ManifestError
            If there is no such point.
        """
        from .studies import point_number

        return point_number(point, self.checked.labels, self.path)

    @property
    def best(self) -> int:
        """Number of the best design point: by the goal of the manifest, without one by the success rate."""
        return int(self.summary["best"]["point"])

    def trials(self, point: int | str | None = None) -> pandas.DataFrame:
        """Inputs and outcomes, one row a trial.

        Parameters
        ----------
        point : int or str, optional
            Number or label of a design point; default: all.

        Returns
        -------
        pandas.DataFrame
            Index ``trial``, the row of the trial in the file. Columns: ``point``, ``index`` (of the trial at its
            point), ``machine`` if trials share machines, ``world`` if the study has worlds, ``condition`` if it has
            conditions, ``age`` if it has ages, the inputs, ``success`` (zero counts at the end of every move), ``goal_met`` (every move meets the goal), ``outcome`` (of the
            worst move), and the measures of the moves, combined. ``attrs["combined"]`` tells how: ``all`` or
            ``any`` of the moves have the quality, the ``sum``, the ``largest`` magnitude (NaN if a move has none),
            or that of the last move (``last``).

        Examples
        --------
        >>> t = zc.open("my-axis.h5").trials(point=2)
        >>> t[["k1", "machine", "success"]].iloc[0].to_dict()
        {'k1': 129.43261101715342, 'machine': 0, 'success': False}
        """
        columns = self._columns.trials(self._rows(point))
        trial = columns.pop("trial").values
        table = frame("the table of trials", columns, trial, "trial")
        measures = self.checked.descriptions["outcome"]
        table.attrs["combined"] = {name: measures[name]["of_trial"] for name in table if name in measures}
        return table

    def moves(self, point: int | str | None = None, *, inputs: bool = False) -> pandas.DataFrame:
        """Outcomes, one row a move.

        Parameters
        ----------
        point : int or str, optional
            Number or label of a design point; default: all.
        inputs : bool
            Join point, index, machine, world, condition, age and inputs of the trial.

        Returns
        -------
        pandas.DataFrame
            Index ``trial`` (as in `trials`) and ``move``. Columns: the measures of a move, and ``goal_met`` if the
            manifest has a goal.
        """
        pandas = required("pandas", "the table of moves")
        rows = self._rows(point)
        trial, move, columns = self._columns.moves(rows)
        if inputs:
            columns = {**self._columns.repeated_inputs(rows, len(move)), **columns}
        index = pandas.MultiIndex.from_product([trial, move], names=["trial", "move"])
        return frame("the table of moves", columns, index, None)

    def jerks(self, point: int | str | None = None) -> pandas.DataFrame:
        """Jerks, one row each: excursions of the error from zero after arrival.

        Parameters
        ----------
        point : int or str, optional
            Number or label of a design point; default: all.

        Returns
        -------
        pandas.DataFrame
            Index ``jerk``. Columns: ``trial`` (as in `trials`), ``move``, ``onset`` and ``duration`` (s), ``magnitude`` (counts),
            ``direction``.
        """
        columns = self._group("jerk")
        table = frame("the table of jerks", columns, columns.pop("jerk").values, "jerk")
        if point is None:
            return table
        trials = self._group("trial", self._rows(point))["trial"].values
        return table[table["trial"].isin(trials)]

    def machines(self, point: int | str | None = None) -> pandas.DataFrame:
        """Machines, one row each.

        Parameters
        ----------
        point : int or str, optional
            Number or label of the design point of the counts; default: the sum over all points.

        Returns
        -------
        pandas.DataFrame
            Index ``machine``. Columns: what is drawn per machine, ``trials``, and ``success``, those of them that end at
            zero counts. Those that meet the goal: ``trials(point).groupby("machine")["goal_met"].sum()``.
        """
        return self._machines("machine", point)

    def worlds(self, point: int | str | None = None) -> pandas.DataFrame:
        """Worlds, one row each: what all machines share and nobody knows.

        Parameters
        ----------
        point : int or str, optional
            Number or label of the design point of the counts; default: the sum over all points.

        Returns
        -------
        pandas.DataFrame
            Index ``world``. Columns: what is drawn per world, ``trials``, ``success``, and with a goal
            ``goal_met``.
        """
        return self._machines("world", point)

    def _machines(self, group: str, point: int | str | None) -> pandas.DataFrame:
        columns = self._group(group)
        inputs = self._group(f"{group}/input") if self._file.has(f"{group}/input") else {}
        index = columns.pop(group).values
        counts = {
            name: column
            for name, column in columns.items()
            if column.dimensions == ("point", group) and name != "life"
        }
        for name, column in counts.items():
            values = column.values.sum(axis=0) if point is None else column.values[self.point(point)]
            inputs[name] = Column(values, (group,), column.unit, column.meaning)
        return frame(f"the table of {group}s", inputs, index, group)

    def ages(self, point: int | str | None = None) -> pandas.DataFrame:
        """Ages of the machines, one row each, of a study with ages.

        Parameters
        ----------
        point : int or str, optional
            Number or label of the design point; default: the best.

        Returns
        -------
        pandas.DataFrame
            Index ``age``, in the unit of the manifest. Columns: ``trials``, ``success`` (trials that end at zero
            counts), and with a goal ``goal_met`` (trials that meet it) and ``machines`` (proportion of machines that
            meet it at the age under every condition) with its bounds ``machines_low`` and ``machines_high``.
        """
        columns = self._group("age")
        index = columns.pop("age").values
        columns.pop("point", None)
        row = self.best if point is None else self.point(point)
        ages = {
            name: dataclasses.replace(column, values=column.values[row], dimensions=("age",))
            for name, column in columns.items()
        }
        return frame("the table of ages", ages, index, "age")

    def lives(self, point: int | str | None = None) -> pandas.DataFrame:
        """Lives of the machines, one row each, of a study with ages and a goal.

        Parameters
        ----------
        point : int or str, optional
            Number or label of the design point; default: the best.

        Returns
        -------
        pandas.DataFrame
            Index ``machine``. Column ``life``: the last age up to and including which the machine meets the goal in its
            proportion of moves under every condition; NaN if it does not at the first.
        """
        columns = self._group("machine")
        if "life" not in columns:
            raise DataError(f"{self.path}: its machines have no lives: the study has no ages, or no goal", 4)
        row = self.best if point is None else self.point(point)
        life = dataclasses.replace(columns["life"], values=columns["life"].values[row], dimensions=("machine",))
        return frame("the table of lives", {"life": life}, columns["machine"].values, "machine")

    def levels(self) -> pandas.DataFrame:
        """Torque levels of an open-loop study, one row for each point and level.

        Returns
        -------
        pandas.DataFrame
            Index ``point`` and ``move``.
        """
        pandas = required("pandas", "the table of torque levels")
        columns = self._group("level")
        axes = [columns.pop("point").values, columns.pop("move").values]
        index = pandas.MultiIndex.from_product(axes, names=["point", "move"])
        return frame("the table of torque levels", flat(columns, ("point", "move")), index, None)

    @_of_file
    def dataset(self) -> Dataset:
        """Inputs and outcomes of all trials as arrays with named dimensions.

        Returns
        -------
        xarray.Dataset
            Dimensions ``trial``, ``move`` and ``band``. Coordinates: ``point``, ``index``, ``condition`` and ``age`` if
            the study has conditions and ages, the inputs. Variables: the measures of a move. Units and meanings in ``attrs``.

        Examples
        --------
        >>> ds = zc.open("my-axis.h5").dataset
        >>> ds.settling_time.sizes
        Frozen({'trial': 16000, 'move': 2})
        """
        xarray = required("xarray", "the dataset")

        def variable(column: Column) -> Any:
            return column.dimensions, column.in_words, {"units": column.unit, "long_name": column.meaning}

        outcome = self._group("outcome")
        outcome.update(self._columns.meets(self._columns.by_band(outcome)))
        coordinates = {**self._group("trial"), **self._group("trial/input")}
        shared = self._columns.shared(coordinates["index"].values)
        coordinates.update({name: shared[name] for name in ("condition", "age") if name in shared})
        names = {name: short_name(name, list(coordinates)) for name in coordinates}
        scales = {name: outcome.pop(name) for name in ("trial", "move")}
        result = xarray.Dataset(
            {name: variable(column) for name, column in outcome.items()},
            {
                **{names[name]: variable(column) for name, column in coordinates.items()},
                **{name: variable(column) for name, column in scales.items()},
                "band": ("band", list(self.checked.bands), {"units": "count"}),
            },
            {"name": self.name},
        )
        return cast("Dataset", result)

    def trace(self, point: int | str = 0, trial: int = 0, *, plugin: str | os.PathLike[str] | None = None) -> Trace:
        """One trial again, sample by sample.

        Parameters
        ----------
        point : int or str
            Number or label of the design point.
        trial : int
            Index of the trial at the point.
        plugin : path, optional
            The controller's library, of a study with one of its own.

        Returns
        -------
        Trace

        Raises
        ------
        DataError
            If the outcome of the trial differs from the recorded one.

        Examples
        --------
        >>> t = zc.open("my-axis.h5").trace(point=2, trial=17)
        >>> t.error[-1]
        0
        """
        options = ["--point", str(self.point(point)), "--trial", str(trial)]
        options += ["--plugin", os.fspath(plugin)] if plugin is not None else []
        return replayed(self.command("trace", "--format", "json", *options), self.checked, self.point(point))

    def judge(self, point: int | str | None = None) -> JudgeAnswer:
        """Whether the goal of the manifest is met.

        Parameters
        ----------
        point : int or str, optional
            The design point; default: the best, with bounds that allow for its choice.

        Returns
        -------
        JudgeAnswer

        Raises
        ------
        ManifestError
            If the manifest has no goal.

        Examples
        --------
        >>> zc.open("my-axis.h5").judge().status
        'met'
        """
        return ask("judge", self, point=None if point is None else self.point(point))

    def report(self, output: str | os.PathLike[str]) -> pathlib.Path:
        """Write the report, one HTML page.

        Parameters
        ----------
        output : path
            An existing file is replaced.

        Returns
        -------
        pathlib.Path
        """
        self.command("report", "-o", os.fspath(output), "--force")
        return pathlib.Path(output)

    @property
    def figures(self) -> list[str]:
        """Names of the figures that `plot` draws."""
        return figure_names(self.path)

    def plot(self, name: str | None = None, *, point: int | str | None = None) -> Figure:
        """A figure of the report.

        Parameters
        ----------
        name : str, optional
            One of `figures`, or the start of one; default: the first.
        point : int or str, optional
            The design point whose trials are shown; default: the best.

        Returns
        -------
        Figure
            A notebook shows it.

        Raises
        ------
        ManifestError
            If there is no such figure.

        Examples
        --------
        >>> f = zc.open("my-axis.h5").plot("settled")
        >>> f.specification["$schema"]
        'https://vega.github.io/schema/vega-lite/v6.json'
        """
        return figure(self.path, name, None if point is None else self.point(point))
