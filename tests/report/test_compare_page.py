"""The page of a comparison says what differs, hides no failure, and needs no other file."""

import csv
import dataclasses
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from gait_cases import reference_gait, restated

from drakegait import Gait
from drakegait.check import check
from drakegait.commands.compare import file_labels
from drakegait.errors import BadFile, InvalidInput
from drakegait.report.compare import compare, default_labels
from drakegait.report.comparison_page import as_attribute, change_text
from drakegait.report.comparison_words import cost_hindrances, headline, incomparable, troubles
from drakegait.report.measures import number_text
from drakegait.report.study_words import differences, spoken, who
from drakegait.study import GaitStudy
from drakegait.walker.disorders import Prosthesis

pytest.importorskip("jinja2")
NAME = "foot <b>heavy</b> & slow"


def solved(gait: Gait) -> Gait:
    """The same gait as if a solver had found it and the check had passed."""
    report = check(gait)
    items = tuple(dataclasses.replace(item, low=-np.inf, high=np.inf) for item in report.items)
    outcome = dataclasses.replace(gait.outcome, status="converged", worst=(), advice="")
    return dataclasses.replace(
        gait, outcome=outcome, report=dataclasses.replace(report, items=items)
    )


@pytest.fixture(scope="module")
def normal():
    return reference_gait("spatial")


@pytest.fixture(scope="module")
def heavy(normal):
    return solved(restated(normal, normal.study.with_added_mass("foot_r", 2.0)))


@pytest.fixture(scope="module")
def pair(normal, heavy):
    return compare(normal, heavy, labels=["plain", NAME])


@pytest.fixture(scope="module")
def page(pair, tmp_path_factory):
    return pair.save(tmp_path_factory.mktemp("page") / "report.html").read_text(encoding="utf-8")


def without_replay(page: str) -> str:
    return re.sub(r'srcdoc="[^"]*"', "", page)


# Words -----------------------------------------------------------------------------------------


def test_names_are_spoken():
    assert spoken("foot_r") == "right foot"
    assert spoken("soleus_l") == "left soleus"
    assert spoken("hat") == "trunk"
    assert spoken("knee_flexion_r") == "right knee flexion"


def test_equal_studies_do_not_differ():
    study = GaitStudy.spatial().with_added_mass("foot_r", 2.0)
    assert differences(study, study) == []
    assert differences(study, GaitStudy.spatial().with_added_mass("foot_r", 2.0)) == []


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"nodes": 24}, "24 nodes instead of 18"),
        ({"speed": 1.3}, "walking at 1.3 m/s instead of 1.2 m/s"),
        ({"strength": {"SOL": 0.5}}, "soleus of both legs at 50 % of its force"),
        ({"strength": {"vasti_l": 0.7}}, "left vasti at 70 % of its force"),
        ({"energy_weight": 2.0}, "weight of energy 2 instead of 1"),
        ({"multipliers": "projected"}, "multipliers projected instead of lifted"),
        ({"model": "spatial-symmetric", "nodes": 19}, "a spatial-symmetric instead of a spatial"),
    ],
)
def test_each_statement_has_words(change, words):
    base = GaitStudy.spatial()
    told = differences(base, base.replace(**change))
    assert any(words in text for text in told), told


def test_constants_are_named_with_unit_and_both_values():
    base = GaitStudy.spatial()
    (text,) = differences(base, base.with_settings(friction=0.4))
    assert text.startswith("friction 0.4 instead of 0.6 (")
    (text,) = differences(base, base.with_settings(force_tolerance=10.0))
    assert "10 N instead of 5 N" in text


def test_weights_are_counted_and_taken_off():
    base = GaitStudy.spatial().with_added_mass("foot_r", 1.0)
    twice = base.with_added_mass("foot_r", 1.0)
    assert differences(base, twice) == ["1 kg on the right foot"]
    assert differences(twice, base) == ["without 1 kg on the right foot"]
    assert who(twice).count("1 kg on the right foot") == 2


def test_limits_are_in_degrees():
    base = GaitStudy.spatial()
    stiff = base.with_limit("knee_flexion_r", 0.0, np.pi / 6)
    assert differences(base, stiff) == ["right knee flexion kept from 0 to 30 °"]


def test_energy_of_unequal_nodes_is_not_compared(normal):
    base = GaitStudy.spatial()
    assert cost_hindrances(base, base.with_added_mass("foot_r", 2.0)) == []
    assert "equal nodes" in cost_hindrances(base, base.replace(nodes=24))[0]
    assert cost_hindrances(base, base.with_settings(basal=True))
    assert not incomparable(base, base)
    assert incomparable(base, GaitStudy.spatial_symmetric(nodes=19))


def test_headline_of_unequal_nodes_gives_no_percentage():
    """Same walk with other energy constants: costs stand beside each other without a change."""
    gait = reference_gait("planar")
    other = restated(gait, gait.study.with_settings(basal=True))
    comparison = compare(gait, other)
    (summary,) = headline(comparison.numbers)
    (cost,) = [text for text in summary.sentences if text.startswith("Cost of transport")]
    assert "not to be compared" in cost and "%" not in cost
    assert any("do not compare" in finding.text for finding in troubles(comparison.numbers))


def test_headline_has_the_numbers(pair, normal, heavy):
    (summary,) = headline(pair.numbers)
    text = " ".join(summary.sentences)
    assert summary.title == f"{NAME}, compared with plain"
    assert "What differs: 2 kg on the right foot." in text
    # The same motion and muscle forces: the weight is carried by the residual alone.
    assert f"{heavy.metabolic.cost_of_transport:.0f} J/m, unchanged" in text
    assert "No joint angle" in text and "symmetry" in text.lower()


def test_what_failed_is_said_first(pair):
    found = troubles(pair.numbers)
    assert [finding.severe for finding in found[:2]] == [True, True]
    assert "plain: NOT CONVERGED (time limit)" in found[0].text
    assert "equations of motion | right loading" in found[0].text
    assert "plain: CHECK NOT PASSED" in found[1].text
    assert not any(NAME in finding.text and finding.severe for finding in found)
    assert not pair.trusted
    assert compare(pair.gaits[1]).trusted


# The page --------------------------------------------------------------------------------------


class Structure(HTMLParser):
    """Which tags are open where, and whether they close."""

    VOID = {"meta", "br", "img", "input", "link", "hr", "use", "path"}

    def __init__(self):
        super().__init__()
        self.open, self.seen, self.wrong = [], [], []

    def handle_starttag(self, tag, attributes):
        self.seen.append((tag, dict(attributes)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.seen.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        if tag in self.VOID:
            return
        if not self.open or self.open.pop() != tag:
            self.wrong.append(tag)


@pytest.fixture(scope="module")
def structure(page):
    found = Structure()
    found.feed(page)
    return found


def test_page_is_whole(structure):
    assert structure.wrong == [] and structure.open == []
    tags = [tag for tag, _ in structure.seen]
    assert tags.count("iframe") == 1
    assert tags.count("svg") == 11
    assert tags.count("h1") == 1


def test_page_refers_to_nothing_outside(structure, page):
    for tag, attributes in structure.seen:
        for name in ("src", "href", "xlink:href", "action"):
            value = attributes.get(name, "#")
            assert value.startswith("#") or tag == "use", (tag, value)
    text = without_replay(page)
    assert not re.findall(r"url\(\s*[\"']?(?!#)", text)
    assert "@import" not in text and "<script" not in text
    inside = [a["srcdoc"] for tag, a in structure.seen if tag == "iframe"]
    assert not re.findall(r"<(?:script|img|iframe|link)[^>]+(?:src|href)\s*=", inside[0])


def test_identifiers_in_pictures_mean_one_thing(page):
    """Clip paths and marks may repeat in several pictures, but then they are the same."""
    meaning: dict[str, set[str]] = {}
    for name, body in re.findall(r'id="(\w+)"[^>]*>(.*?)</', without_replay(page), flags=re.S):
        meaning.setdefault(name, set()).add(re.sub(r"\s+", " ", body))
    shared = {name: bodies for name, bodies in meaning.items() if len(bodies) > 1}
    assert not shared


def test_labels_are_text_and_no_markup(page):
    text = without_replay(page)
    assert "<b>heavy</b>" not in text
    assert "foot &lt;b&gt;heavy&lt;/b&gt; &amp; slow" in text


def test_red_boxes_come_before_the_headline(page):
    text = without_replay(page)
    red, said = text.index('class="box severe"'), text.index('class="box said"')
    assert red < said < text.index("<table")
    assert "NOT CONVERGED" in text[red:said] and "CHECK NOT PASSED" in text[red:said]
    assert text.count("NOT PASSED") >= 2


def test_page_has_the_numbers_of_the_tables(pair, page):
    text = without_replay(page)
    for topic in ("steps", "cost", "cost_by_muscle", "work", "symmetry"):
        for row in pair.rows[topic]:
            assert f"<td>{number_text(row.values[0], row.digits)}</td>" in text, row.label


def test_page_says_what_it_is_not_for(page):
    assert "not for clinical decisions" in page
    assert "not the spread among healthy people" in page
    assert "Robinson, Herzog and Nigg (1987)" in page


def test_frame_holds_the_very_page():
    original = '<a title="x">1 < 2 && "quoted" &amp; </a>'
    found = Structure()
    found.feed(f'<iframe srcdoc="{as_attribute(original)}"></iframe>')
    assert found.seen[0][1]["srcdoc"] == original


def test_one_planar_gait_gets_a_report(tmp_path):
    gait = solved(reference_gait("planar-symmetric"))
    path = compare(gait, reference=False).save(tmp_path / "one.html")
    text = without_replay(path.read_text(encoding="utf-8"))
    assert "Gait report" in text and "change" not in re.findall(r"<th>([^<]*)</th>", text)
    assert 'class="box severe"' not in text
    assert "reference ±" not in text
    assert "Step width" not in text and "Hip adduction" not in text


def test_three_gaits_have_two_columns_of_changes(normal, heavy):
    light = restated(normal, normal.study.with_added_mass("shank_l", 1.0))
    comparison = compare(normal, heavy, light)
    assert comparison.labels == ("baseline", "2 kg on the right foot", "1 kg on the left shank")
    table = comparison.tables()["steps"]
    assert list(table.columns[3:]) == [
        *comparison.labels,
        "change: 2 kg on the right foot", "change in %: 2 kg on the right foot",
        "change: 1 kg on the left shank", "change in %: 1 kg on the left shank",
    ]  # fmt: skip
    assert len(headline(comparison.numbers)) == 2


# Tables ----------------------------------------------------------------------------------------


def test_csv_files_hold_the_tables(pair, tmp_path):
    files = pair.save_csv(tmp_path / "csv")
    assert {path.stem for path in files} == set(pair.tables())
    with (tmp_path / "csv" / "cost_by_muscle.csv").open(encoding="utf-8", newline="") as file:
        found = list(csv.DictReader(file))
    assert {"quantity", "side", "unit", "plain", NAME, f"change: {NAME}"} <= set(found[0])
    total = sum(float(row["plain"]) for row in found)
    assert total == pytest.approx(pair.gaits[0].metabolic.cost_of_transport, rel=1e-4)


def test_detail_of_the_cost_adds_up(pair):
    detail = pair.tables()["cost_detail"]
    assert detail["plain"].sum() == pytest.approx(pair.gaits[0].metabolic.cost_of_transport)
    assert len(detail) == 14 * 2 * 8


def test_curves_are_those_of_the_gait(pair, normal):
    table = pair.tables()["curves"]
    knee = table[(table["quantity"] == "knee_flexion") & (table["side"] == "right")]
    assert list(knee["percent"]) == list(range(101))
    data = normal.sample(101).coordinates.sel(coordinate="knee_flexion_r").values
    np.testing.assert_allclose(knee["plain"], data, atol=0.05)
    assert (knee["band low"] < knee["band high"]).all()
    moments = table[table["quantity"] == "knee_flexion_moment"]
    assert moments["band low"].isna().all()
    assert moments["reference, inverse dynamics"].notna().all()
    assert knee["reference, inverse dynamics"].isna().all()


# Texts -----------------------------------------------------------------------------------------


def test_numbers_as_text():
    assert number_text(-0.04, 1) == "0.0"
    assert number_text(-1.26, 1) == "\N{MINUS SIGN}1.3"
    assert number_text(1.26, 1, sign=True) == "+1.3"
    assert number_text(float("nan"), 1) == "\N{EN DASH}"
    assert change_text(0.5, 10.0, 1) == "+0.5 (+10.0 %)"
    assert change_text(-0.5, float("nan"), 1) == "\N{MINUS SIGN}0.5"


# Refusals --------------------------------------------------------------------------------------


def test_planar_and_spatial_walkers_are_refused(normal):
    with pytest.raises(InvalidInput, match="all spatial or all planar"):
        compare(normal, reference_gait("planar"))


@pytest.mark.parametrize(
    ("labels", "reason"),
    [(["one"], "one for each"), (["a", "a "], "different"), (["a", ""], "characters"),
     (["a", "x" * 61], "characters")],
)  # fmt: skip
def test_labels_must_fit(normal, heavy, labels, reason):
    with pytest.raises(InvalidInput, match=reason):
        compare(normal, heavy, labels=labels)


def test_number_and_kind_of_gaits(normal):
    with pytest.raises(InvalidInput, match="1 to 6"):
        compare()
    with pytest.raises(InvalidInput, match="1 to 6"):
        compare(*[normal] * 7)
    with pytest.raises(InvalidInput, match="Gait.load"):
        compare("gait.nc")


def test_default_labels_are_short_and_different(normal, heavy):
    many = normal.study.replace(strength=dict.fromkeys(normal.muscle_names, 0.9))
    labels = default_labels([normal, heavy, heavy, restated(normal, many), normal])
    assert labels[:3] == (
        "baseline", "2 kg on the right foot", "2 kg on the right foot (3)",
    )  # fmt: skip
    assert labels[3] == "gait 4" and len(set(labels)) == 5


def test_unwritable_places_are_named(pair, tmp_path):
    with pytest.raises(BadFile, match="does not exist"):
        pair.save(tmp_path / "missing" / "report.html")
    with pytest.raises(BadFile, match="is a folder"):
        pair.save(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(BadFile, match="cannot be made"):
        pair.save_csv(tmp_path / "file")


# The command -----------------------------------------------------------------------------------


def test_files_give_labels(tmp_path):
    (tmp_path / "heavy").mkdir()
    names = [str(tmp_path / "heavy"), str(tmp_path / "weak.nc"), str(tmp_path / "weak.nc")]
    assert file_labels(names) == ["heavy", "weak", "weak (3)"]


def run(*arguments: str) -> int:
    from drakegait.cli import main

    with pytest.raises(SystemExit) as ending:
        main(list(arguments))
    return ending.value.code


def test_command_writes_page_and_tables(normal, heavy, tmp_path, capsys):
    for name, gait in (("normal", normal), ("heavy", heavy)):
        (tmp_path / name).mkdir()
        gait.save(tmp_path / name / "gait.nc")
    page, folder = tmp_path / "report.html", tmp_path / "csv"
    gaits = [str(tmp_path / "normal"), str(tmp_path / "heavy")]
    code = run("compare", *gaits, "-o", str(page), "--csv", str(folder))
    assert code == 3  # the first has not converged
    said = capsys.readouterr().out
    assert "normal: NOT CONVERGED" in said and "2 kg on the right foot" in said
    assert "heavy, compared with normal" in page.read_text(encoding="utf-8")
    assert (folder / "steps.csv").is_file()

    assert run("compare", gaits[1], "-o", str(page), "--labels", "alone") == 0
    assert "Gait report: alone" in page.read_text(encoding="utf-8")
    assert run("compare", *gaits, "--labels", "a,b,c") == 2
    assert "one for each gait" in capsys.readouterr().err
    assert run("compare", str(tmp_path / "nothing.nc")) == 2


def test_muscles_that_a_prosthesis_replaces_take_part_in_the_sum():
    whole = reference_gait("planar")
    fewer = reference_gait("planar", disorders=(Prosthesis("r"),))
    found = compare(whole, fewer, labels=("whole", "prosthesis"))
    before, after = (item.split for item in found.numbers)
    (summary,) = headline(found.numbers)
    gone = {
        group: before.of_group(group, "right")
        for group in ("soleus", "gastrocnemius", "tibialis_anterior")
    }
    most = max(gone, key=gone.get)
    words = f"right {most.replace('_', ' ')} {number_text(-gone[most], 1, True)} (not there)"
    assert words in " ".join(summary.sentences)
    table = found.tables()["cost_by_muscle"]
    changes = table[next(name for name in table if name.startswith("change"))]
    assert changes.sum() == pytest.approx(after.total - before.total, abs=1e-6)
    assert any("prosthesis" in item.text for item in troubles(found.numbers))
