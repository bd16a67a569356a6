"""`from drakegait import ...`: all names, loaded late, never hidden by a file of that name."""

from __future__ import annotations

import subprocess
import sys
import types
from pathlib import Path

import pytest

import drakegait

ROOT = Path(__file__).resolve().parents[1]


@pytest.mark.parametrize("name", drakegait.__all__)
def test_every_name_is_there_and_no_module(name):
    thing = getattr(drakegait, name)
    assert callable(thing) and not isinstance(thing, types.ModuleType)
    assert thing.__name__ == name and name in dir(drakegait)


def test_importing_the_package_loads_nothing_else():
    code = (
        "import sys; before = set(sys.modules); import drakegait\n"
        "new = {name.split('.')[0] for name in set(sys.modules) - before}\n"
        "assert not new & {'numpy', 'pydrake', 'scipy', 'casadi', 'rich', 'typer'}, new"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)


@pytest.mark.parametrize("name", ["check", "replay", "solve", "sweep"])
def test_importing_the_file_does_not_hide_the_function(name):
    code = (
        f"import drakegait.{name}\n"
        f"from drakegait.{name} import {name} as from_file\n"
        f"from drakegait import {name}\n"
        f"import drakegait\n"
        f"assert {name} is from_file is drakegait.{name} and callable({name})"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)


def test_other_names_are_refused():
    with pytest.raises(AttributeError, match="no attribute 'slove'"):
        drakegait.slove  # noqa: B018
    assert isinstance(drakegait.__version__, str)
