"""The page of a comparison in a real browser: numbers, pictures and both walkers, from one file."""

import pytest
from browser_cases import changed, not_blank, picture
from gait_cases import changed as changed_gait
from gait_cases import reference_gait, restated

pytest.importorskip("jinja2")
QUARTERS = (0.0, 0.25, 0.5, 0.75)


@pytest.fixture(scope="module")
def opened(visit, tmp_path_factory):
    from drakegait.report.compare import compare

    normal = reference_gait("spatial")
    heavy = restated(normal, normal.study.with_added_mass("foot_r", 2.0))
    heavy = changed_gait(heavy, stride_time=1.15 * normal.stride_time)
    path = tmp_path_factory.mktemp("compare") / "report.html"
    compare(normal, heavy, labels=["plain", "heavy"]).save(path)
    visit.page.context.set_offline(True)
    visit.page.goto(path.as_uri())
    return visit


@pytest.fixture(scope="module")
def frame(opened):
    frame = opened.ready(opened.page.frames[1])
    frame.evaluate("viewer.animator.pause()")
    return frame


def test_page_opens_without_complaint_and_without_network(opened, frame):
    assert opened.complaints == []
    assert opened.abroad == []
    assert [frame.url for frame in opened.page.frames][1:] == ["about:srcdoc"]


def test_reader_sees_red_before_anything_else(opened):
    # These gaits are no solutions.
    box = opened.page.locator(".severe").first
    assert box.is_visible() and "NOT CONVERGED" in box.inner_text()
    first_table = opened.page.locator("table").first
    assert box.bounding_box()["y"] < first_table.bounding_box()["y"]
    colour = box.evaluate("(element) => getComputedStyle(element).color")
    red, green, blue = (int(part) for part in colour[4:-1].split(","))
    assert red > 100 > max(green, blue)


def test_pictures_fill_the_page_and_nothing_sticks_out(opened):
    page = opened.page
    width = page.evaluate("document.body.clientWidth")
    figures = page.locator("figure svg")
    assert figures.count() == 11
    for number in range(figures.count()):
        box = figures.nth(number).bounding_box()
        assert box["width"] > 0.8 * width and box["height"] > 100.0
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


def test_words_in_pictures_do_not_lie_on_each_other(opened):
    """Texts of one picture keep apart, with the fonts of this browser."""
    overlaps = opened.page.evaluate(
        """() => [...document.querySelectorAll('figure svg')].flatMap((svg) => {
          const texts = [...svg.querySelectorAll('text')].filter((t) => t.textContent.trim());
          const boxes = texts.map((t) => t.getBoundingClientRect());
          const found = [];
          for (let i = 0; i < boxes.length; i++)
            for (let k = 0; k < i; k++) {
              const wide = Math.min(boxes[i].right, boxes[k].right)
                         - Math.max(boxes[i].left, boxes[k].left);
              const high = Math.min(boxes[i].bottom, boxes[k].bottom)
                         - Math.max(boxes[i].top, boxes[k].top);
              if (wide > 3 && high > 5)
                found.push(`${svg.getAttribute('aria-label')}: `
                           + `${texts[k].textContent} / ${texts[i].textContent}`);
            }
          return found;
        })"""
    )
    assert overlaps == []


def test_both_walkers_walk_in_step(opened, frame):
    scene = opened.page.locator("iframe")
    scene.scroll_into_view_if_needed()
    roots = frame.evaluate("viewer.scene_tree.find(['drake', 'gait_1']).object.children.length")
    others = frame.evaluate("viewer.scene_tree.find(['drake', 'gait_2']).object.children.length")
    assert roots > 2 and others > 2
    legend = frame.inner_text("body")
    assert "plain" in legend and "heavy" in legend and "In step" in legend
    # The same motion at another pace: in step, both right feet are at one place.
    place = (
        "(root) => { const path = ['drake', root, 'walker', 'foot_r'];"
        " const foot = viewer.scene_tree.find(path).object;"
        " foot.updateWorldMatrix(true, false); return [...foot.matrixWorld.elements]; }"
    )
    shots = []
    for share in QUARTERS:
        frame.evaluate("(share) => walk.seek(share)", share)
        first, second = (frame.evaluate(place, root) for root in ("gait_1", "gait_2"))
        aside = [abs(a - b) for a, b in zip(first, second, strict=True)]
        assert sum(gap > 1e-6 for gap in aside) == 1 and max(aside) > 0.9  # only to the side
        shots.append(scene_shot(opened.page, scene))
        assert not_blank(shots[-1])
    for number, shot in enumerate(shots):
        assert all(changed(shot, other) > 0.01 for other in shots[:number])


def scene_shot(page, scene):
    box = scene.bounding_box()
    left = box["x"] + 0.42 * box["width"]
    clip = {"x": left, "y": box["y"] + 30, "width": box["x"] + box["width"] - left, "height": 500}
    return picture(page, clip=clip)


def test_page_prints_on_a_few_sheets_without_the_replay(opened):
    page = opened.page
    page.emulate_media(media="print")
    assert not page.locator("iframe").is_visible()
    assert page.locator(".severe").first.is_visible()
    assert page.locator("figure svg").first.is_visible()
    sheets = page.pdf(prefer_css_page_size=True).count(b"/Type /Page\n")
    page.emulate_media(media="screen")
    assert 5 <= sheets <= 20
