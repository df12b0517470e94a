# SPDX-License-Identifier: Apache-2.0
"""The page of a data set, its takes' pages and its data card. dataset_report_check.py BUILD_FOLDER [CASE...]

Needs chromium, chromium-driver and python3-selenium; without them the cases that look at a page are skipped.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser
from cases import DEMO, Skip, case, in_time, kinalign, main
from data_sets import answer, done


def small_set(folder, takes=3, copied=True):
    """Some takes of the demo, built; the second without nodes, the third from a Kinect on the wrong axis."""
    data = folder / "set"
    done("init", data, "--template", "hfut-mmd")
    subprocess.run([DEMO, folder / "raw", "--seconds", "3", "--takes", str(takes), "--seed", "1"], check=True)
    for i, manifest in enumerate(sorted((folder / "raw").rglob("recording.toml"))):
        text = manifest.read_text()
        if i == 1:
            text = re.sub(r"\[stream\.imu\].*?(?=\n\[space)", "", text, flags=re.S)
        if i == 2:
            text = text.replace('clock = "shared"', 'clock = "shared"\nup = "z"', 1)
        manifest.write_text(text)
        done("add", data, manifest, "--subject", f"{i + 1:02}", "--action", f"S{i % 2 + 1}A01", *["--copy"] * copied)
    done("build", data)
    return data


def shown(browser):
    """Names of the rows that are shown, in their order."""
    return browser.js("return [...document.querySelectorAll('.takes tbody tr')].filter((row) => !row.hidden)"
                      ".map((row) => row.cells[1].firstChild.textContent)")


def choose(browser, name, value):
    browser.js("const field = document.querySelector('.filters').elements[arguments[0]]; field.value = arguments[1];"
               "field.dispatchEvent(new Event('input', { bubbles: true }))", name, value)


@case
def a_page_has_each_take_with_its_picture_and_no_error_or_request(folder):
    data = small_set(folder)
    said = answer("report", data)
    assert (said["schema"], said["path"], said["takes"]) == ("kinalign.dataset.report/1", str(data / "report.html"), 3)
    assert said["good"] + said["usable"] + said["bad"] == 3 and said["bytes"] == (data / "report.html").stat().st_size
    with Browser(data / "report.html") as browser:
        assert browser.js("return document.body.dataset.ready") == "true", browser.faults()
        assert len(shown(browser)) == 3
        for row in range(3):
            paths = browser.js("return [...document.querySelectorAll('.takes tbody tr')][arguments[0]]"
                               ".querySelectorAll('path').length", row)
            assert paths >= 2, f"row {row}: {paths} paths"
        assert browser.js("return document.querySelectorAll('.takes a').length") == 0
        assert f"kinalign dataset report {data} --pages" in browser.js("return document.body.innerText")
        tables = browser.js("return [...document.querySelectorAll('#composition figcaption')].map((c) => c.textContent)")
        assert [t[:9] for t in tables] == ["Frames by", "Frames by", "Takes and"], tables
        assert browser.faults() == []


@case
def rows_are_filtered_and_sorted(folder):
    data = small_set(folder)
    done("report", data)
    rows = answer("list", data)["takes"]
    with Browser(data / "report.html") as browser:
        first = shown(browser)
        choose(browser, "subject", "02")
        assert shown(browser) == ["sub-02_task-S2A01_run-01"], shown(browser)
        assert browser.js("return document.querySelector('.filters output').value") == "1 of 3"
        choose(browser, "streams", "IMU")
        assert shown(browser) == [] and browser.js("return !document.querySelector('.none').hidden")
        choose(browser, "subject", "")
        assert sorted(shown(browser)) == ["sub-01_task-S1A01_run-01", "sub-03_task-S1A01_run-01"]
        choose(browser, "streams", "")
        choose(browser, "words", "s2a01 SUB-02")
        assert shown(browser) == ["sub-02_task-S2A01_run-01"]
        choose(browser, "words", "")
        residuals = {row["name"]: round(row["residual_cm"], 1) for row in rows}
        for sign in (1, -1):
            browser.js("document.querySelector('th[data-key=residual]').click()")
            order = [sign * residuals[name] for name in shown(browser)]
            assert order == sorted(order), order
        for _ in range(2):  # the take without nodes stands last either way
            browser.js("document.querySelector('th[data-key=imu]').click()")
            assert shown(browser)[-1] == "sub-02_task-S2A01_run-01"
        browser.js("document.querySelector('.filters button[type=reset]').click()")
        browser.js("return new Promise((done) => setTimeout(done, 50))")
        assert shown(browser) == first
        assert browser.faults() == []


@case
def each_row_leads_to_its_take_and_only_changed_takes_get_new_pages(folder):
    data = small_set(folder)
    said = kinalign("dataset", "report", data, "--pages", "--json")
    assert said.returncode in (0, 1), said.stderr
    if b"built with esbuild" in said.stdout:
        raise Skip("kinalign was built without esbuild, libjs-three or node-d3")
    assert json.loads(said.stdout)["pages"] == {"made": 3, "up_to_date": 0, "removed": 0, "failed": []}, said.stdout
    pages = {p.name: p.read_bytes() for p in (data / "report").glob("*.html")}
    assert sorted(pages) == [f"sub-0{i}_task-S{(i - 1) % 2 + 1}A01_run-01.html" for i in (1, 2, 3)]
    for name, page in pages.items():
        assert b"read from the take's inputs" in page, name  # --copy: the raw files are found
        take = data / name[:6] / name.replace(".html", "_take.h5")
        raw = data / "sourcedata" / name[:6] / name.removesuffix(".html")
        kinalign("report", take, "-o", folder / "alone.html", "--inputs", raw, "--force")
        assert page == (folder / "alone.html").read_bytes(), name
    first = (data / "report.html").read_bytes()
    assert answer("report", data, "--pages")["pages"]["up_to_date"] == 3
    assert (data / "report.html").read_bytes() == first, "the same data set gives other bytes"
    with Browser(data / "report.html") as browser:
        browser.driver.find_element("css selector", ".takes a").click()
        assert re.search(r"/report/sub-0\d_task-S\dA01_run-01\.html$", browser.driver.current_url)
        assert browser.js("return document.querySelector('#player') !== null")
    moved = shutil.move(data, folder / "moved set #1")
    raw = next((moved / "sourcedata/sub-02").rglob("kinect.csv"))
    raw.write_text("".join(raw.read_text().splitlines(keepends=True)[:-1]))
    done("build", moved)
    done("rm", moved, "sub-03", "--yes")
    said = answer("report", moved, "--pages", "-o", moved / "report.html")["pages"]
    assert (said["made"], said["up_to_date"], said["removed"]) == (1, 1, 0), said
    assert not (moved / "report/sub-03_task-S1A01_run-01.html").exists()
    answer("verify", moved)


@case
def a_page_elsewhere_has_its_pages_beside_it(folder):
    data = small_set(folder, takes=1)
    (folder / "a b").mkdir()
    said = answer("report", data, "--pages", "-o", folder / "a b/all of it.html")
    if said["pages"]["failed"]:
        raise Skip("kinalign was built without esbuild, libjs-three or node-d3")
    assert (folder / "a b/all of it/sub-01_task-S1A01_run-01.html").exists()
    assert 'href="all%20of%20it/sub-01_task-S1A01_run-01.html"' in (folder / "a b/all of it.html").read_text()
    assert not (data / "report").exists()


@case
def wide_narrow_light_dark_and_printed_pages_fit(folder):
    data = small_set(folder)
    done("report", data)
    paper = {}
    for width in (390, 1400):
        for dark in (False, True):
            with Browser(data / "report.html", width, dark) as browser:
                wide = browser.js("return document.documentElement.scrollWidth")
                assert wide <= width, f"{wide} px wide in {width}"
                paper[dark] = browser.js("return getComputedStyle(document.querySelector('section')).backgroundColor")
                assert browser.js("return document.querySelector('.takes svg').getBoundingClientRect().height") > 40
                pdf = browser.cdp("Page.printToPDF", printBackground=True)["data"]
                assert len(pdf) > 10_000
                assert browser.faults() == []
    assert paper[False] != paper[True], paper


@case
def nothing_is_overwritten_but_what_the_verb_wrote(folder):
    data = small_set(folder, takes=1)
    for name, words in (("report.html", ()), ("README.md", ("--card",))):
        (data / name).write_text("by hand")
        ran = kinalign("dataset", "report", data, *words)
        assert ran.returncode == 3 and name.encode() in ran.stderr and b"--force" in ran.stderr, ran.stderr
        assert (data / name).read_text() == "by hand"
        done("report", data, *words, "--force")
        done("report", data, *words)
        assert (data / name).stat().st_size > 1000
    for words in (("--card", "--pages"), ("-o", folder / "x.txt"), ("--card", "-o", folder / "x.html")):
        assert kinalign("dataset", "report", data, *words).returncode == 2, words


@case
def names_that_hold_scripts_run_none(folder):
    data = small_set(folder, takes=1)
    image = "<img/src=x/onerror=document.title='hit'>"
    text = (data / "dataset.toml").read_text()
    text = text.replace('name = "set"', f"name = {json.dumps(image)}", 1).replace('name = ""', f"name = {json.dumps(image)}")
    (data / "dataset.toml").write_text(text.replace('licence = ""', f"licence = {json.dumps(image)}"))
    done("report", data)
    done("report", data, "--card")
    assert "<img" not in (data / "README.md").read_text()
    with Browser(data / "report.html") as browser:
        assert browser.driver.title.startswith(image), browser.driver.title
        assert browser.js("return document.body.innerText").count(image) >= 3
        assert browser.faults() == []


@case
def the_example_in_the_card_runs_and_own_text_stays(folder):
    data = small_set(folder)
    (data / "splits").mkdir()
    (data / "splits/people.json").write_text(json.dumps(
        {"schema": "kinalign.split/1", "by": "take", "test": 0.4, "validation": 0, "seed": 1, "stratified": False, "parts": []}))
    done("report", data, "--card")
    card = (data / "README.md").read_text()
    example = re.search(r"```python\n(.*?)```", card, re.S)[1]
    ran = subprocess.run([sys.executable, "-c", example], cwd=data, capture_output=True, text=True, check=True)
    assert "mocap positions (180, 59, 3) float32" in ran.stdout and "180 rows" in ran.stdout, ran.stdout
    assert "- `splits/people.json`" in card and "| S1 | radio calisthenics | 360 |" in card, card
    own = "<!-- own text -->\n## Thanks\n*All*.\n<!-- end -->\n"
    (data / "README.md").write_text(card.replace("<!-- own text -->\n\n<!-- end -->\n", own))
    done("rm", data, "sub-03", "--yes")
    done("report", data, "--card")
    now = (data / "README.md").read_text()
    assert own in now and "Takes: 2." in now and "| S1 | radio calisthenics | 180 |" in now, now
    assert not [one for one in answer("verify", data)["findings"] if "does not know" in one["found"]]


@case
def four_hundred_takes_make_a_small_page_that_opens_at_once(folder):
    data = small_set(folder, takes=1)
    manifest, take, summary = sorted((data / "sub-01").iterdir())
    for run in range(2, 401):
        for file in (take, summary):
            (data / "sub-01" / file.name.replace("run-01", f"run-{run:02}")).hardlink_to(file)
    said = answer("report", data)
    assert (said["takes"], said["shown"]) == (400, 400) and said["bytes"] < 3_000_000, said
    with Browser(data / "report.html") as browser:
        assert len(shown(browser)) == 400
        opened = browser.js("const t = performance.getEntriesByType('navigation')[0]; return t.loadEventEnd - t.startTime")
        in_time(opened < 4000, f"{opened:.0f} ms until it was loaded")  # measured: docs/performance.md
        assert browser.faults() == []


if __name__ == "__main__":
    sys.exit(main())
