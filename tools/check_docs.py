# SPDX-License-Identifier: Apache-2.0
"""The docs check: check_docs.py KINALIGN

Every verb of `kinalign --help` stands in README.md or docs/ with an example; every verb of ./dev in
CONTRIBUTING.md; every relative link of a page leads to something that is there.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def pages():
    found = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")]
    for folder in ("kinalign", "apps", "firmware", "tests", "tools", "bench", "fuzz", "layouts"):
        found += ROOT.glob(f"{folder}/**/*.md")
    return sorted(found)


def output_of(*command):
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout


def verbs_of(text, stop):
    """First words of the lines that are indented by two blanks, up to the line `stop`."""
    lines = text.split(stop)[0].splitlines()
    names = []
    for line in lines:
        found = re.match(r"  ([a-z][a-z-]*(?:, [a-z-]+)*)", line)
        names += re.split(r", ", found[1]) if found else []
    return names


def main():
    found = []
    texts = {path: path.read_text() for path in pages()}
    shown = "\n".join(t for p, t in texts.items() if p.name == "README.md" and p.parent == ROOT
                      or p.is_relative_to(ROOT / "docs"))
    overview = output_of(sys.argv[1], "--help").partition("\nverbs\n")[2]
    for verb in verbs_of(overview, "\n\n"):
        if not re.search(rf"\bkinalign {verb}\b", shown):
            found.append(f"expected an example of `kinalign {verb}` in README.md or docs/")
    contributing = texts.get(ROOT / "CONTRIBUTING.md", "")
    for verb in verbs_of(output_of("./dev", "--help").partition("\n\n")[2], "\n\n"):
        if not re.search(rf"\./dev {verb}\b", contributing):
            found.append(f"CONTRIBUTING.md: expected a word on `./dev {verb}`")
    for path, text in texts.items():
        for target in LINK.findall(re.sub(r"```.*?```", "", text, flags=re.S)):
            if re.match(r"[a-z]+:|#", target):
                continue
            if not (path.parent / target.split("#")[0]).exists():
                found.append(f"{path.relative_to(ROOT)}: the link {target} leads nowhere")
    print("\n".join(found))
    return 1 if found else 0


sys.exit(main())
