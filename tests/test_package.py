"""The house keeps its order: who imports whom, how long files are, what the wheel carries."""

from __future__ import annotations

import ast
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "drakegait"
MODULES = sorted(PACKAGE.rglob("*.py"))
LONGEST = 300  # lines of a file that still holds one concept

# A part is a module or folder right inside drakegait. Parts named here import, of drakegait, only
# themselves and what is listed; dependencies point one way.
_GROUND = {"errors", "quantities", "settings"}
_MODELS = _GROUND | {"walker", "transcription"}
MAY_IMPORT = {
    "errors": set(),
    "quantities": {"errors"},
    "settings": {"errors", "quantities"},
    "whole_file": {"errors"},
    "labelled_arrays": {"errors", "whole_file"},
    "walker": _GROUND,
    "transcription": _GROUND,
    "reference": _MODELS | {"labelled_arrays"},
    "measured": _MODELS | {"reference", "whole_file"},
    "program": _MODELS | {"reference"},
    "study": _MODELS | {"reference", "program", "study_file", "study_rules"},
    "study_file": _MODELS | {"reference", "program", "study"},
    "study_rules": _MODELS | {"reference", "program", "study"},
    "solvers": _MODELS | {"reference", "program"},
}
# Parts that start a solve. All others (gait, check, report, replay and their helpers) read a
# finished gait and need no solver, only the record of how the solve ended.
SOLVING = {
    "__init__", "exact", "fidelity", "infeasibility", "paper", "rounds", "solve", "sweep",
}  # fmt: skip
ENTRANCES = {"cli", "commands"}  # where users come in; nothing else imports them
SOLVER_RECORD = "drakegait.solvers.outcome"
SOLVER_LIBRARIES = ("drakegait.solvers", "pydrake.solvers", "ipyopt")
# The judges of a gait evaluate it on their own and do not look at the rows of the program.
JUDGES = {"check", "judgement", "judged_disorders"}


def imported(path: Path, root: Path = ROOT) -> list[str]:
    """Full dotted names that a file imports anywhere, also inside functions."""
    package = path.relative_to(root).parent.parts
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join([*above, *filter(None, [node.module])])
            found += [f"{module}.{alias.name}" for alias in node.names]
    return found


def part(path: Path) -> str:
    """The part a file belongs to, e.g. `walker` or `gait`."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def within(name: str, modules: tuple[str, ...]) -> bool:
    return any(name == module or name.startswith(module + ".") for module in modules)


def forbidden(path: Path) -> list[str]:
    """The imports by which a file breaks the order."""
    own, names = part(path), imported(path)
    if own in ENTRANCES:
        return []
    entrances = tuple(f"drakegait.{name}" for name in ENTRANCES)
    if own in SOLVING:
        return [n for n in names if within(n, entrances)]
    if own in MAY_IMPORT:
        allowed = tuple(f"drakegait.{name}" for name in MAY_IMPORT[own] | {own})
        return [n for n in names if within(n, ("drakegait",)) and not within(n, allowed)]
    rows = ("drakegait.program",) if own in JUDGES else ()
    banned = (*entrances, *SOLVER_LIBRARIES, *rows)
    return [n for n in names if within(n, banned) and not within(n, (SOLVER_RECORD,))]


def committed() -> list[Path]:
    """Files that are committed or would be with the next `git add`."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    try:
        listing = subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("this is not a git checkout")
    return [
        path for name in listing.decode().split("\0") if name and (path := ROOT / name).is_file()
    ]


def test_imports_are_read_in_all_their_forms(tmp_path):
    module = tmp_path / "drakegait" / "walker" / "feet.py"
    module.parent.mkdir(parents=True)
    module.write_text(
        "import numpy.linalg\n"
        "from drakegait import study\n"
        "from drakegait.solvers.outcome import Outcome as O\n"
        "def f():\n    from ..program import design\n    from . import muscles\n"
    )
    assert set(imported(module, tmp_path)) == {
        "numpy.linalg",
        "drakegait.study",
        "drakegait.solvers.outcome.Outcome",
        "drakegait.program.design",
        "drakegait.walker.muscles",
    }


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_dependencies_point_one_way(path):
    assert not forbidden(path), f"{part(path)} may not import this"


def test_no_file_is_too_long():
    lengths = {str(p.relative_to(ROOT)): len(p.read_text("utf-8").splitlines()) for p in MODULES}
    assert not {name: lines for name, lines in lengths.items() if lines > LONGEST}


def test_no_committed_file_names_a_registry():
    hosts = [
        ".".join(words)
        for words in (
            ("pypi", "org"),
            ("files", "pythonhosted", "org"),
            ("registry", "npmjs", "org"),
            ("deb", "debian", "org"),
            ("snapshot", "debian", "org"),
            ("anaconda", "org"),
        )
    ]
    named = {
        f"{path.relative_to(ROOT)}: {host}"
        for path in committed()
        for host in hosts
        if host.encode() in path.read_bytes()
    }
    assert not named


@pytest.mark.parametrize("name", ["run.txt", "test.txt", "docs.txt"])
def test_every_pinned_package_has_hashes_and_no_address(name):
    text = (ROOT / "requirements" / name).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.lstrip().startswith("#")]
    starts = [row for row, line in enumerate(lines) if not line.startswith(" ")]
    assert starts
    for start, end in zip(starts, [*starts[1:], len(lines)], strict=True):
        assert "==" in lines[start]
        assert end > start + 1, f"{lines[start]} has no hash"
        assert all(line.startswith("    --hash=sha256:") for line in lines[start + 1 : end])


def test_wheel_carries_models_data_and_licences_and_finds_them(tmp_path):
    """The wheel, unpacked outside the checkout, loads a walker, its muscles and a reference."""
    pytest.importorskip("hatchling")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    with zipfile.ZipFile(next(tmp_path.glob("*.whl"))) as wheel:
        names = set(wheel.namelist())
        wheel.extractall(tmp_path / "site")
    data = [*PACKAGE.rglob("data/*"), *PACKAGE.rglob("templates/*.html")]
    data = [p for p in data if p.is_file()]
    expected = {str(p.relative_to(ROOT)) for p in [*MODULES, *data]}
    expected |= {f"drakegait/sdf/{p.name}" for p in (ROOT / "sdf").iterdir()}
    assert expected <= names
    info = next(name.split("/")[0] for name in names if ".dist-info/" in name)
    assert {f"{info}/licenses/LICENSE", f"{info}/licenses/NOTICE"} <= names
    assert {name.split("/")[0] for name in names} == {"drakegait", info}

    program = (
        f"import sys; sys.path.insert(0, {str(tmp_path / 'site')!r})\n"
        "import drakegait; print(drakegait.__file__)\n"
        "from drakegait.reference.reference import Reference\n"
        "from drakegait.walker.model_file import sdf_path\n"
        "from drakegait.walker.muscles import MuscleSet\n"
        "from drakegait.walker.skeleton import Skeleton\n"
        "for kind in ('spatial', 'planar'):\n"
        "    print(sdf_path(kind)); Skeleton.load(kind)\n"
        "    MuscleSet.load(kind); Reference.embedded(kind)\n"
    )
    run = [sys.executable, "-P", "-c", program]
    found = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    assert all(line.startswith(str(tmp_path)) for line in found.stdout.splitlines())
