"""What the figures show is the gait: values, signs, sides, phases, files."""

import dataclasses
import os
import subprocess
import sys
from xml.etree import ElementTree

import numpy as np
import pytest
from gait_cases import reference_gait

from drakegait.errors import BadFile
from drakegait.report import excitations, footprints, joint_moments, style
from drakegait.report.curves import GaitCurves, curves_of
from drakegait.report.figures import FIGURES, plot
from drakegait.report.ground_reactions import ground_reactions, heel_of_print
from drakegait.report.joint_angles import joint_angles
from drakegait.report.stick_figure import Sticks, stick_figure
from drakegait.study import GaitStudy
from drakegait.walker import feet

MODELS = ("spatial", "planar-symmetric")
NAMES = sorted(f"{name}.{kind}" for name in FIGURES for kind in ("png", "svg"))


@pytest.fixture(autouse=True)
def _look():
    with style.look():
        yield


@pytest.fixture(scope="module", params=MODELS)
def curves(request) -> GaitCurves:
    return GaitCurves(reference_gait(request.param))


def panel(figure, beginning: str):
    found = [axes for axes in figure.axes if axes.get_title(loc="left").startswith(beginning)]
    assert len(found) == 1
    return found[0]


def drawn(axes, colour: str, width: float | None = 1.4) -> np.ndarray:
    """Points (num, 2) of the one line of a colour and width; width None: the one dashed line."""
    found = [
        line.get_xydata()
        for line in axes.lines
        if line.get_color() == colour and len(line.get_xdata()) > 2
        and (line.get_linestyle() == "--" if width is None else line.get_linewidth() == width)
    ]  # fmt: skip
    assert len(found) == 1
    return found[0]


def at_percent(points: np.ndarray, curves: GaitCurves, side: str, values: np.ndarray) -> np.ndarray:
    """The data at the instants at which a side's curve is drawn."""
    percent = (points[:, 0] + curves.heel_strike(side)) % 100.0
    rows = np.rint(percent / 100.0 * (curves.samples - 1)).astype(int) % (curves.samples - 1)
    np.testing.assert_allclose((percent - curves.percent[rows] + 50) % 100 - 50, 0.0, atol=1e-9)
    return values[rows]


def test_drawn_angles_are_the_data_of_both_legs(curves):
    figure = joint_angles([curves])
    for title, name in (("Knee flexion", "knee_flexion"), ("Hip flexion", "hip_flexion")):
        for side, colour in style.SIDE_COLOURS.items():
            points = drawn(panel(figure, title), colour)
            data = curves.data.coordinates.sel(coordinate=f"{name}_{side[0]}").values
            np.testing.assert_allclose(points[:, 1], at_percent(points, curves, side, data))
            assert points[0, 0] <= 0.0 and points[-1, 0] >= 100.0  # fills the panel
            assert np.all(np.diff(points[:, 0]) > 0.0)


def test_angles_read_as_a_gait_analyst_expects(curves):
    figure = joint_angles([curves])
    for colour in style.SIDE_COLOURS.values():
        percent, knee = drawn(panel(figure, "Knee flexion"), colour).T
        assert 50.0 < knee.max() < 75.0  # degrees, in swing
        assert 65.0 < percent[knee.argmax()] < 82.0
        percent, hip = drawn(panel(figure, "Hip flexion"), colour).T
        assert hip.min() < -5.0 and 45.0 < percent[hip.argmin()] < 65.0  # extends in late stance
        percent, ankle = drawn(panel(figure, "Ankle"), colour).T
        assert ankle.min() < -10.0 and 58.0 < percent[ankle.argmin()] < 75.0  # pushes off


def test_reference_is_behind_the_angles(curves):
    lines = [
        line for line in panel(joint_angles([curves]), "Knee flexion").lines
        if line.get_color() == style.REFERENCE_COLOUR
    ]  # fmt: skip
    for line, side in zip(lines, ("right", "left"), strict=True):
        points, name = line.get_xydata(), f"knee_flexion_{side[0]}"
        data = curves.data.reference_coordinates.sel(coordinate=name).values
        np.testing.assert_allclose(points[:, 1], at_percent(points, curves, side, data))
        assert line.get_zorder() < 3


def test_legs_of_a_symmetric_walker_coincide():
    curves = GaitCurves(reference_gait("planar-symmetric"))
    knee = panel(joint_angles([curves]), "Knee flexion")
    force = panel(ground_reactions([curves]), "Vertical force")
    power = panel(joint_moments.joint_moments([curves]), "Ankle power")
    for axes, tolerance in ((knee, 1e-6), (power, 1e-6), (force, 1e-6)):
        right, left = (drawn(axes, colour)[1:-1] for colour in style.SIDE_COLOURS.values())
        np.testing.assert_allclose(right[:, 0], left[:, 0], atol=1e-9)
        np.testing.assert_allclose(right[:, 1], left[:, 1], atol=tolerance)


def test_phases_and_toe_off_are_where_the_events_are(curves):
    axes = panel(joint_angles([curves]), "Knee flexion")
    bars = next(item for item in axes.collections if item.get_gid() == "phases")
    edges = [path.get_extents().x0 for path in bars.get_paths()]
    np.testing.assert_allclose(edges, 100.0 * curves.gait.values.events)
    events = dict(zip(feet.EVENT_NAMES, 100.0 * curves.gait.values.events, strict=True))
    assert curves.toe_off("right") == pytest.approx(events["right toe off"])
    swing = 100.0 - events["left heel strike"] + events["left toe off"]
    assert curves.toe_off("left") == pytest.approx(swing)
    assert curves.phase_edges("left")[0] == 0.0
    np.testing.assert_allclose(curves.phase_edges("left")[4], 100.0 - events["left heel strike"])


def test_forces_in_body_weight_and_towards_the_midline(curves):
    data = curves.data.ground_reaction_force
    for side, inward in (("right", 1.0), ("left", -1.0)):
        share = curves.ground_reaction(side, "vertical") / 100.0
        weight = curves.gait.study.subject.mass * 9.81
        np.testing.assert_allclose(share * weight, data.sel(foot=side, axis="z"))
        medial = curves.ground_reaction(side, "medial") / 100.0 * weight
        np.testing.assert_allclose(medial, inward * data.sel(foot=side, axis="y"))
        loaded = curves.own_cycle(side, share)
        assert loaded[1][(loaded[0] > 20) & (loaded[0] < 45)].min() > 0.5
        assert np.abs(loaded[1][(loaded[0] > 70) & (loaded[0] < 95)]).max() < 0.02


def test_force_vectors_start_on_the_foot():
    curves = GaitCurves(reference_gait("spatial"))
    axes = panel(ground_reactions([curves]), "Force vectors, left")
    starts = np.array([segment[0] for segment in axes.collections[0].get_segments()])
    length = curves.gait.study.walker.foot.length
    assert len(starts) > 30
    assert starts[:, 0].min() > -0.02 and starts[:, 0].max() < length + 0.02
    np.testing.assert_allclose(starts[:, 1], 0.0)
    target = feet.footprints(
        curves.gait.values.placement[None], np.array([1]), curves.gait.study.walker.foot
    )[0][0]
    assert heel_of_print(curves, "left") == pytest.approx(target[7])
    assert heel_of_print(curves, "right") == pytest.approx(target[0])


def test_power_is_moment_times_velocity(curves):
    for name in ("knee_flexion_l", "ankle_dorsiflexion_r"):
        rate = np.radians(curves.coordinate(name, "velocities"))
        joint = {"k": "Knee", "a": "Ankle"}[name[0]]
        side = {"r": "right", "l": "left"}[name[-1]]
        product = joint_moments.moment(curves, name) * rate
        np.testing.assert_allclose(joint_moments.power(curves, joint, side), product, atol=1e-9)
    assert joint_moments.moment(curves, "no_such_joint_r") is None


def test_excitations_of_both_legs_are_drawn_with_usual_bursts(curves):
    figure = excitations.excitations([curves])
    axes = panel(figure, "soleus")
    for side, colour in style.SIDE_COLOURS.items():
        points = drawn(axes, colour)
        data = curves.data.excitation.sel(muscle=f"soleus_{side[0]}").values
        np.testing.assert_allclose(points[:, 1], at_percent(points, curves, side, data))
    bars = [line.get_xdata() for line in axes.lines if line.get_gid() == "usual burst"]
    np.testing.assert_allclose(bars, excitations.bursts("soleus"))
    titles = {axes.get_title(loc="left").replace(" ", "_") for axes in figure.axes}
    assert titles == {name[:-2] for name in curves.data.muscle.values}


def test_sticks_have_rigid_limbs_on_the_ground(curves):
    sticks = Sticks.of(curves.gait, np.linspace(0.0, 1.0, 21))
    lengths = np.linalg.norm(np.diff(sticks.legs, axis=2), axis=-1)
    np.testing.assert_allclose(lengths, np.broadcast_to(lengths[:1], lengths.shape), atol=1e-9)
    np.testing.assert_allclose(lengths[0, :, 0], 0.441, atol=1e-9)
    assert sticks.legs[..., 2].min() > -0.01
    np.testing.assert_allclose(
        sticks.legs[-1, :, :, 0] - sticks.legs[0, :, :, 0], curves.gait.stride_length
    )
    figure = stick_figure([curves])
    legs = [line for line in figure.axes[0].lines if line.get_gid() == "right leg"]
    assert len(legs) == len(feet.EVENT_NAMES)


def test_footprints_lie_where_the_program_puts_them():
    gait = reference_gait("spatial")
    placed = footprints.prints(gait, strides=2)
    placement, foot = gait.values.placement, gait.study.walker.foot
    targets = feet.footprints(np.array([placement] * 2), np.array([0, 1]), foot)[0]
    for side, base, number in (("right", 0, 0), ("left", 7, 0), ("left", 7, 1)):
        x, y, heading = placed[side][number]
        heel = np.array([x, y]) + foot.heel * np.array([np.cos(heading), np.sin(heading)])
        np.testing.assert_allclose(heel, targets[number, base : base + 2])
        assert heading == targets[number, base + 6]
        outline = footprints.placed_outline(gait, side, placed[side][number])
        middle = 0.5 * (targets[number, base : base + 2] + targets[number, base + 3 : base + 5])
        assert np.linalg.norm(outline.mean(axis=0) - middle) < 0.06
    np.testing.assert_allclose(np.diff(placed["right"][:, 0]), gait.stride_length)
    assert np.all(placed["left"][:, 1] > placed["right"][0, 1])


def test_others_are_dashed_and_named_by_their_difference():
    gait = reference_gait("planar")
    heavy = dataclasses.replace(gait, study=gait.study.with_added_mass("foot_r", 2.0))
    both = curves_of(gait, (heavy,))
    assert [item.label for item in both] == ["unchanged walker", "2 kg on the right foot"]
    labels = [item.label for item in curves_of(gait, (heavy, heavy))]
    assert labels[1:] == ["2 kg on the right foot (2)", "2 kg on the right foot (3)"]
    assert len({item.label for item in curves_of(gait, (gait, gait))}) == 3
    figure = joint_angles(both)
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "2 kg on the right foot" in texts and "reference" in texts
    colour = style.SIDE_COLOURS["right"]
    axes = panel(figure, "Knee flexion")
    np.testing.assert_allclose(drawn(axes, colour, None), drawn(axes, colour))


def test_a_planar_gait_beside_a_spatial_one_shares_what_both_have(tmp_path):
    plot(reference_gait("spatial"), tmp_path, [reference_gait("planar-symmetric")])
    assert sorted(path.name for path in tmp_path.iterdir()) == NAMES


def test_files_are_whole_and_the_program_is_left_alone(tmp_path):
    script = (
        "import sys, drakegait.report.figures as figures\n"
        "assert 'matplotlib' not in sys.modules\n"
        "from gait_cases import reference_gait\n"
        "import matplotlib\n"
        "look = lambda: [matplotlib.rcParams[k] for k in matplotlib.rcParams if k != 'backend']\n"
        "before = look()\n"
        f"figures.plot(reference_gait('planar-symmetric'), {str(tmp_path / 'a' / 'b')!r})\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
        "assert look() == before\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, env=_environment())
    folder = tmp_path / "a" / "b"
    assert sorted(path.name for path in folder.iterdir()) == NAMES
    for path in folder.glob("*.svg"):
        assert ElementTree.parse(path).getroot().tag.endswith("svg")
    for path in folder.glob("*.png"):
        assert path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_unconverged_gaits_say_so():
    figure = joint_angles([GaitCurves(reference_gait("planar-symmetric"))])
    assert any("NOT CONVERGED" in text.get_text() for text in figure.texts)


def test_unwritable_folder_is_refused_in_a_sentence(tmp_path):
    (tmp_path / "taken").write_text("a file")
    with pytest.raises(BadFile, match="taken.*cannot be made"):
        plot(reference_gait("planar-symmetric"), tmp_path / "taken")
    (tmp_path / "joint_angles.svg").mkdir()
    with pytest.raises(BadFile, match=r"joint_angles\.svg.*cannot be written"):
        plot(reference_gait("planar-symmetric"), tmp_path)
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []


def test_reference_without_forces_leaves_no_band():
    gait = reference_gait("spatial")
    reference = dataclasses.replace(gait.study.reference_walk, forces=None)
    study: GaitStudy = gait.study.replace(reference=reference)
    curves = GaitCurves(dataclasses.replace(gait, study=study))
    assert curves.ground_reaction("right", "vertical", reference=True) is None
    colours = {line.get_color() for axes in ground_reactions([curves]).axes for line in axes.lines}
    assert style.REFERENCE_COLOUR not in colours


def _environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}


def test_lines_of_a_subtitle_stay_lines():
    figure = excitations.excitations([GaitCurves(reference_gait("planar"), "alone")])
    assert "\nline: excitation" in figure.texts[1].get_text()


@pytest.mark.parametrize("draw", [joint_angles, ground_reactions], ids=["wide", "narrow"])
def test_however_long_names_are_nothing_is_written_over_something_else(draw):
    gait = reference_gait("planar")
    long = "soleus left with 20 % of its strength, gastrocnemius left with 20 % of its strength"
    names = [long, "plain", f"{long}, orthosis"]
    alone, many = draw([GaitCurves(gait, "alone")]), draw([GaitCurves(gait, n) for n in names])
    for figure in (alone, many):
        figure.canvas.draw()
        written = [item.get_window_extent() for item in (*figure.texts, *figure.legends)]
        written += [axes.title.get_window_extent() for axes in figure.axes if axes.get_title()]
        for k, box in enumerate(written):
            assert box.x0 >= 0.0 and box.x1 <= figure.bbox.x1 and box.y1 <= figure.bbox.y1
            assert not any(box.overlaps(other) for other in written[:k])
    shown = [text.get_text() for item in many.legends for text in item.get_texts()]
    assert set(names) <= set(shown)
    for one, other in zip(alone.axes, many.axes, strict=True):  # panels keep their size
        sizes = [axes.get_window_extent().size for axes in (one, other)]
        np.testing.assert_allclose(*sizes, rtol=1e-6)
