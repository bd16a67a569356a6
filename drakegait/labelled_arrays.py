"""Arrays with named dimensions, and netCDF files of them.

Written by h5netcdf alone. xarray writes the same file, but loads pandas, and Dask's scheduler where
that is installed, which takes a second; a small study is solved in two. What makes a file readable
as if xarray had written it: `_FillValue` nan for floats, and the names of labels that are no
dimension in the attribute `coordinates` of each array that they label.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from drakegait.errors import BadFile
from drakegait.whole_file import write_bytes

if TYPE_CHECKING:
    import h5netcdf
    import xarray as xr

Labelled = tuple[tuple[str, ...], Any, Mapping[str, str]]
"""Names of the dimensions, the values, and attributes such as `units`."""

ROOT = "/"
"""Name of the root among the groups of a file."""


@dataclass(frozen=True)
class LabelledArrays:
    """Several arrays that share dimensions.

    Attributes:
        arrays: by name; floats, whole numbers or words.
        labels: what the places along a dimension are called or where they lie, likewise.
        attributes: of the whole.
    """

    arrays: Mapping[str, Labelled] = field(default_factory=dict)
    labels: Mapping[str, Labelled] = field(default_factory=dict)
    attributes: Mapping[str, Any] = field(default_factory=dict)

    def dataset(self) -> xr.Dataset:
        """The same for xarray."""
        import xarray as xr

        return xr.Dataset(dict(self.arrays), coords=dict(self.labels), attrs=dict(self.attributes))

    def write(self, group: h5netcdf.Group, around: Mapping[str, int]) -> dict[str, int]:
        """Write into an open file.

        Args:
            around: sizes of the dimensions of the enclosing groups, which are shared.

        Returns:
            Sizes of all dimensions seen from this group.
        """
        group.attrs.update(self.attributes)
        sizes = dict(around)
        # Labels first: they become the scales of their dimensions, to which arrays are attached.
        for name, (dims, values, attributes) in {**self.labels, **self.arrays}.items():
            more = {}
            if name in self.arrays and (beside := self._labels_beside(dims)):
                more["coordinates"] = " ".join(beside)
            values = np.asarray(values)
            for dim, size in zip(dims, values.shape, strict=True):
                if sizes.get(dim) != size:
                    group.dimensions[dim] = sizes[dim] = size
            _write_array(group, name, dims, values, {**attributes, **more})
        return sizes

    def _labels_beside(self, dims: tuple[str, ...]) -> list[str]:
        """Labels of places along `dims` besides those named like their dimension."""
        return sorted(
            name
            for name, (own, _, _) in self.labels.items()
            if (name,) != own and set(own) <= set(dims)
        )


def write_netcdf(path: str | Path, groups: Mapping[str, LabelledArrays]) -> None:
    """Write a file, beside the place first and renamed when complete.

    Args:
        groups: by name; one is the `ROOT`.

    Raises:
        BadFile: the folder does not exist or cannot be written to.
    """
    import h5netcdf

    path = Path(path)
    if path.is_dir():
        raise BadFile(path, "is a folder, not a file to write.")
    memory = io.BytesIO()  # HDF5 that writes to a full disk itself ends the process
    with h5netcdf.File(memory, "w") as file:
        shared = groups[ROOT].write(file, {})
        for name, content in groups.items():
            if name != ROOT:
                content.write(file.create_group(name), shared)
    write_bytes(path, memory.getvalue())


def _write_array(
    group: h5netcdf.Group,
    name: str,
    dims: tuple[str, ...],
    values: np.ndarray,
    attributes: Mapping[str, str],
) -> None:
    import h5py

    kind = {"U": h5py.string_dtype()}.get(values.dtype.kind, values.dtype)
    missing = np.nan if values.dtype.kind == "f" else None
    variable = group.create_variable(name, dims, kind, fillvalue=missing)
    variable[...] = values.astype(object) if values.dtype.kind == "U" else values
    variable.attrs.update(attributes)
