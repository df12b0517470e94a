# SPDX-License-Identifier: Apache-2.0
"""Pages of takes, in headless Chromium. report_check.py BUILD_FOLDER [CASE...]

Needs chromium, chromium-driver and python3-selenium; without them the cases that look at a page are skipped.
"""
import base64
import csv
import json
import pathlib
import re
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import h5py
import numpy as np
import samples
from browser import Browser, Keys
from cases import Skip, case, demo, done_with, in_time, kinalign, main, refused, wrong

DATA_JS = pathlib.Path(__file__).parent.parent.parent / "kinalign/view/page/assets/data.js"
FIGURES = ("lanes", "distance", "figure7", "table5", "residual", "residual-time", "floor", "states", "bones", "node-rate",
           "node-acceleration", "node-orientation")


def page_of(folder, seconds=4, **how):
    """The demo's page; skipped where kinalign was built without what a page needs."""
    demo(folder, seconds)
    done_with(0, "align", folder / "recording.toml", "-o", folder / "take.h5")
    done = kinalign("report", folder / "take.h5", "-o", folder / "report.html", **how)
    if b"built with esbuild" in done.stderr:
        raise Skip("kinalign was built without esbuild, libjs-three or node-d3")
    assert done.returncode == 0, done.stderr
    return folder / "report.html"


def data_of(page):
    return json.loads(re.search(r'<script type="application/json" id="take">(.*?)</script>', page.read_text(), re.S)[1])


@case
def a_page_shows_every_figure_without_an_error_or_a_request(folder):
    page = page_of(folder)
    with Browser(page) as browser:
        assert browser.js("return document.body.dataset.ready") == "true", browser.faults()
        for figure in FIGURES:
            marks = browser.js("return document.querySelectorAll('#' + arguments[0] + ' svg path, svg rect').length", figure)
            assert marks > 3, f"{figure}: {marks} marks"
            assert browser.js("return document.querySelector('#' + arguments[0] + ' figcaption').textContent.length", figure) > 30
            text = browser.js("return document.querySelector('#' + arguments[0] + ' svg').outerHTML", figure)
            assert "NaN" not in text and "Infinity" not in text, figure
        assert browser.faults() == []


@case
def each_of_two_kinects_has_its_figures(folder):
    demo(folder, 4)
    text = (folder / "recording.toml").read_text()
    stream, space = (re.search(rf"\[{part}\.kinect\].*?(?=\n\[|\Z)", text, re.S)[0] for part in ("stream", "space"))
    second = space.replace("space.kinect", "space.side").replace('SpineMid = "Spine2", ', "")
    (folder / "recording.toml").write_text(f"{text}\n{stream.replace('stream.kinect', 'stream.side')}\n\n{second}\n")
    kinalign("align", folder / "recording.toml", "-o", folder / "take.h5")  # the same file twice is a finding
    if kinalign("report", folder / "take.h5", "-o", folder / "report.html").returncode == 3:
        raise Skip("kinalign was built without esbuild, libjs-three or node-d3")
    with Browser(folder / "report.html", width=390) as browser:
        def choose(figure, label, i):
            """What an option says; the figures behind it before and after it was chosen."""
            return browser.js("""
                const [figure, label, i] = arguments, drawn = (id) => document.querySelector(`#${id} svg`).outerHTML;
                const list = [...document.querySelectorAll(`#${figure} .tools label`)].find((l) => l.textContent.startsWith(label))
                    .querySelector("select");
                const all = ["figure7", "table5", "residual", "residual-time", "states"], before = all.map(drawn);
                list.value = i;
                list.dispatchEvent(new Event("change"));
                return [list.options[i].textContent, all.filter((id, k) => drawn(id) !== before[k])];""", figure, label, i)
        bars = "return document.querySelectorAll('#residual svg rect.fill').length"
        first = browser.js(bars)
        name, changed = choose("table5", "Stream", 1)
        assert name == "side on mocap" and {"residual", "residual-time"} <= set(changed), (name, changed)
        assert browser.js(bars) == first - 1, "the second Kinect has a pair of joints less"
        assert choose("table5", "Stream", 0)[0] == "kinect on mocap" and browser.js(bars) == first
        assert choose("figure7", "Stream", 1)[0] == "side"
        assert choose("figure7", "Joint", 3) == ["Head", ["figure7"]]
        assert choose("states", "Stream", 1)[0] == "side"
        names = browser.js("return [...document.querySelectorAll('#bones svg .name')].map((t) => t.textContent.split(' ')[0])")
        assert set(names) == {"kinect", "side"}, names
        for caption, words in (("table5", "the chosen stream"), ("figure7", "the chosen stream"), ("bones", "kinect and side")):
            assert words in browser.js("return document.querySelector(`#${arguments[0]} figcaption`).textContent", caption)
        assert browser.js("return document.documentElement.scrollWidth") <= 390
        assert browser.faults() == []


@case
def the_player_draws_and_moves_and_its_keys_work(folder):
    with Browser(page_of(folder, seconds=8)) as browser:
        drawn = "return Number(document.querySelector('#player canvas').dataset.frames)"
        assert browser.js(drawn) > 0
        before, frames, start = browser.seconds(), browser.js(drawn), time.monotonic()
        browser.press(Keys.SPACE)
        time.sleep(2)
        assert browser.js("return document.getElementById('player').dataset.playing") == "true"
        browser.press(Keys.SPACE)
        elapsed = time.monotonic() - start
        moved, frames = browser.seconds() - before, browser.js(drawn) - frames
        assert 0.5 < moved <= elapsed + 0.1, (moved, elapsed)
        # 30 and more on an idle machine without a GPU; this one may be shared.
        in_time(frames / elapsed > 4, f"{frames / elapsed:.0f} frames a second")
        now = browser.seconds()
        browser.press(Keys.ARROW_RIGHT)
        assert abs(browser.seconds() - now - 1 / 60) < 2e-3
        browser.press(Keys.ARROW_LEFT, Keys.ARROW_LEFT)
        assert abs(browser.seconds() - now + 1 / 60) < 2e-3
        pictures = []
        for key in "123":
            browser.press(key)
            pictures.append(browser.js("return document.querySelector('#player canvas').toDataURL()"))
        assert len(set(pictures)) == 3, "front, side and top look alike"
        assert browser.faults() == []


@case
def dark_and_narrow_pages_fit_and_differ(folder):
    page = page_of(folder)
    paper = {}
    for width in (390, 1400):
        for dark in (False, True):
            with Browser(page, width, dark) as browser:
                wide = browser.js("return document.documentElement.scrollWidth")
                assert wide <= width, f"{wide} px wide in {width}"
                paper[dark] = browser.js("return getComputedStyle(document.querySelector('section')).backgroundColor")
                assert browser.faults() == []
    assert paper[False] != paper[True], paper


@case
def a_printed_page_is_light_and_has_its_picture(folder):
    with Browser(page_of(folder), dark=True) as browser:
        pdf = base64.b64decode(browser.cdp("Page.printToPDF", printBackground=True)["data"])
        assert pdf.startswith(b"%PDF") and len(pdf) > 50_000
        assert browser.js("return document.querySelector('#player .paper') !== null")
        assert not browser.js("return document.documentElement.classList.contains('printing')")
        assert browser.faults() == []


@case
def without_webgl_the_page_says_so_and_everything_else_works(folder):
    with Browser(page_of(folder), webgl=False) as browser:
        assert browser.js("return document.body.dataset.ready") == "true"
        notice = "return getComputedStyle(document.querySelector('.no-webgl')).display"
        assert browser.js(notice) == "block"
        browser.press(Keys.ARROW_RIGHT)
        assert browser.seconds() > 0
        assert browser.js("return document.querySelectorAll('#figure7 svg path').length") > 3
        assert browser.faults() == []


@case
def the_script_reads_the_rows_of_the_take(folder):
    page = page_of(folder)
    packed = data_of(page)
    source = DATA_JS.read_text().replace("export ", "")
    with h5py.File(folder / "take.h5") as take, Browser(page) as browser:
        browser.driver.get("about:blank")
        for body in packed["bodies"]:
            rows = take[body["name"]]
            wanted = rows["positions"][:]
            if "valid" in rows:
                wanted = np.where(rows["valid"][:][:, :, None] == 1, wanted, 0)
            read = browser.js(source + "; return Array.from(unpacked(arguments[0]))", body["positions"])
            joints = wanted.shape[1]
            read = np.array(read).reshape(len(wanted), len(body["joint_names"]), 3)[:, :joints]
            assert np.abs(read - wanted).max() < 0.00026, np.abs(read - wanted).max()
        node = packed["nodes"][1]
        read = browser.js(source + "; return Array.from(unpacked(arguments[0]))", node["rate"])
        # In the root node's space the take holds the same vectors turned: their lengths are kept.
        wanted = np.linalg.norm(take["imu/angular_velocity"][:, 1], axis=1)
        read = np.linalg.norm(np.array(read).reshape(-1, 3), axis=1)
        assert np.abs(read - wanted).max() < 0.01, np.abs(read - wanted).max()


@case
def raw_samples_of_nodes_are_those_of_the_files(folder):
    page = page_of(folder)
    packed = data_of(page)
    source = DATA_JS.read_text().replace("export ", "")
    with Browser(page) as browser:
        for _ in range(3):
            browser.js("document.querySelector('#node-rate .tools button').click()")
        for figure in ("node-rate", "node-acceleration"):
            drawn = browser.js("return document.querySelector(`#${arguments[0]} .dots`).getAttribute('d')", figure)
            assert drawn.count("M") > 3, (figure, drawn)
        browser.driver.get("about:blank")
        for node in packed["nodes"]:
            with open(folder / f"imu_{node['node']}.csv") as file:
                rows = [row for row in csv.DictReader(file) if row["gx"]]
            read = {name: np.array(browser.js(source + "; return Array.from(unpacked(arguments[0]))", node[name]))
                    for name in ("raw_seconds", "raw_rate")}
            wanted = [[float(row[f"g{axis}"]) for axis in "xyz"] for row in rows]
            stamps = [int(row["time_ns"]) for row in rows]
            first = h5py.File(folder / "take.h5")["time_ns"][0]
            inside = [i for i, stamp in enumerate(stamps) if stamp >= first]
            rate = read["raw_rate"].reshape(-1, 3)
            assert len(rate) == len(inside), (node["node"], len(rate), len(inside))
            assert np.abs(rate - np.array(wanted)[inside]).max() < 0.006
            assert np.abs(read["raw_seconds"] - (np.array(stamps)[inside] - first) / 1e9).max() < 1e-4


@case
def names_that_hold_scripts_run_none(folder):
    attack = "<script>document.title='hit'</script>"
    image = "<img/src=x/onerror=document.title='hit'>"
    samples.recording(folder)
    (folder / "mocap.bvh").write_text(samples.bvh(30).replace("Hips", image))
    (folder / "kinect.csv").write_text(samples.kinect(30))
    (folder / "imu.csv").write_text(samples.imu(30))
    text = (folder / "recording.toml").read_text().replace('subject = "S01"', f"subject = {json.dumps(attack)}")
    text = f"action = {json.dumps(image)}\n{text}onto_root = {json.dumps(image)}\n"
    (folder / "recording.toml").write_text(text)
    done = kinalign("align", folder / "recording.toml", "-o", folder / "take.h5")
    assert done.returncode in (0, 1), done.stderr
    done = kinalign("report", folder / "take.h5", "-o", folder / "report.html")
    if done.returncode == 3:
        raise Skip("kinalign was built without esbuild, libjs-three or node-d3")
    with Browser(folder / "report.html") as browser:
        assert browser.js("return document.body.dataset.ready") == "true"
        assert browser.driver.title.startswith("take.h5: "), browser.driver.title
        assert image in browser.js("return document.body.innerText")
        assert browser.faults() == []


@case
def a_page_says_what_it_is_and_overwrites_nothing(folder):
    page = page_of(folder)
    first = page.read_bytes()
    assert len(first) < 2_000_000
    out, _ = done_with(0, "report", folder / "take.h5", "-o", page, "--force", "--json")
    said = json.loads(out)
    assert said["schema"] == "kinalign.report_page/1"
    assert (said["path"], said["bytes"], said["raw_samples"]) == (str(page), len(first), True)
    assert [v["stream"] for v in said["verdicts"]] == ["mocap", "kinect", "imu"]
    assert {v["quality"] for v in said["verdicts"]} <= {"good", "usable", "bad"}
    assert page.read_bytes() == first, "the same take gives other bytes"
    refused("report", folder / "take.h5", "-o", page, naming=str(page))
    assert page.read_bytes() == first
    wrong("report", folder / "take.h5", says="-o: expected the page's file name, as in -o take.html, found none")
    wrong("report", folder / "mocap.bvh", "-o", folder / "b.html",
          says=f"{folder / 'mocap.bvh'}: expected a take (kinalign align makes one), found a file of another kind")
    (folder / "input.html").write_bytes((folder / "take.h5").read_bytes())
    refused("report", folder / "input.html", "-o", folder / "input.html", "--force", naming=str(folder / "input.html"))


@case
def without_its_inputs_a_take_has_a_page_too_and_says_so(folder):
    page = page_of(folder)
    assert "read from the take's inputs" in page.read_text()
    alone = folder / "alone"
    alone.mkdir()
    (alone / "take.h5").write_bytes((folder / "take.h5").read_bytes())
    out, _ = done_with(0, "report", alone / "take.h5", "-o", alone / "report.html", "--json")
    assert json.loads(out)["raw_samples"] is False
    assert "since the inputs were not read" in (alone / "report.html").read_text()
    done_with(0, "report", alone / "take.h5", "-o", alone / "report.html", "--force", "--inputs", folder)
    assert (alone / "report.html").read_bytes() == page.read_bytes()
    text = (folder / "kinect.csv").read_text()
    (folder / "kinect.csv").write_text(text.replace("0.1", "0.2", 1))
    first = refused("report", alone / "take.h5", "-o", alone / "b.html", "--inputs", folder, naming="kinect.csv")
    assert "expected the file that the take was made from, found another" in first
    assert not (alone / "b.html").exists()


@case
def a_hostile_take_is_an_error(folder):
    page_of(folder)
    whole = (folder / "take.h5").read_bytes()
    for size in (600, len(whole) // 3, len(whole) - 9):
        (folder / "torn.h5").write_bytes(whole[:size])
        done = kinalign("report", folder / "torn.h5", "-o", folder / "torn.html")
        assert done.returncode in (2, 3), done
        assert not (folder / "torn.html").exists()


if __name__ == "__main__":
    sys.exit(main())
