"""The command `drakegait`: parse, call, print.

A file here for each command parses it; what it does is in `drakegait.commands`, imported when the
command runs, because Drake takes its time and `--help` should not.

Exit codes: 0 done; 2 bad input (one sentence on stderr, nothing solved, nothing written);
3 not converged or check not passed (files are written); 130 interrupted outside a solve.
"""

from __future__ import annotations

import atexit
import gc
import os
import sys
from typing import Any

import typer

from drakegait.cli import (
    compare,
    explain,
    export,
    fidelity,
    import_,
    look,
    paper,
    sensitivities,
    sweep,
    walk,
)
from drakegait.cli.app import app
from drakegait.errors import DrakegaitError

__all__ = [
    "app", "compare", "explain", "export", "fidelity", "import_", "look", "main", "paper",
    "sensitivities",
    "sweep", "walk",
]  # fmt: skip

BAD_INPUT, INTERRUPTED = 2, 130

# Matrices here are small: a second thread costs more than it brings, and sums in another order end
# at another optimum. Read when NumPy is loaded, which no command has done yet.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Searching for cycles after every 700 new objects, while libraries load, and in all there is before
# the process ends, would take a tenth of a second.
gc.set_threshold(20_000)
atexit.register(gc.freeze)
# Typer's errors about options derive from these; where Typer keeps them depends on its version.
_USAGE_ERROR = typer.BadParameter.__mro__[1]
_COMMAND_LINE_ERROR = typer.BadParameter.__mro__[2]


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and exit with its code; see the top of this file."""
    command = typer.main.get_command(app)
    try:
        code = command.main(args=arguments, prog_name="drakegait", standalone_mode=False)
    except typer.Exit as ending:
        code = ending.exit_code
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except DrakegaitError as error:
        _say(str(error))
        code = BAD_INPUT
    except _COMMAND_LINE_ERROR as error:
        code = _refused(error)
    except ImportError as error:
        if not _interrupted(error):
            raise
        code = INTERRUPTED  # while Drake's libraries were loaded
    if code == INTERRUPTED:
        _say("interrupted.")
    sys.exit(code)


def _interrupted(error: BaseException | None) -> bool:
    """Whether Ctrl-C is at the root: a library that was being loaded makes other errors of it."""
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__
    return error is not None


def _refused(error: Any) -> int:
    """Print a refused option in one sentence."""
    if not str(error.format_message()):  # `drakegait` alone: Typer has shown the help
        return BAD_INPUT
    context = getattr(error, "ctx", None)
    command = context.command_path if isinstance(error, _USAGE_ERROR) and context else "drakegait"
    message = str(error.format_message()).strip()
    end = "" if message.endswith((".", "?", ")")) else "."
    _say(f"{message}{end} See {command} --help.")
    return BAD_INPUT


def _say(sentence: str) -> None:
    print(f"drakegait: {sentence}", file=sys.stderr)
