"""A scalar CasADi function applied to every column of numpy arrays, fast for few and for many.

CasADi's own call converts arrays to its matrices and back, which costs more than the
arithmetic. Two ways around it:

- few columns: CasADi's interpreter, column by column, on buffers that are numpy memory
  ((..., num_rows, k) in C order is what CasADi sees as k x num_columns);
- many columns: the function's instructions, each carried out by numpy for a block of
  columns at once (vector units, no interpreter per column; three to six times faster).
"""

from __future__ import annotations

import casadi
import numpy as np

# From here on numpy's cost per call is repaid by its speed per column.
MANY_COLUMNS = 180
# Most columns per block: the live intermediate results should stay near the processor.
BLOCK_COLUMNS = 2800
# Batch sizes kept ready; a gait program uses two or three.
KEPT_SIZES = 6

_OPERATIONS = {
    casadi.OP_ADD: np.add,
    casadi.OP_SUB: np.subtract,
    casadi.OP_MUL: np.multiply,
    casadi.OP_DIV: np.divide,
    casadi.OP_NEG: np.negative,
    casadi.OP_SQ: np.square,
    casadi.OP_INV: np.reciprocal,
    casadi.OP_SQRT: np.sqrt,
    casadi.OP_POW: np.power,
    casadi.OP_CONSTPOW: np.power,
    casadi.OP_TAN: np.tan,
    casadi.OP_SIN: np.sin,
    casadi.OP_COS: np.cos,
    casadi.OP_FMIN: np.fmin,
    casadi.OP_FMAX: np.fmax,
    casadi.OP_LT: np.less,
    casadi.OP_LE: np.less_equal,
    casadi.OP_EQ: np.equal,
    casadi.OP_NOT: np.logical_not,
}


class ColumnwiseFunction:
    """`function(constants, inputs...) -> outputs...`, vectors all, over many columns.

    Args:
        function: first argument the constants of a column, the last of them the smoothing; all
            arguments and results dense.
        constants: (num_rows, num_constants), without the smoothing; rows repeat along the
            leading axes of the inputs.
    """

    def __init__(self, function: casadi.Function, constants: np.ndarray):
        self._function = function
        self._constants = constants
        self._ready: dict[int, _Interpreter | _Blocks] = {}
        self._sizes = [function.numel_out(i) for i in range(function.n_out())]

    def size_in(self, argument: int) -> int:
        """Size of an argument; the constants are number 0."""
        return self._function.numel_in(argument)

    def __call__(self, smoothing: float, *inputs: np.ndarray) -> list[np.ndarray]:
        """Results (..., num_rows, size) for inputs (..., num_rows, k), C order, float."""
        leading = inputs[0].shape[:-1]
        num_columns = inputs[0].size // inputs[0].shape[-1]
        results = [np.empty(leading + (size,)) for size in self._sizes]
        if num_columns:
            self._prepared(num_columns).run(smoothing, inputs, results)
        return results

    def _prepared(self, num_columns: int) -> _Interpreter | _Blocks:
        instants = num_columns // len(self._constants)
        many = num_columns >= MANY_COLUMNS
        if many:
            # Equal blocks, so that none is computed half in vain.
            instants = -(-instants // -(-num_columns // BLOCK_COLUMNS))
        if instants not in self._ready:
            if len(self._ready) >= KEPT_SIZES:
                self._ready.pop(next(iter(self._ready)))
            kind = _Blocks if many else _Interpreter
            self._ready[instants] = kind(self._function, self._constants, instants)
        return self._ready[instants]


class _Interpreter:
    """CasADi's interpreter over a fixed number of columns, reading and writing numpy memory."""

    def __init__(self, function: casadi.Function, constants: np.ndarray, instants: int):
        num_columns = instants * len(constants)
        self._table = np.ones((num_columns, constants.shape[1] + 1))
        self._table[:, :-1] = np.tile(constants, (instants, 1))
        # The mapped function must live as long as the buffer that points at it.
        self._mapped = function.map(num_columns, "serial")
        self._buffer, self._evaluate = self._mapped.buffer()
        self._buffer.set_arg(0, memoryview(self._table))

    def run(self, smoothing: float, inputs: tuple, results: list) -> None:
        self._table[:, -1] = smoothing
        for i, array in enumerate(inputs):
            self._buffer.set_arg(i + 1, memoryview(array))
        for i, array in enumerate(results):
            self._buffer.set_res(i, memoryview(array))
        self._evaluate()


class _Blocks:
    """The function's instructions as numpy operations on blocks of columns (some instants)."""

    def __init__(self, function: casadi.Function, constants: np.ndarray, instants: int):
        num_rows, num_constants = constants.shape
        width = self._width = num_rows * instants
        table = np.tile(constants, (instants, 1)).T.copy()
        self._smoothing = np.array(1.0)
        self._inputs = [np.zeros((function.numel_in(i), width)) for i in range(1, function.n_in())]
        outputs = [np.zeros((function.numel_out(i), width)) for i in range(function.n_out())]
        self._outputs = outputs
        registers = np.zeros((function.sz_w(), width))

        self._steps: list[tuple] = []
        # Inputs and constants need no copy: a register may stand for another array for a while.
        holds: dict[int, np.ndarray] = {}
        for i in range(function.n_instructions()):
            code = function.instruction_id(i)
            source, target = function.instruction_input(i), function.instruction_output(i)
            if code == casadi.OP_CONST:
                holds[target[0]] = np.array(function.instruction_constant(i))
            elif code == casadi.OP_INPUT:
                argument, k = source
                if argument > 0:
                    holds[target[0]] = self._inputs[argument - 1][k]
                else:
                    holds[target[0]] = table[k] if k < num_constants else self._smoothing
            elif code == casadi.OP_OUTPUT:
                self._steps.append((np.positive, (holds[source[0]], outputs[target[0]][target[1]])))
            else:
                operands = [holds[k] for k in source]
                if code == casadi.OP_TWICE:
                    operation, operands = np.add, [operands[0], operands[0]]
                else:
                    operation = _OPERATIONS[code]
                holds[target[0]] = registers[target[0]]
                self._steps.append((operation, (*operands, registers[target[0]])))

    def run(self, smoothing: float, inputs: tuple, results: list) -> None:
        self._smoothing[...] = smoothing
        inputs = [array.reshape(-1, array.shape[-1]) for array in inputs]
        results = [array.reshape(-1, array.shape[-1]) for array in results]
        num_columns = len(inputs[0])
        with np.errstate(all="ignore"):
            for start in range(0, num_columns, self._width):
                columns = slice(start, min(start + self._width, num_columns))
                used = columns.stop - start  # the rest of the last block is computed in vain
                for held, array in zip(self._inputs, inputs, strict=True):
                    held[:, :used] = array[columns].T
                for operation, arguments in self._steps:
                    operation(*arguments)
                for held, array in zip(self._outputs, results, strict=True):
                    array[columns] = held[:, :used].T
