"""Answers of OpenSim, from a process of its own."""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # the helpers in `tests`

PROBE = Path(__file__).with_name("opensim_probe.py")


@pytest.fixture
def ask_opensim(tmp_path):
    """Sends a request to OpenSim, in `tmp_path`; skips the test where OpenSim is missing."""
    if importlib.util.find_spec("opensim") is None:  # importing it here would break CasADi
        pytest.skip("opensim is not installed")

    def ask(**request) -> dict:
        plain = {k: x.tolist() if isinstance(x, np.ndarray) else x for k, x in request.items()}
        (tmp_path / "request.json").write_text(json.dumps(plain), encoding="utf-8")
        run = subprocess.run(
            [sys.executable, str(PROBE), str(tmp_path)], capture_output=True, text=True
        )
        assert run.returncode == 0, run.stderr
        return json.loads((tmp_path / "answer.json").read_text(encoding="utf-8"))

    return ask
