"""Studies: manifests that are checked, varied and run."""

from __future__ import annotations

import functools
import math
import operator
import os
import pathlib
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from . import program
from .answer_types import CheckAnswer
from .asking import ask
from .checked import CheckedStudy, checked_study, manifest_tree
from .errors import MachineError, ManifestError, UnknownNameError
from .manifests import flow_text, yaml_text
from .options import options
from .progress import progress_bar
from .results import Results
from .wording import counted
from .workers import run_on_workers


def study(manifest: str | os.PathLike[str] | Mapping[str, Any] | Study) -> Study:
    """A study from a manifest.

    Parameters
    ----------
    manifest : path or mapping
        A YAML file, or the same keys and values as a dict. Files that a dict names are found from the current
        folder, those that a file names from its own. A study is given back as it is.

    Returns
    -------
    Study

    Raises
    ------
    ManifestError
        With the place and the key of every error. The manifest must be complete: with gains in SI units, say, it
        needs a value of the integral gain or a sweep of it.

    Examples
    --------
    >>> s = zc.study("my-axis.yaml")
    >>> s
    <Study 'my-axis': 8 design points × 2000 trials>
    """
    if isinstance(manifest, Study):
        return manifest
    if isinstance(manifest, Mapping):
        result = Study(yaml_text(manifest), "<dict>", pathlib.Path.cwd())
    else:
        path = pathlib.Path(manifest)
        result = Study(_text_of(path), str(path), path.resolve().parent)
    result.checked
    return result


def shipped(name: str) -> Study:
    """A study that comes with the program.

    Parameters
    ----------
    name : str
        One of those that ``zerocount new --list`` lists.

    Returns
    -------
    Study

    Raises
    ------
    ManifestError
        If there is none of this name; the message lists them.

    Examples
    --------
    >>> zc.shipped("paper-gains").labels
    ['a', 'b', 'b-with-kp', 'c', 'above-upper']
    """
    return Study(program.run(["new", name, "-o", "-"])[1], name, pathlib.Path.cwd())


def _text_of(path: pathlib.Path) -> str:
    """The text of a manifest, with its line ends as they are: they are a part of the hash."""
    try:
        return path.read_bytes().decode("utf-8")
    except FileNotFoundError:
        raise ManifestError(f"{path}: no such file; expected a manifest", 2) from None
    except (IsADirectoryError, UnicodeDecodeError):
        raise ManifestError(f"{path}: not a text in UTF-8; expected a manifest", 2) from None
    except OSError as error:
        raise MachineError(f"{path}: cannot be read: {error.strerror}", 5) from None


class Study:
    """A manifest, and the settings that vary it. It does not change: `set`, `sweep` and `without` give others,
    which are checked when something is asked of them.

    Attributes
    ----------
    text : str
        The manifest, without the settings.
    """

    def __init__(self, text: str, source: str, folder: pathlib.Path, overrides: Iterable[str] = ()) -> None:
        self.text = text
        self._overrides = list(overrides)
        self._source = source
        self._folder = folder

    @functools.cached_property
    def checked(self) -> CheckedStudy:
        """What is known of the study, and its trials in this process.

        Raises
        ------
        ManifestError
            If the manifest with the settings is wrong.
        """
        return checked_study(self.text, self._source, self._folder, self._overrides)

    def __repr__(self) -> str:
        try:
            self.checked
        except ManifestError as error:
            return f"<Study {self._source} with an error: {error.problems[0].text}>"
        return f"<Study {self.name!r}: {counted(len(self.labels), 'design point')} × {counted(self.trials, 'trial')}>"

    @property
    def settings(self) -> dict[str, str]:
        """Dotted keys and the values that take the place of the manifest's, as YAML."""
        return {key: value for key, _, value in (text.partition("=") for text in self._overrides)}

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "checked"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        if not self._folder.is_dir():  # it comes from another machine
            self._folder = pathlib.Path.cwd()

    def set(self, values: Mapping[str, Any] | None = None, /, **others: Any) -> Study:
        """This study with other values.

        Parameters
        ----------
        values : dict, optional
            Dotted keys of the manifest and their values: ``{"controller.delay": 1}``.
        **others
            The same for keys without a dot: ``trials=1000``.

        Returns
        -------
        Study

        Raises
        ------
        ManifestError
            For a value that a manifest cannot have. Whether the keys exist is checked later, and that they have
            an effect: a key that is swept at all points has none.

        Examples
        --------
        >>> s = zc.study("my-axis.yaml").set({"controller.delay": 1}, trials=1000)
        >>> s.trials
        1000
        """
        changed = {key: flow_text(value) for key, value in {**(values or {}), **others}.items()}
        kept = [text for text in self._overrides if text.partition("=")[0] not in changed]
        return Study(self.text, self._source, self._folder, kept + [f"{key}={value}" for key, value in changed.items()])

    def sweep(self, key: str, values: Iterable[Any] | Mapping[str, Any]) -> Study:
        """This study at several values of a key. With a sweep of another key, at every pair.

        Parameters
        ----------
        key : str
            Dotted key of the manifest.
        values : iterable or dict
            In the key's unit, or as in a manifest: ``{"logspace": [5e3, 1e5, 8]}``. They take the place of a sweep
            of the same key.

        Returns
        -------
        Study

        Examples
        --------
        >>> s = zc.study("my-axis.yaml").sweep("controller.ki", np.geomspace(5e3, 1e5, 4))
        >>> len(s.labels)
        4
        """
        return self.set({f"sweep.grid.{key}": values if isinstance(values, Mapping) else list(values)})

    def at(self, point: int | str) -> Study:
        """This study at one of its design points, without a sweep.

        Parameters
        ----------
        point : int or str
            Number or label.

        Returns
        -------
        Study
            The same trials, if the points share their random numbers as they do by default.

        Raises
        ------
        ManifestError
            If there is no such point, or it gives a swept key a distribution.

        Examples
        --------
        >>> zc.study("my-axis.yaml").at(2).settings
        {'controller.ki': '11767.7344682513'}
        """
        number = point_number(point, self.labels, self.name)
        sweep = self.to_dict().get("sweep") or {}
        axes = {axis["name"]: axis["values"][number] for axis in self.checked.axes}
        values: dict[str, Any] = dict(sweep["cases"][axes["case"]] or {}) if "case" in axes else {}
        for key in sweep.get("grid") or {}:
            values[key] = _swept_value(self.name, key, axes)
        return self.without("sweep", "observed").set(values) if sweep else self

    def without(self, *keys: str) -> Study:
        """This study without some keys of the manifest, which then have their defaults.

        Parameters
        ----------
        *keys : str
            Dotted keys, such as ``"sweep"`` or ``"controller.kp"``. Keys that the manifest lacks are ignored.

        Returns
        -------
        Study
            Its manifest is written anew, without comments.

        Examples
        --------
        >>> s = zc.study("my-axis.yaml").without("sweep").set({"controller.ki": 1e4})
        >>> len(s.labels)
        1
        """
        tree = self.to_dict()
        for key in keys:
            *path, last = key.split(".")
            place: Any = tree
            for part in path:
                place = place.get(part, {}) if isinstance(place, dict) else {}
            if isinstance(place, dict):
                place.pop(last, None)
        return Study(yaml_text(tree), f"<{self._source} without {', '.join(keys)}>", self._folder)

    def to_dict(self) -> dict[str, Any]:
        """The manifest with its settings as a dict, to be changed and given to `study` again.

        Returns
        -------
        dict

        Examples
        --------
        >>> d = zc.study("my-axis.yaml").to_dict()
        >>> d["friction"]["k1"]
        {'lognormal': {'median': 90, 'cv': 0.2}}
        >>> d["friction"]["k1"] = 90
        >>> zc.study(d).trials
        2000
        """
        return manifest_tree(self.text, self._source, self._overrides)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the manifest with its settings as a YAML file. Without settings it stays as it was written.

        Parameters
        ----------
        path : path
            An existing file is replaced. Files that the manifest names are found from its folder.

        Raises
        ------
        MachineError
            If it cannot be written.
        """
        text = yaml_text(self.to_dict()) if self.settings else self.text
        try:
            pathlib.Path(path).write_bytes(text.encode())
        except OSError as error:
            raise MachineError(f"{path}: cannot be written: {error.strerror}", 5) from None

    @property
    def name(self) -> str:
        """Name of the study."""
        return self.checked.name

    @property
    def trials(self) -> int:
        """Trials at each design point."""
        return self.checked.trials

    @property
    def machines(self) -> int:
        """Machines that share the trials; 0 if each trial is on one of its own."""
        return self.checked.machines

    @property
    def worlds(self) -> int:
        """Worlds, of which nobody knows in which all machines are; 0 if nothing is drawn per world."""
        return self.checked.worlds

    @property
    def conditions(self) -> list[str]:
        """Names of the conditions under which every machine runs; empty: there is one, which the manifest describes.

        With ages each condition at each age: ``loaded, 100000 cycles``.
        """
        return self.checked.conditions

    @property
    def ages(self) -> list[float]:
        """Ages of every machine, in the unit of the manifest; empty: nothing changes with age."""
        return self.checked.ages

    @property
    def moves(self) -> int:
        """Moves of each trial."""
        return self.checked.moves

    @property
    def labels(self) -> list[str]:
        """Labels of the design points, in their order."""
        return self.checked.labels

    @property
    def warnings(self) -> list[str]:
        """What may not be as intended."""
        return self.checked.warnings

    @property
    def sha256(self) -> str:
        """Hash of all that determines the trials."""
        return self.checked.sha256

    @property
    def observed(self) -> dict[str, str]:
        """What was observed on a real axis, by the label of the design point."""
        return self.checked.observed

    @property
    def goal(self) -> dict[str, Any] | None:
        """The only goal: ``band`` (counts) or ``tolerance``, ``within`` or ``after_profile`` (s), ``moves``, ``machines``, ``confidence``, ``on``, ``limits``, ``of`` (mass), ``measure``.

        None where there is no goal, or several: see `goals`.
        """
        return self.checked.goal

    @property
    def goals(self) -> list[dict[str, Any]]:
        """All goals, each as `goal` with its ``name``; all of them must be met."""
        return self.checked.goals

    def command(
        self,
        name: str,
        *options: str,
        accepted: frozenset[int] = frozenset({0}),
        progress: Callable[[str], None] | None = None,
    ) -> str:
        """Run a command of the program on the manifest.

        Parameters
        ----------
        name : str
            Such as ``"limits"``.
        *options : str
            Such as ``"--point", "3"``. Paths are seen from the folder of the manifest.
        accepted : frozenset of int
            Exit codes that are no error.
        progress : callable, optional
            Is given each line of progress.

        Returns
        -------
        str
            Standard output.
        """
        settings = [word for override in self._overrides for word in ("--set", override)]
        words = [name, "-", *settings, *options]
        self.checked  # errors of the manifest have its places here
        return program.run(words, text=self.text, folder=self._folder, accepted=accepted, progress=progress)[1]

    def check(self) -> CheckAnswer:
        """The plan of the study and the theory of its points.

        Returns
        -------
        CheckAnswer

        Examples
        --------
        >>> zc.study("my-axis.yaml").check().theory.loc[2, "sampled"]
        'stable'
        """
        return ask("check", self)

    def run(
        self,
        output: str | os.PathLike[str],
        *,
        threads: int | None = None,
        watch: str | os.PathLike[str] | None = None,
        force: bool = False,
        progress: bool = True,
        client: Any = None,
        parts: int | None = None,
    ) -> Results:
        """Run the trials on all cores, or on the workers of a Dask cluster, or continue an earlier run.

        Parameters
        ----------
        output : path
            The results file. A file of the same study is completed or extended; a finished one is opened.
        threads : int, optional
            Threads to use; default: all cores. On workers those of each part; default: 1.
        watch : path, optional
            A page (``*.html``) for a browser that shows how far the run is, and at the end its report. Of a run on
            this machine.
        force : bool
            Replace the results of another study.
        progress : bool
            Show a bar in a terminal or a notebook.
        client : distributed.Client, optional
            Of a Dask cluster, whose workers run the study in parts. Without it, or where the output exists, this
            machine runs the trials.
        parts : int, optional
            Number of parts on workers; default: 4 for each of their threads.

        Returns
        -------
        Results

        Raises
        ------
        ManifestError
            If the file holds the results of another study, or an option is of the other kind of run.
        MachineError
            If the machine failed, or every worker that tried a part.
        KeyboardInterrupt
            If it is interrupted. The finished trials are kept, on workers the finished parts: the same call goes on
            with the others.

        Examples
        --------
        >>> r = zc.study("my-axis.yaml").run("my-axis.h5")
        >>> r.table.loc[2, "success_rate"]
        0.3755

        On a cluster, here of this process:

        >>> import distributed
        >>> with distributed.Client(processes=False, dashboard_address=None) as client:
        ...     r = zc.study("my-axis.yaml").set(machines=100, trials=200).run("on-workers.h5", client=client)
        >>> len(r.trials(2))
        200
        """
        if client is None and parts is not None:
            raise ManifestError("parts: a run on this machine has none; expected a client beside it", 2)
        if client is not None and watch is not None:
            raise ManifestError("watch: a run on workers has no page; expected either a client or a page", 2)
        place = pathlib.Path(output).absolute()
        page = None if watch is None else pathlib.Path(watch)
        with progress_bar(self.name, progress) as bar:
            if client is None or (place.exists() and not force):
                self.command("run", *options(output=place, threads=threads, watch=page, force=force), progress=bar)
            else:
                run_on_workers(self, place, client, parts=parts, threads=threads, force=force, progress=bar)
        return Results(output)


def _swept_value(study: str, key: str, axes: Mapping[str, Any]) -> Any:
    """The value of a swept key at a point: that of its axis, or a list of those of its entries."""
    parts = [axes[key]] if key in axes else [value for name, value in axes.items() if name.startswith(f"{key}.")]
    if not parts or any(isinstance(part, float) and math.isnan(part) for part in parts):
        raise ManifestError(f"{study}: {key} has a distribution at the point; expected a number", 2)
    whole = [int(part) if isinstance(part, float) and part.is_integer() else part for part in parts]
    return whole[0] if key in axes else whole


def point_number(point: int | str, labels: list[str], where: object) -> int:
    """The number of a design point that is given by its number or label, also a label as tables shorten it: ``ki=5000``.

    Parameters
    ----------
    point : int or str
        Number or label.
    labels : list of str
        Of the points.
    where : object
        Begins the message of an error.
    """
    if isinstance(point, str) and (named := _point_named(point, labels)) is not None:
        return named
    if hasattr(point, "__index__") and 0 <= operator.index(point) < len(labels):
        return operator.index(point)
    message = f"{where}: there is no point {point!r}; expected 0 to {len(labels) - 1} or a label"
    raise UnknownNameError(message, 2) if isinstance(point, str) else ManifestError(message, 2)


def _point_named(name: str, labels: list[str]) -> int | None:
    """The point of this name, as the program reads it: its number, its label, the label with the paths of keys shortened
    to their ends, or both: ``3 (ki=5000)``. A whole number is always the number of a point. None where no point, or more
    than one, has the name."""
    if (number := _whole(name)) is not None and number < len(labels):
        return number
    if name in labels:
        return labels.index(name)
    short = [point for point, label in enumerate(labels) if _shortens(name, label)]
    if len(short) == 1:
        return short[0]
    first, bracket, rest = name.partition(" (")
    number = _whole(first)
    if bracket and name.endswith(")") and number is not None and number < len(labels) and _shortens(rest[:-1], labels[number]):
        return number
    return None


def _whole(text: str) -> int | None:
    return int(text) if text.isascii() and text.isdigit() else None


def _shortens(name: str, label: str) -> bool:
    """Whether the name is the label, in which ``controller.ki=5000`` may be ``ki=5000``."""
    ours, its = ([word.removesuffix(",") for word in text.split(" ") if word] for text in (name, label))
    return len(ours) == len(its) and all(
        word == whole or ("=" in word and whole.endswith(f".{word}") and len(whole) - len(word) < whole.index("="))
        for word, whole in zip(ours, its)
    )
