"""A study as a function of its random variables, for the tools of others."""

from __future__ import annotations

import dataclasses
import math
import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .checked import CheckedStudy
from .datasets import Array
from .errors import ManifestError, UnknownNameError
from .optional import required
from .tables import combined, short_name, succeeded

if TYPE_CHECKING:
    import openturns  # type: ignore[import]

    from .results import Results
    from .studies import Study

Numbers = npt.NDArray[np.float64]

MAX_NUMBER = 2**32
"""Trials have smaller numbers."""


@dataclasses.dataclass(frozen=True, eq=False)
class Sample:
    """A design point of a study as a function from its random variables to an outcome.

    Parameters
    ----------
    names : list of str
        Dotted keys of the variables, in the order of the columns of `x`.
    kinds : list of str
        ``value``; ``score``, the standard normal score of a profile where the trial starts; ``row`` of joint samples.
    units : list of str
        Their units.
    distributions : list of dict
        Their distributions in the form of a manifest: ``{"lognormal": {"median": 90.0, "cv": 0.2}}``.
    correlations : numpy.ndarray
        ``[variable, variable]`` correlations of the normal scores: a Gaussian copula.
    outcome : str or callable
        What `__call__` gives of each trial.
    condition : str, optional
        The condition that the trials are under; None of a study without conditions.
    """

    names: list[str]
    kinds: list[str]
    units: list[str]
    distributions: list[dict[str, Any]]
    correlations: Numbers = dataclasses.field(repr=False)
    outcome: str | Callable[[dict[str, Array]], Array]
    condition: str | None
    _study: Study = dataclasses.field(repr=False)
    _threads: int = dataclasses.field(repr=False)

    def __call__(self, x: npt.ArrayLike, *, first: int = 0) -> Any:
        """The outcome of trials with these values.

        Parameters
        ----------
        x : array_like or DataFrame
            ``[trial, variable]``, or ``[variable]`` of one trial, in the units of the variables. Of a DataFrame the
            columns with the names of the variables, in full or short as in ``Results.trials``.
        first : int
            Number of the first trial. All random numbers beside the variables, such as noise and the rest of a
            profile, follow from the number of a trial: equal numbers and values give equal outcomes.

        Returns
        -------
        numpy.ndarray or float
            ``[trial]``, or the number of one trial.

        Raises
        ------
        ManifestError
            For a value that the variable cannot have, or a wrong number of columns.
        """
        values = self._values(x)
        result = np.asarray(self._outcome_of(self.trials(values, first=first)), dtype=float)
        trials = 1 if values.ndim == 1 else len(values)
        if result.shape != (trials,):
            raise ManifestError(
                f"the outcome has the shape {result.shape} for {trials} trials; expected a function that returns a "
                "number for each trial",
                2,
            )
        return float(result[0]) if values.ndim == 1 else result

    def trials(self, x: npt.ArrayLike, *, first: int = 0) -> dict[str, Array]:
        """All measures of trials with these values.

        Parameters
        ----------
        x : array_like or DataFrame
            As in `__call__`.
        first : int
            As in `__call__`.

        Returns
        -------
        dict of str to numpy.ndarray
            ``[trial, move]`` by the name of the measure.
        """
        values = np.atleast_2d(self._values(x))
        if values.ndim != 2 or values.shape[1] != len(self.names):
            raise ManifestError(
                f"x has the shape {np.shape(x)}; expected a column for each of the {len(self.names)} variables", 2
            )
        if not 0 <= first <= MAX_NUMBER - len(values):
            raise ManifestError(f"first = {first} is out of range; expected 0 to {MAX_NUMBER - len(values)}", 2)
        numbers = np.arange(first, first + len(values))
        return self._checked.simulate(0, values, numbers, self._threads)

    @property
    def _checked(self) -> CheckedStudy:
        """The study under the condition."""
        checked = self._study.checked
        return checked if self.condition is None else checked.under(self.condition)

    def _values(self, x: Any) -> Numbers:
        """The values as numbers, those of a DataFrame by name."""
        if hasattr(x, "columns"):
            known = [str(name) for name in x.columns]
            # A short name may be that of a value, but not that of a score or a row.
            names = [
                short_name(name, self.names) if name not in known and kind == "value" else name
                for name, kind in zip(self.names, self.kinds)
            ]
            missing = [name for name in names if name not in known]
            if missing:
                raise ManifestError(f"x lacks the columns {', '.join(missing)}; it has {', '.join(known)}", 2)
            x = x[names]
        try:
            return np.asarray(x, dtype=float)
        except (TypeError, ValueError):
            raise ManifestError("x has entries that are no numbers", 2) from None

    def _outcome_of(self, measures: dict[str, Array]) -> Array:
        if callable(self.outcome):
            return self.outcome(measures)
        if self.outcome == "success":
            words = self._study.checked.descriptions["outcome"]["outcome"]["flags"]
            return succeeded(measures["outcome"], [words[number] for number in sorted(words)])
        values = measures[self.outcome]
        rule = self._study.checked.descriptions["outcome"][self.outcome]["of_trial"]
        return combined(values, rule)

    def set(self, values: Mapping[str, Any] | None = None, /, **others: Any) -> Sample:
        """The same variables, outcome and random numbers with other values of the manifest, such as gains.

        Parameters
        ----------
        values : dict, optional
            Dotted keys and values, as in `Study.set`.
        **others
            The same for keys without a dot.

        Returns
        -------
        Sample

        Raises
        ------
        ManifestError
            If the variables would be others.
        """
        result = sample(
            self._study.set(values, **others), outcome=self.outcome, condition=self.condition, threads=self._threads
        )
        if (result.names, result.distributions) != (self.names, self.distributions):
            raise ManifestError(f"the variables would not be the same {', '.join(self.names)}; set what is none of them", 2)
        return result

    def draw(self, size: int, *, rng: int | np.random.Generator = 0, seed: int | None = None) -> Numbers:
        """Values of the variables from their joint distribution.

        Parameters
        ----------
        size : int
            Number of trials.
        rng : int or numpy.random.Generator
            Source of random numbers, or its seed.
        seed : int, optional
            Deprecated: ``rng``.

        Returns
        -------
        numpy.ndarray
            ``[trial, variable]``.
        """
        if seed is not None:
            warnings.warn("draw: seed is called rng", DeprecationWarning, stacklevel=3)
        factor = np.linalg.cholesky(self.correlations)
        source = np.random.default_rng(rng if seed is None else seed)
        scores = source.standard_normal((size, len(self.names))) @ factor.T
        return self._checked.values_at_scores(0, scores)

    @property
    def distribution(self) -> openturns.Distribution:
        """The joint distribution of the variables, for OpenTURNS."""
        openturns = required("openturns", "the joint distribution")
        marginals = [_openturns(openturns, form) for form in self.distributions]
        matrix = openturns.CorrelationMatrix(self.correlations.tolist())
        copula = openturns.NormalCopula(matrix)
        joint = openturns.ComposedDistribution(marginals, copula)
        joint.setDescription(self.names)
        return joint

    @property
    def function(self) -> openturns.Function:
        """The outcome as a function for OpenTURNS, which calls it with whole samples."""
        openturns = required("openturns", "the function")
        result = openturns.PythonFunction(
            len(self.names),
            1,
            func=lambda x: [self(np.asarray(x))],
            func_sample=lambda x: self(np.asarray(x))[:, np.newaxis],
        )
        result.setInputDescription(self.names)
        result.setOutputDescription([self.outcome if isinstance(self.outcome, str) else "outcome"])
        return result


def sample(
    study: Study | Results | str | os.PathLike[str] | Mapping[str, Any],
    point: int | str = 0,
    *,
    outcome: str | Callable[[dict[str, Array]], Array] = "success",
    condition: str | None = None,
    threads: int | None = None,
) -> Sample:
    """A design point of a study as a function from its random variables to an outcome, in this process.

    The variables are what the manifest draws for each trial or machine. Each trial is on a machine of its own. Of a
    profile along the axis they are its mean, if that is drawn, and the standard normal score of the profile where the
    trial starts. A row of joint samples is one variable, its number.

    Parameters
    ----------
    study : Study, Results, path or dict of a manifest
        The study.
    point : int or str
        Number or label of the design point. The sample is of the study at this point, without its sweep.
    outcome : str or callable
        ``"success"`` (zero counts at the end of every move), or the name of a measure, combined over the moves as
        in ``Results.trials``, or a function of the measures ``{name: [trial, move]}``.
    condition : str, optional
        Name of the condition that the trials are under, in a study with conditions.
    threads : int, optional
        Default: all cores.

    Returns
    -------
    Sample

    Raises
    ------
    ManifestError
        If there is no such measure, point or condition, or nothing is drawn.

    Examples
    --------
    >>> f = zc.sample("my-axis.yaml", point=2, outcome="arrival_time")
    >>> f.names
    ['friction.k1', 'friction.k2', 'friction.beta', 'friction.alpha', 'command.targets.0', 'initial.encoder_phase']
    >>> f([90, 600, 1e5, 0.5, 20, 0.5])
    0.14475
    """
    from .results import Results
    from .studies import study as study_of

    subject = (study.study if isinstance(study, Results) else study_of(study)).at(point)
    if condition is None and subject.conditions:
        raise ManifestError(f"a sample needs one condition; expected condition= one of {', '.join(subject.conditions)}", 2)
    variables = (subject.checked if condition is None else subject.checked.under(condition)).variables(0)
    measures = subject.checked.descriptions["outcome"]
    if not variables["names"]:
        raise ManifestError(f"{subject.name}: nothing is drawn for its trials; expected a distribution", 2)
    if threads is not None and threads < 1:
        raise ManifestError(f"threads = {threads} is out of range; expected at least 1", 2)
    if isinstance(outcome, str) and outcome != "success" and outcome not in measures:
        raise UnknownNameError(f"there is no measure {outcome!r}; expected success or one of {', '.join(measures)}", 2)
    return Sample(
        variables["names"],
        variables["kinds"],
        variables["units"],
        variables["distributions"],
        variables["correlations"],
        outcome,
        condition,
        subject,
        threads or len(os.sched_getaffinity(0)),
    )


def _openturns(openturns: Any, form: dict[str, Any]) -> Any:
    """A distribution of a manifest as one of OpenTURNS."""
    ((kind, given),) = form.items()
    if kind == "uniform":
        return openturns.Uniform(*given)
    if kind == "log_uniform":
        return openturns.LogUniform(*map(math.log, given))
    if kind == "normal":
        return openturns.Normal(given["mean"], given["sd"])
    if kind == "truncated_normal":
        return openturns.TruncatedNormal(given["mean"], given["sd"], given["low"], given["high"])
    if kind == "lognormal":
        return openturns.LogNormal(math.log(given["median"]), math.sqrt(math.log1p(given["cv"] ** 2)), 0.0)
    if kind == "triangular":
        return openturns.Triangular(*given)
    values: Sequence[float] = range(int(given[0]), int(given[1]) + 1) if kind == "integers" else given
    return openturns.UserDefined([[float(value)] for value in values])
