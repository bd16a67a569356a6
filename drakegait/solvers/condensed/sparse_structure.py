"""Sparse matrices whose structure never changes."""

from __future__ import annotations

import numpy as np
import scipy.sparse


class SparseStructure:
    """A sparse matrix of constant structure whose entries are given in another order."""

    def __init__(self, rows: np.ndarray, columns: np.ndarray, shape: tuple[int, int]):
        numbered = scipy.sparse.coo_array((np.arange(1.0, len(rows) + 1.0), (rows, columns)), shape)
        compressed = numbered.tocsr()
        if compressed.nnz != len(rows):
            raise ValueError("two entries at one place")
        self._order = compressed.data.astype(int) - 1
        self._indices, self._starts, self._shape = compressed.indices, compressed.indptr, shape

    def matrix(self, entries: np.ndarray) -> scipy.sparse.csr_array:
        """The matrix with these entries."""
        data = entries.take(self._order)
        return scipy.sparse.csr_array((data, self._indices, self._starts), shape=self._shape)
