"""What a sweep is asked to do, judged before anything runs: names, options, guesses."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from drakegait.errors import InvalidInput, UnknownName
from drakegait.solvers.options import SolverOptions
from drakegait.study import GaitStudy
from drakegait.sweep.identity import study_key

LONGEST_NAME = 200
_NAME = re.compile(rf"[\w=+,()\[\]~ -][\w.=+,()\[\]~ -]{{0,{LONGEST_NAME - 1}}}", re.ASCII)
_RESERVED = ("sweep.nc", "sweep.csv", "sweep.svg", "sweep.png")


@dataclass(frozen=True)
class Plan:
    """Studies by name, in order, with their keys and guesses.

    Args:
        studies: by name; a name is also that of the study's folder.
        warm: name of a study -> name of the study whose gait is its guess.
        options: of the solver, for all studies or by name.
        refine: as `solve` takes it.

    Raises:
        InvalidInput, UnknownName: the first thing that cannot be used.
    """

    studies: Mapping[str, GaitStudy]
    warm: Mapping[str, str]
    options: Mapping[str, SolverOptions]
    refine: bool
    keys: Mapping[str, str] = field(init=False)

    @classmethod
    def make(
        cls,
        studies: Mapping[str, GaitStudy],
        warm: Mapping[str, str] | None,
        options: SolverOptions | Mapping[str, SolverOptions] | None,
        refine: bool,
    ) -> Plan:
        """The plan of what `sweep` was called with."""
        if not isinstance(studies, Mapping) or not studies:
            raise InvalidInput("studies", studies, "a mapping with at least one name -> GaitStudy")
        if not isinstance(warm or {}, Mapping):
            raise InvalidInput("warm", warm, "a mapping, name of a study -> name of its guess")
        if not isinstance(options, Mapping):
            options = dict.fromkeys(studies, options or SolverOptions())
        return cls(dict(studies), dict(warm or {}), options, bool(refine))

    def __post_init__(self) -> None:
        folders: dict[str, str] = {}
        for name, study in self.studies.items():
            _check_name(name, folders)
            if not isinstance(study, GaitStudy):
                raise InvalidInput(f"study {name!r}", study, "a GaitStudy")
            if not isinstance(self.options.get(name), SolverOptions):
                raise InvalidInput(f"options of {name!r}", self.options.get(name), "SolverOptions")
        for name, guess in self.warm.items():
            self._check_guess(name, guess)
        keys = {
            name: study_key(study, self.options[name], self.refine)
            for name, study in self.studies.items()
        }
        object.__setattr__(self, "keys", keys)

    def _check_guess(self, name: str, guess: str) -> None:
        for role, given in (("study in warm", name), ("guess in warm", guess)):
            if given not in self.studies:
                raise UnknownName(role, given, self.studies)
        ours, theirs = self.studies[name].skeleton_kind, self.studies[guess].skeleton_kind
        if ours != theirs:
            allowed = f"a study of a {ours} walker, as {name!r} is, not of a {theirs} one"
            raise InvalidInput(f"guess of {name!r}", guess, allowed)
        seen = [name]
        while guess is not None:
            if guess in seen:
                around = " <- ".join([*seen, guess])
                raise InvalidInput("warm", around, "without a circle")
            seen.append(guess)
            guess = self.warm.get(guess)


def _check_name(name: object, folders: dict[str, str]) -> None:
    """Refuse what is no name of a folder on every system."""
    fits = isinstance(name, str) and _NAME.fullmatch(name) and name == name.strip()
    if not fits or name in _RESERVED or name.endswith("."):
        allowed = (
            f"the name of a folder: 1 to {LONGEST_NAME} letters, digits, spaces or _ - + = , . ~ "
            "( ) [ ], no dot first"
        )
        raise InvalidInput("name of a study", name, allowed)
    twin = folders.setdefault(name.lower(), name)
    if twin != name:
        raise InvalidInput("name of a study", name, f"unlike {twin!r} in more than capitals")
