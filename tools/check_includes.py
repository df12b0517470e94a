# SPDX-License-Identifier: Apache-2.0
"""The include rule: a room includes the rooms that its CMake call USES, and all that stand below.

Rooms are the calls of kinalign_room in kinalign/*/CMakeLists.txt; programs (apps/*, tools, fuzz,
bench) may include what their kinalign_* libraries reach, firmware the room wire alone, and
firmware/node nothing else of ours; tests any room. No two rooms use each other in a circle. Heavy libraries stand in .cpp files only: see HEAVY.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__ + "/../..").resolve()
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]', re.M)
HEAVY = ("toml++/", "nlohmann/", "hdf5.h", "H5", "zip.h", "openssl/", "CLI/", "Eigen/")
HEADERS_MAY = ("Eigen/Core", "Eigen/Geometry", "nlohmann/json_fwd.hpp")
ENDINGS = {".h", ".cpp"}


def words_after(keyword, text):
    """The words of a CMake call between `keyword` and the next one in capitals."""
    found = re.search(rf"\b{keyword}\b\s+((?:[^A-Z\s)][^\s)]*\s*)*)", text)
    return found[1].split() if found else []


def rooms():
    """Each room and what it uses, as its CMake call says."""
    uses = {}
    for path in sorted(ROOT.glob("kinalign/*/CMakeLists.txt")):
        text = re.sub(r"#.*", "", path.read_text())
        call = re.search(r"kinalign_room\(\s*(\w+)(.*?)\)", text, re.S)
        if not call or call[1] != path.parent.name:
            sys.exit(f"{path.relative_to(ROOT)}: expected kinalign_room({path.parent.name} ...)")
        uses[call[1]] = words_after("USES", call[2])
    return uses


def below(room, uses, way=()):
    """The room with all that it may include."""
    if room in way:
        sys.exit(f"rooms in a circle: {' -> '.join((*way, room))}")
    if room not in uses:
        sys.exit(f"kinalign/{way[-1] if way else ''}: expected a room after USES, found {room}")
    return {room}.union(*(below(used, uses, (*way, room)) for used in uses[room]))


def program_rooms(folder, uses):
    """What a program's folder may include: the rooms that its CMakeLists.txt links."""
    path = folder / "CMakeLists.txt"
    text = re.sub(r"#.*", "", path.read_text()) if path.exists() else ""
    linked = {name for name in re.findall(r"\bkinalign_(\w+)", text) if name in uses}
    return set().union(*(below(room, uses) for room in linked))


def is_there(name):
    """A header, or one that everyone makes from an example: config.h from config.example.h."""
    path = ROOT / name
    return path.is_file() or path.with_suffix(".example" + path.suffix).is_file()


def node_faults():
    """What stands against the node's logic being the same files on every board."""
    for path in sorted((ROOT / "firmware/node").rglob("*.*")):
        for name in re.findall(r'#\s*include\s+"(?!kinalign/wire/|firmware/node/)([^"]+)"', path.read_text()):
            yield f"{path.relative_to(ROOT)}: the node's logic may not include {name}: it knows no board"


def faults(folder, allowed, uses, own):
    for path in sorted(p for p in folder.rglob("*") if p.suffix in ENDINGS):
        for quote, name in INCLUDE.findall(path.read_text(errors="replace")):
            place = path.relative_to(ROOT)
            parts = name.split("/")
            if path.suffix == ".h" and name.startswith(HEAVY) and name not in HEADERS_MAY:
                yield f"{place}: <{name}> is heavy: only a .cpp file may include it"
            if parts[0] == "kinalign" and (len(parts) < 3 or parts[1] not in allowed):
                yield f"{place}: {own} may not include {name}: it uses {', '.join(sorted(allowed))}"
            if quote == '"' and parts[0] not in ("kinalign", "apps", "firmware", "tests", "tools", "bench", "fuzz"):
                yield f"{place}: \"{name}\": expected a path from the repository's root"
            if quote == '"' and not is_there(name):
                yield f"{place}: \"{name}\" is not there"
            if own in uses and parts[0] in ("apps", "firmware", "tests", "tools"):
                yield f"{place}: a room may not include {name}"


def main():
    uses = rooms()
    found = []
    for room in uses:
        found += faults(ROOT / "kinalign" / room, below(room, uses), uses, room)
    for folder in [*sorted(ROOT.glob("apps/*")), ROOT / "tools", ROOT / "fuzz", ROOT / "bench"]:
        if folder.is_dir():
            own = str(folder.relative_to(ROOT))
            found += faults(folder, program_rooms(folder, uses), uses, own)
    if (ROOT / "firmware").is_dir():
        found += faults(ROOT / "firmware", {"wire"}, uses, "firmware")
        found += node_faults()
    found += faults(ROOT / "tests", set(uses), uses, "tests")
    print("\n".join(found))
    return 1 if found else 0


sys.exit(main())
