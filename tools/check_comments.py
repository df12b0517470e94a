# SPDX-License-Identifier: Apache-2.0
"""The comment rule: check_comments.py [ROOT]

A comment begins with the thing that acts, so that a reader understands its first words without the code. It does
not begin with one of FIRST_WORDS. Comments are // and /// in C++ and C#, # in Python, shell and CMake. A line
that is only a comment continues the comment of the line before, unless that is the licence line.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__ + "/../..").resolve()
OURS = ("apps", "bench", "cmake", "examples", "firmware", "fuzz", "kinalign", "tests", "tools")
FIRST_WORDS = re.compile(r"(?:Of|What|That|Whose|Who|Where|As|In which|Behind)\b")
SLASHES, HASH = re.compile(r"//[/!]?<?\s?(.*)"), re.compile(r"(?:^|(?<=\s))#\s?(.*)")
MARK = {".cpp": SLASHES, ".h": SLASHES, ".cs": SLASHES, ".c": SLASHES, ".ino": SLASHES,
        ".py": HASH, ".sh": HASH, ".cmake": HASH, ".toml": HASH}
STRING = re.compile(r'"(?:\\.|[^"\\])*"' + r"|'(?:\\.|[^'\\])*'")


def mark_of(path):
    return HASH if path.name in ("CMakeLists.txt", "dev") else MARK.get(path.suffix)


def comments(text, mark):
    """The first line of each comment with its number, from 1."""
    continued = False
    for number, line in enumerate(text.splitlines(), 1):
        found = mark.search(STRING.sub("", line))
        if found and not (continued and mark.match(line.lstrip())):
            yield number, found[1].strip()
        continued = bool(found) and "SPDX-License-Identifier" not in line


def files():
    paths = [path for folder in OURS for path in (ROOT / folder).rglob("*")]
    return sorted(path for path in [*ROOT.glob("dev"), *ROOT.glob("CMakeLists.txt"), *paths]
                  if path.is_file() and mark_of(path))


def main():
    found = [f"{path.relative_to(ROOT)}:{number}: expected a comment that begins with its subject, found «{words[:40]}»"
             for path in files() for number, words in comments(path.read_text(errors="replace"), mark_of(path))
             if FIRST_WORDS.match(words)]
    print("\n".join(found))
    return 1 if found else 0


sys.exit(main())
