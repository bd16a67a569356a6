"""The answer of a solve: one stride, with everything that can be read from it.

    gait = solve(GaitStudy.spatial())
    gait.speed, gait.metabolic.cost_of_transport
    gait.sample().activation.sel(muscle="soleus_r").plot()
    gait.save("gait.nc")
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drakegait.errors import InvalidInput, UnknownName
from drakegait.loads import muscle_inputs
from drakegait.motion import Motion
from drakegait.program.kkt import KktMultipliers
from drakegait.solvers.outcome import Outcome
from drakegait.study import GaitStudy
from drakegait.transcription.design_vector import DesignValues
from drakegait.transcription.foot_placement import FootPlacement
from drakegait.transcription.splines import PeriodicQuintic
from drakegait.walker import coordinates, feet

if TYPE_CHECKING:
    import xarray as xr

    from drakegait.check import CheckReport
    from drakegait.sensitivities import Sensitivities

ENERGY_INSTANTS = 1000


@dataclass(frozen=True)
class Metabolic:
    """Metabolic energy per metre walked, by the exact laws without smoothing.

    Attributes:
        cost_of_transport: E^t of eq. (8) [J/m], with the basal rate if the study has one.
        by_muscle: share of each muscle [J/m], by name.
        basal: share of the body besides its muscles [J/m].
    """

    cost_of_transport: float
    by_muscle: Mapping[str, float]
    basal: float


@dataclass(frozen=True, eq=False)
class Gait:
    """One stride of walking, found by `solve`, converged or not.

    Attributes:
        study: the experiment.
        values: the unknowns in full; contact forces at the control points.
        outcome: how the solve ended.
        cost: `total` f of eq. (13) and its weighted parts as the solver saw them (smoothed
            energy); empty for a gait that no solver has judged.
        report: the result of `check`, if it was made.
        kkt: multipliers of the program's rows and bounds, if a solver found an optimum.

    Raises:
        InvalidInput: if the arrays in `values` do not belong to `study`.
    """

    study: GaitStudy
    values: DesignValues
    outcome: Outcome
    cost: Mapping[str, float]
    report: CheckReport | None = None
    kkt: KktMultipliers | None = None

    def __post_init__(self) -> None:
        intervals = self.study.nodes - 1
        sizes = {
            "coordinate_coefficients": (len(self.coordinate_names), intervals),
            "force_coefficients": (len(self.muscle_names), intervals),
            "stride_time": (),
            "events": (feet.NUM_PHASES,),
            "placement": (5,),
            "multipliers": (len(self.values.multipliers), self._contact_rows),
        }
        for name, shape in sizes.items():
            value = np.asarray(getattr(self.values, name))
            if value.shape != shape:
                raise InvalidInput(f"shape of {name}", value.shape, f"{shape} for this study")
        if not self.values.stride_time > 0.0:
            raise InvalidInput("stride_time", self.values.stride_time, "above 0 [s]")

    @property
    def _contact_rows(self) -> int:
        torques = self.study.contact.toe_torque
        return feet.NUM_ROWS_WITH_TORQUES if torques else feet.NUM_ROWS

    # Names and numbers -------------------------------------------------------------------

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        """Names of the coordinates, in order."""
        return coordinates.names(self.study.skeleton_kind)

    @property
    def muscle_names(self) -> tuple[str, ...]:
        """Names of the muscles, in order."""
        return self.study.walker.muscles.names

    @cached_property
    def splines(self) -> PeriodicQuintic:
        """Function space of coordinates and muscle forces."""
        return PeriodicQuintic(self.study.nodes)

    @cached_property
    def placement(self) -> FootPlacement:
        """Where the feet stand."""
        names = [field.name for field in dataclasses.fields(FootPlacement)]
        numbers = (float(x) for x in self.values.placement)
        return FootPlacement(**dict(zip(names, numbers, strict=True)))

    @property
    def stride_time(self) -> float:
        """T [s]."""
        return float(self.values.stride_time)

    @property
    def stride_length(self) -> float:
        """L_R + L_L [m]."""
        return self.placement.stride_length

    @property
    def phase_durations(self) -> np.ndarray:
        """t_ph (8,) [s]."""
        return self.values.phase_durations

    @property
    def speed(self) -> float:
        """Average forward velocity [m/s]."""
        return self.stride_length / self.stride_time

    @property
    def converged(self) -> bool:
        """Whether the solver met its tolerances."""
        return self.outcome.converged

    def phase_of(self, tau: np.ndarray) -> np.ndarray:
        """Contact phase (...,), 0 to 7, at fractions tau of the stride; events open their phase."""
        fraction = np.asarray(tau, dtype=float) % 1.0
        return np.clip(np.searchsorted(self.values.events, fraction, side="right") - 1, 0, 7)

    def motion(self, tau: np.ndarray) -> Motion:
        """Coordinates and muscle forces at fractions tau (K,) of the stride; may exceed 1."""
        tau = np.atleast_1d(np.asarray(tau, dtype=float))
        basis = [self.splines.dense_basis(tau, order) for order in range(3)]
        values = self.values
        return Motion.from_derivatives(
            tau,
            self.stride_time,
            self.stride_length,
            tuple(weights @ values.coordinate_coefficients.T for weights in basis),
            tuple(weights @ values.force_coefficients.T for weights in basis),
        )

    @cached_property
    def metabolic(self) -> Metabolic:
        """Cost of transport and what each muscle takes of it."""
        walker = self.study.walker
        motion = self.motion(np.arange(ENERGY_INSTANTS) / ENERGY_INSTANTS)
        power = walker.muscle_functions.states(muscle_inputs(walker, motion))["power"].mean(axis=0)
        basal = walker.energy_settings.basal_power(walker.subject.mass) / self.speed
        shares = {name: float(p) for name, p in zip(self.muscle_names, power / self.speed,
                                                    strict=True)}  # fmt: skip
        return Metabolic(sum(shares.values()) + basal, shares, basal)

    def sample(self, num: int = 201) -> xr.Dataset:
        """Labelled arrays with units from 0 to 100 % of the stride, see `drakegait.sampling`."""
        from drakegait.sampling import sample

        return sample(self, num).dataset()

    # Nodal values ------------------------------------------------------------------------

    @property
    def nodal_values(self) -> dict[str, np.ndarray]:
        """Values at the nodes by name of coordinate or muscle, (nodes - 1,) each.

        Anatomical signs [rad, m] and [N]; hat_x without its steady advance. The last node is the
        first of the next stride and is left out.
        """
        signs = coordinates.anatomical_signs(self.study.skeleton_kind)[:, None]
        motion = signs * self.splines.nodal_values(self.values.coordinate_coefficients)
        forces = self.splines.nodal_values(self.values.force_coefficients)
        names = (*self.coordinate_names, *self.muscle_names)
        return dict(zip(names, [*motion, *forces], strict=True))

    def with_nodal_values(self, **values: np.ndarray) -> Gait:
        """A copy in which some coordinates or muscle forces take other values at the nodes.

        It is a guess for a solve, not a solution: its status is "failed" and it has no report.
        In a symmetric study the mirror image changes too.

        Args:
            values: (nodes - 1,) by name, as `nodal_values` gives them.

        Raises:
            UnknownName: no such coordinate or muscle.
            InvalidInput: wrong number of values, or one that is not finite.
        """
        kind, known = self.study.skeleton_kind, (*self.coordinate_names, *self.muscle_names)
        num_coordinates, count = len(self.coordinate_names), self.splines.num_intervals
        signs = np.concatenate([coordinates.mirror_signs(kind), np.ones(len(self.muscle_names))])
        anatomical = coordinates.anatomical_signs(kind)
        both = np.vstack([self.values.coordinate_coefficients, self.values.force_coefficients])
        for name, given in values.items():
            if name not in known:
                raise UnknownName("coordinate or muscle", name, known)
            nodal = np.asarray(given, dtype=float)
            if nodal.shape != (count,) or not np.isfinite(nodal).all():
                raise InvalidInput(f"nodal values of {name}", given, f"{count} finite numbers")
            row = known.index(name)
            sign = anatomical[row] if row < num_coordinates else 1.0
            both[row] = self.splines.coefficients(sign * nodal)
            if self.study.symmetric:
                image = signs[row] * np.roll(both[row], -count // 2)
                mirror = coordinates.other_side(name)
                if mirror == name:
                    both[row] = 0.5 * (both[row] + image)
                else:
                    both[known.index(mirror)] = image
        edited = dataclasses.replace(
            self.values,
            coordinate_coefficients=both[:num_coordinates],
            force_coefficients=both[num_coordinates:],
        )
        outcome = dataclasses.replace(
            self.outcome, status="failed", message="Nodal values were set by hand.",
            worst=(), advice="Use it as the guess of a solve.",
        )  # fmt: skip
        return dataclasses.replace(self, values=edited, outcome=outcome, cost={}, report=None,
                                   kkt=None)  # fmt: skip

    def sensitivities(self) -> Sensitivities:
        """What every number of the study does to the optimum, see `drakegait.sensitivities`.

        Raises:
            InvalidInput: no solver has found this gait to be an optimum.
        """
        from drakegait.sensitivities import sensitivities

        return sensitivities(self)

    # Files -------------------------------------------------------------------------------

    def save(self, path: str | Path) -> None:
        """Write `gait.nc`; raises BadFile if it cannot be written."""
        from drakegait.gait_file import save

        save(self, path)

    @classmethod
    def load(cls, path: str | Path) -> Gait:
        """Read what `save` has written; raises BadFile for any other file."""
        from drakegait.gait_file import load

        return load(path)

    def summary(self) -> dict[str, Any]:
        """The main numbers under stable keys, see `drakegait.summary`."""
        from drakegait.summary import summarise

        return summarise(self)
