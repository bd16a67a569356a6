"""The unknowns of the nonlinear program, and the only place that knows an index.

The design vector chi of eq. (4) holds, in this order,

1. spline coefficients of the coordinates [m, rad],
2. spline coefficients of the muscle forces [N],
3. the stride time T [s] and the events theta_2 ... (fractions of the cycle),
   a one-to-one image of the phase durations t_ph = T (theta_(p+1) - theta_p)
   with which a bound on an event bounds the reach of its control points,
4. the foot placement p_g [m, rad],
5. with lifted multipliers, the contact forces and the residuals of the equations
   of motion at every control point [N, N m].

The solver sees each divided by a typical size. A symmetric walker has half
of them *by construction*: the coefficients of a mirrored function are read,
with a sign, from those of its partner half a cycle later.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class DesignValues:
    """The unknowns in full and in physical units, whatever the solver works with.

    Attributes:
        coordinate_coefficients: (num_coordinates, M) B-spline coefficients [m, rad].
        force_coefficients: (num_muscles, M) [N].
        stride_time: T [s].
        events: start of each of the eight phases as fraction of the cycle, (8,).
        placement: p_g of eq. (5), (5,) [m, m, rad, rad, m].
        multipliers: contact rows at the control points, (num_points, 14) [N, N m].
        residuals: of the equations of motion at the control points, e of eq. (18),
            (num_points, num_coordinates) [N, N m].
    """

    coordinate_coefficients: np.ndarray
    force_coefficients: np.ndarray
    stride_time: float
    events: np.ndarray
    placement: np.ndarray
    multipliers: np.ndarray
    residuals: np.ndarray

    @property
    def phase_durations(self) -> np.ndarray:
        """t_ph of eq. (5), (8,) [s]."""
        return self.stride_time * np.diff(np.append(self.events, 1.0))


@dataclass(frozen=True)
class Affine:
    """Full quantities as constant + factor * free variable; free index -1 means constant."""

    index: np.ndarray
    factor: np.ndarray
    constant: np.ndarray

    @classmethod
    def free(cls, shape: tuple[int, ...]) -> Affine:
        """Every entry a free variable of its own."""
        return cls(np.arange(np.prod(shape)).reshape(shape), np.ones(shape), np.zeros(shape))

    def values(self, free: np.ndarray) -> np.ndarray:
        """Full quantities from the free ones."""
        padded = np.append(free, 0.0)
        return self.constant + self.factor * padded[self.index]

    def reduce(self, full: np.ndarray) -> np.ndarray:
        """Free variables nearest to `full` in the least-squares sense."""
        num = self.index.max() + 1
        used = self.index >= 0
        total = np.bincount(
            self.index[used], (self.factor * (full - self.constant))[used], minlength=num
        )
        count = np.bincount(self.index[used], self.factor[used] ** 2, minlength=num)
        return total / count

    @property
    def num_free(self) -> int:
        """Number of free variables."""
        return int(self.index.max()) + 1


@dataclass(frozen=True)
class Block:
    """One kind of unknowns: how the full quantities hang on free variables.

    Attributes:
        affine: map from the block's free variables to the full quantities.
        scale, lower, upper: typical size and bounds of the full quantities
            (same shape as `affine.index`), physical units.
        names: one name per full quantity, flattened.
    """

    affine: Affine
    scale: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    names: list[str] = field(repr=False)

    def first_of_each(self) -> np.ndarray:
        """Flat position of the first full quantity that each free variable feeds."""
        flat = self.affine.index.ravel()
        used, first = np.unique(flat, return_index=True)
        return first[used >= 0]


class DesignVector:
    """Packs `DesignValues` into the solver's flat vector and back.

    Args:
        blocks: coordinates (n_c, M), forces (N_m, M), timing [T, theta_1..theta_P+1],
            placement (5,), multipliers (num_points, 14), residuals (num_points, n_c), in this
            order.
    """

    ORDER = ("coordinates", "forces", "timing", "placement", "multipliers", "residuals")

    def __init__(self, blocks: dict[str, Block]):
        self.blocks = blocks
        self.offsets: dict[str, int] = {}
        scale, lower, upper, names = [], [], [], []
        total = 0
        for name in self.ORDER:
            block = blocks[name]
            self.offsets[name] = total
            if block.affine.index.size == 0 or block.affine.index.max() < 0:
                continue
            total += block.affine.num_free
            first = block.first_of_each()
            size = block.scale.ravel()[first]
            scale.append(size)
            lower.append(block.lower.ravel()[first] / size)
            upper.append(block.upper.ravel()[first] / size)
            names += [block.names[i] for i in first]
        self.num_variables = total
        self.scale = np.concatenate(scale)
        self.lower, self.upper = np.concatenate(lower), np.concatenate(upper)
        self.names = names

    def pack(self, values: DesignValues) -> np.ndarray:
        """Flat scaled vector; what a symmetric walker cannot represent is averaged."""
        full = self._full(values)
        parts = [
            self.blocks[name].affine.reduce(full[name])
            for name in self.ORDER
            if self.blocks[name].affine.index.size and self.blocks[name].affine.index.max() >= 0
        ]
        return np.concatenate(parts) / self.scale

    def unpack(self, x: np.ndarray) -> DesignValues:
        """Full quantities in physical units from the solver's vector."""
        free = x * self.scale
        full = {}
        for name in self.ORDER:
            affine, start = self.blocks[name].affine, self.offsets[name]
            num = affine.num_free if affine.index.size else 0
            full[name] = affine.values(free[start : start + num])
        timing = full["timing"]
        events = timing[1:-1]
        if len(events) == 4:
            events = np.concatenate([events, events + 0.5])
        return DesignValues(
            coordinate_coefficients=full["coordinates"],
            force_coefficients=full["forces"],
            stride_time=float(timing[0]),
            events=events,
            placement=full["placement"],
            multipliers=full["multipliers"],
            residuals=full["residuals"],
        )

    def _full(self, values: DesignValues) -> dict[str, np.ndarray]:
        num_events = self.blocks["timing"].affine.index.size - 2
        end = 1.0 if num_events == 8 else 0.5
        return {
            "coordinates": values.coordinate_coefficients,
            "forces": values.force_coefficients,
            "timing": np.concatenate(
                [[values.stride_time], values.events[:num_events], [end]]
            ),
            "placement": values.placement,
            "multipliers": values.multipliers,
            "residuals": values.residuals,
        }

    def selection(self, name: str) -> Affine:
        """The block's full quantities as affine functions of the solver's vector."""
        block, start = self.blocks[name], self.offsets[name]
        index = np.where(block.affine.index >= 0, block.affine.index + start, -1)
        padded = np.append(self.scale, 0.0)
        return Affine(index, block.affine.factor * padded[index], block.affine.constant)


def mirrored_coefficients(
    num_intervals: int, partners: np.ndarray, signs: np.ndarray, is_left: np.ndarray
) -> Affine:
    """Coefficients of a left-right symmetric walker from half as many variables.

    A function and its mirror image obey left(tau) = sign * right(tau + 1/2); one that
    is its own partner repeats, with the sign, after half a cycle. On an even number
    of intervals a shift by half a cycle shifts coefficients by M/2.

    Args:
        num_intervals: M, even.
        partners: index of each function's mirror image (num_functions,).
        signs: +1 or -1 for each (num_functions,).
        is_left: the functions to be read from their partner (num_functions,).
    """
    half = num_intervals // 2
    index = np.full((len(partners), num_intervals), -1)
    factor = np.ones((len(partners), num_intervals))
    count = 0
    for i, partner in enumerate(partners):
        if partner == i:
            index[i] = np.tile(np.arange(count, count + half), 2)
            factor[i, half:] = signs[i]
            count += half
        elif not is_left[i]:
            index[i] = np.arange(count, count + num_intervals)
            count += num_intervals
    for i, partner in enumerate(partners):
        if is_left[i]:
            index[i] = np.roll(index[partner], -half)
            factor[i] = signs[i]
    return Affine(index, factor, np.zeros_like(factor))
