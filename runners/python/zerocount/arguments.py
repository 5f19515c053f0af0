"""Arguments of the public functions, checked by their annotations."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import operator
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NoReturn, TypeVar

from .errors import ArgumentError

F = TypeVar("F", bound=Callable[..., Any])


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_whole(value: Any) -> bool:
    if isinstance(value, bool):
        return False
    try:
        operator.index(value)
    except TypeError:
        return False
    return True


def _is_number(value: Any) -> bool:
    return hasattr(value, "__float__") and getattr(value, "ndim", 0) == 0


def _is_mapping(value: Any) -> bool:
    return isinstance(value, Mapping) and all(map(_is_text, value))


def _is_list(value: Any) -> bool:
    return is_iterable(value) and (isinstance(value, Sequence) or hasattr(value, "tolist"))


def is_iterable(value: Any) -> bool:
    """Whether it is more than one value; a text is one."""
    return isinstance(value, Iterable) and not isinstance(value, (str, bytes)) and getattr(value, "ndim", 1) > 0


# By the name of a type in an annotation: whether a value is one, and what it is called. Others are not checked.
_KINDS: dict[str, tuple[Callable[[Any], bool], str]] = {
    "None": (lambda value: value is None, "None"),
    "str": (_is_text, "a text"),
    "int": (_is_whole, "a whole number"),
    "float": (_is_number, "a number"),
    "np.random.Generator": (lambda value: hasattr(value, "standard_normal"), "a Generator of NumPy"),
    "os.PathLike": (lambda value: isinstance(value, os.PathLike), "a path"),
    "Mapping": (_is_mapping, "a mapping by texts"),
    "Sequence": (_is_list, "a list"),
    "tuple": (_is_list, "a tuple"),
    "Iterable": (is_iterable, "values"),
    "Callable": (callable, "a function"),
    "ControlLaw": (callable, "a function of the setup of a trial"),
    "Study": (lambda value: _is_of(value, "Study"), "a Study"),
    "Results": (lambda value: _is_of(value, "Results"), "Results"),
}


def _is_of(value: Any, name: str) -> bool:
    return any(each.__name__ == name and each.__module__.startswith("zerocount") for each in type(value).__mro__)


def _alternatives(annotation: str) -> Iterator[str]:
    """The types between the bars of an annotation, without what stands in brackets."""
    depth = 0
    name = ""
    for letter in annotation:
        depth += {"[": 1, "]": -1}.get(letter, 0)
        if letter == "|" and depth == 0:
            yield name.strip()
            name = ""
        elif depth == 0 and letter != "]":
            name += letter
    yield name.strip()


def refuse(place: str, value: Any, expected: str) -> NoReturn:
    """Raise the error of an argument.

    Parameters
    ----------
    place : str
        Function and argument, such as ``"study: manifest"``.
    value : object
        What was given.
    expected : str
        What was expected.
    """
    shown = repr(value)
    shown = shown if len(shown) <= 60 else f"{shown[:60]}…"
    raise ArgumentError(f"{place} is {shown} ({type(value).__name__}); expected {expected}", 2)


def require(place: str, value: Any, annotation: str) -> None:
    """Refuse a value that the annotation does not allow.

    Parameters
    ----------
    place : str
        Function and argument.
    value : object
        What was given.
    annotation : str
        Types with ``|`` between them. One that is not known here allows every value.
    """
    kinds = [_KINDS.get(name) for name in _alternatives(annotation)]
    if not all(kinds) or any(kind[0](value) for kind in kinds if kind):
        return
    words = [kind[1] for kind in kinds if kind]
    refuse(place, value, " or ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words))


def checked(function: F) -> F:
    """The function, which refuses arguments of other types than its annotations tell.

    Parameters
    ----------
    function : callable
        With annotations that are not evaluated.

    Returns
    -------
    callable
    """
    signature = inspect.signature(function)
    given = {name: kind for name, kind in function.__annotations__.items() if isinstance(kind, str)}

    @functools.wraps(function)
    def call(*arguments: Any, **values: Any) -> Any:
        try:
            bound = signature.bind(*arguments, **values).arguments
        except TypeError:  # Python tells which argument is missing or unknown
            return function(*arguments, **values)
        for name, value in bound.items():
            parameter = signature.parameters[name]
            if parameter.kind is not parameter.VAR_KEYWORD and name in given:
                for one in value if parameter.kind is parameter.VAR_POSITIONAL else [value]:
                    require(f"{function.__name__}: {name}", one, given[name])
        return function(*arguments, **values)

    return call  # type: ignore[return-value]


def check_class(item: type) -> None:
    """Make the public methods of a class refuse arguments of other types.

    Parameters
    ----------
    item : type
        Of this package.
    """
    made = ["__call__"] if dataclasses.is_dataclass(item) else ["__init__", "__call__"]
    for name, member in list(vars(item).items()):
        if inspect.isfunction(member) and (name in made or not name.startswith("_")):
            setattr(item, name, checked(member))
