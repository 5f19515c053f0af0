"""Studies: manifests that are checked, varied and run."""

from __future__ import annotations

import functools
import os
import pathlib
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import _zerocount

from . import program
from .errors import MachineError, ManifestError
from .manifests import flow_text, yaml_text
from .progress import progress_bar
from .results import Results
from .wording import counted

def study(manifest: str | os.PathLike[str] | Mapping[str, Any]) -> Study:
    """A study from a manifest.

    Parameters
    ----------
    manifest : path or mapping
        A YAML file, or the same keys and values as a dict. Files that a dict names are found from the current
        folder, those that a file names from its own.

    Returns
    -------
    Study

    Raises
    ------
    ManifestError
        With the place and the key of every error.

    Examples
    --------
    >>> s = zc.study("my-axis.yaml")
    >>> s
    <Study 'my-axis': 8 design points × 2000 trials>
    """
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
        If there is none of this name; the message has the nearest.

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
    settings : dict of str to str
        Dotted keys and the values that take the place of the manifest's, as YAML.
    """

    def __init__(
        self, text: str, source: str, folder: pathlib.Path, settings: Mapping[str, str] | None = None
    ) -> None:
        self.text = text
        self.settings = dict(settings or {})
        self._source = source
        self._folder = folder

    @functools.cached_property
    def checked(self) -> _zerocount.Study:
        """The study in this process.

        Raises
        ------
        ManifestError
            If the manifest with the settings is wrong.
        """
        return _zerocount.Study(self.text, self._source, self._folder, self._overrides)

    def __repr__(self) -> str:
        return f"<Study {self.name!r}: {counted(len(self.labels), 'design point')} × {counted(self.trials, 'trial')}>"

    @property
    def _overrides(self) -> list[str]:
        return [f"{key}={value}" for key, value in self.settings.items()]

    def set(self, **values: Any) -> Study:
        """This study with other values.

        Parameters
        ----------
        **values
            Dotted keys of the manifest and their values: ``**{"controller.delay": 1}``.

        Returns
        -------
        Study

        Raises
        ------
        ManifestError
            For a value that a manifest cannot have. Whether the keys exist is checked later.

        Examples
        --------
        >>> s = zc.study("my-axis.yaml").set(trials=1000, **{"controller.delay": 1})
        >>> s.trials
        1000
        """
        changed = {key: flow_text(value) for key, value in values.items()}
        kept = {key: value for key, value in self.settings.items() if key not in changed}
        return Study(self.text, self._source, self._folder, {**kept, **changed})

    def sweep(self, key: str, values: Iterable[Any]) -> Study:
        """This study at several values of a key. With a sweep of another key, at every pair.

        Parameters
        ----------
        key : str
            Dotted key of the manifest.
        values : iterable
            In the key's unit. They take the place of a sweep of the same key.

        Returns
        -------
        Study

        Examples
        --------
        >>> s = zc.study("my-axis.yaml").sweep("controller.ki", np.geomspace(5e3, 1e5, 4))
        >>> len(s.labels)
        4
        """
        return self.set(**{f"sweep.grid.{key}": list(values)})

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
        >>> s = zc.study("my-axis.yaml").without("sweep").set(**{"controller.ki": 1e4})
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
        return Study(yaml_text(tree), f"{self.name} without {', '.join(keys)}", self._folder)

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
        tree: dict[str, Any] = _zerocount.manifest_tree(self.text, self._source, self._overrides)
        return tree

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the manifest with its settings as a YAML file. Without settings it stays as it was written.

        Parameters
        ----------
        path : path
            An existing file is replaced.
        """
        text = yaml_text(self.to_dict()) if self.settings else self.text
        pathlib.Path(path).write_text(text, encoding="utf-8")

    @property
    def name(self) -> str:
        """Name of the study."""
        return self.checked.name

    @property
    def trials(self) -> int:
        """Trials at each design point."""
        return self.checked.trials

    @property
    def rigs(self) -> int:
        """Machines that share the trials; 0 if each trial is on one of its own."""
        return self.checked.rigs

    @property
    def worlds(self) -> int:
        """Worlds, of which nobody knows in which all machines are; 0 if nothing is drawn per world."""
        return self.checked.worlds

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
        """The goal: ``band`` (counts), ``within`` (s), ``moves``, ``machines`` and ``confidence``; or None."""
        return self.checked.goal

    def command(
        self,
        name: str,
        *options: str,
        accepted: frozenset[int] = frozenset({0}),
        progress: Callable[[str], None] | None = None,
    ) -> tuple[int, str]:
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
        code : int
            Exit code.
        output : str
            Standard output.
        """
        settings = [word for override in self._overrides for word in ("--set", override)]
        return program.run(
            [name, "-", *settings, *options], text=self.text, folder=self._folder, accepted=accepted, progress=progress
        )

    def check(self) -> str:
        """The plan of the study and the theory of its points, as ``zerocount check`` prints them.

        Returns
        -------
        str
        """
        return self.command("check")[1]

    def run(
        self,
        output: str | os.PathLike[str],
        *,
        threads: int | None = None,
        force: bool = False,
        progress: bool = True,
    ) -> Results:
        """Run the trials on all cores, or continue an earlier run.

        Parameters
        ----------
        output : path
            The results file. A file of the same study is completed or extended; a finished one is opened.
        threads : int, optional
            Threads to use; default: all cores.
        force : bool
            Replace the results of another study.
        progress : bool
            Show a bar in a terminal or a notebook.

        Returns
        -------
        Results

        Raises
        ------
        ManifestError
            If the file holds the results of another study.
        KeyboardInterrupt
            If it is interrupted. The finished trials are kept: the same call goes on with the others.

        Examples
        --------
        >>> r = zc.study("my-axis.yaml").run("my-axis.h5")
        >>> r.table.loc[2, "success_rate"]
        0.7225
        """
        options = ["-o", str(pathlib.Path(output).resolve())]
        options += ["--threads", str(threads)] if threads is not None else []
        options += ["--force"] if force else []
        with progress_bar(self.name, progress) as bar:
            self.command("run", *options, progress=bar)
        return Results(output)

