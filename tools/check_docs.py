# SPDX-License-Identifier: Apache-2.0
"""The docs check: check_docs.py KINALIGN [ROOT]

Every verb of `kinalign --help` is in README.md or docs/ with an example; every verb of ./dev is in CONTRIBUTING.md. Every relative link
of a page leads to a file, and its #part to a heading there. A page of docs/ has at most MOST_LINES lines and is in the index,
docs/README.md.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else __file__ + "/../..").resolve()
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"```.*?```", re.S)
MOST_LINES = 150
# Longer pages: the rooms are one list; the others are not yet split.
LONGER = {"architecture.md": 200}
NOT_INDEXED = {"README.md", "progress.md"}


def pages():
    found = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")]
    for folder in ("kinalign", "apps", "firmware", "tests", "tools", "bench", "fuzz", "layouts", "models"):
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


def parts(text):
    """The #parts of a page, made of its headings as GitHub makes them."""
    heads = re.findall(r"^#+ (.*)$", CODE.sub("", text), re.M)
    return {re.sub(r"[^\w\- ]", "", LINK.sub("", head).lower()).replace(" ", "-") for head in heads}


def lacking_verbs(texts):
    shown = "\n".join(t for p, t in texts.items() if p.name == "README.md" and p.parent == ROOT
                      or p.is_relative_to(ROOT / "docs"))
    overview = output_of(sys.argv[1], "--help").partition("\nverbs\n")[2]
    for verb in verbs_of(overview, "\n\n"):
        if not re.search(rf"\bkinalign {verb}\b", shown):
            yield f"expected an example of `kinalign {verb}` in README.md or docs/"
    contributing = texts.get(ROOT / "CONTRIBUTING.md", "")
    for verb in verbs_of(output_of("./dev", "--help").partition("\n\n")[2], "\n\n"):
        if not re.search(rf"\./dev {verb}\b", contributing):
            yield f"CONTRIBUTING.md: expected a word on `./dev {verb}`"


def broken_links(path, texts):
    for target in LINK.findall(CODE.sub("", texts[path])):
        name, _, part = target.partition("#")
        to = (path.parent / name).resolve() if name else path
        if re.match(r"[a-z]+:", target):
            continue
        if not to.exists():
            yield f"{path.relative_to(ROOT)}: the link {target} leads nowhere"
        elif part and part not in parts(texts.get(to, "")):
            yield f"{path.relative_to(ROOT)}: the link {target} leads to a page without that heading"


def long_or_not_indexed(texts):
    docs = ROOT / "docs"
    index = {(docs / target.split("#")[0]).resolve() for target in LINK.findall(texts.get(docs / "README.md", ""))}
    for path in texts:
        if not path.is_relative_to(docs):
            continue
        name, lines = str(path.relative_to(docs)), texts[path].count("\n")
        if lines > LONGER.get(name, MOST_LINES):
            yield f"docs/{name}: expected at most {LONGER.get(name, MOST_LINES)} lines, found {lines}: split it by the reader's question"
        if path not in index and name not in NOT_INDEXED:
            yield f"docs/README.md: expected a link to {name}"


def main():
    texts = {path: path.read_text() for path in pages()}
    found = [*lacking_verbs(texts), *(f for path in texts for f in broken_links(path, texts)), *long_or_not_indexed(texts)]
    print("\n".join(found))
    return 1 if found else 0


sys.exit(main())
