# SPDX-License-Identifier: Apache-2.0
"""The include rule: a room includes the rooms that its CMake call USES, and all that stand below.

A room is a folder whose CMakeLists.txt calls kinalign_room: kinalign/motion, kinalign/formats/bvh,
apps/cli. It may also include the files of the folders it stands in, but not the other way round: a
parent never includes its child. No two rooms use each other in a circle. Other programs (apps/*, tools,
fuzz, bench) may include what their kinalign_* libraries reach, firmware the room wire alone, and
firmware/node nothing else of ours; tests any room. Heavy libraries stand in .cpp files only: see HEAVY.
A room's folder holds at most MOST_FILES files: what grows beyond them is two rooms.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__ + "/../..").resolve()
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]', re.M)
HEAVY = ("toml++/", "nlohmann/", "hdf5.h", "H5", "zip.h", "openssl/", "sqlite3.h", "archive.h", "archive_entry.h", "expat.h", "CLI/", "Eigen/")
HEADERS_MAY = ("Eigen/Core", "Eigen/Geometry", "nlohmann/json_fwd.hpp")
ENDINGS = {".h", ".hpp", ".cpp"}
HEADERS = {".h", ".hpp"}
MOST_FILES = 30
OURS = ("kinalign", "apps", "firmware", "tests", "tools", "bench", "fuzz")


def words_after(keyword, text):
    """The words of a CMake call between `keyword` and the next one in capitals."""
    found = re.search(rf"\b{keyword}\b\s+((?:[^A-Z\s)][^\s)]*\s*)*)", text)
    return found[1].split() if found else []


def folder_of(room):
    """formats/bvh stands in kinalign/formats/bvh, apps/cli in apps/cli."""
    return room if room.startswith("apps/") else f"kinalign/{room}"


def cmake_text(folder):
    """The folder's CMake files without comments, CMakeLists.txt first."""
    paths = [ROOT / folder / "CMakeLists.txt", *sorted((ROOT / folder).glob("*.cmake"))]
    return "".join(re.sub(r"#.*", "", path.read_text()) for path in paths if path.exists())


def rooms():
    """Each room and what it uses, as its CMake call says, with the room that it stands in."""
    uses = {}
    for path in sorted([*ROOT.glob("kinalign/**/CMakeLists.txt"), *ROOT.glob("apps/**/CMakeLists.txt")]):
        folder = path.parent.relative_to(ROOT)
        call = re.search(r"kinalign_room\(\s*([\w/]+)(.*?)\)", cmake_text(folder), re.S)
        if not call:
            if folder.parts[0] == "kinalign":
                sys.exit(f"{folder}/CMakeLists.txt: expected kinalign_room({folder.relative_to('kinalign')} ...)")
            continue
        if folder_of(call[1]) != str(folder):
            sys.exit(f"{folder}/CMakeLists.txt: expected kinalign_room of this folder, found {call[1]}")
        uses[call[1]] = words_after("USES", call[2])
    for room in uses:
        above = [str(folder) for folder in pathlib.PurePath(room).parents if str(folder) in uses]
        uses[room] += above[:1]  # the nearest, which uses the next
    return uses


def below(room, uses, way=()):
    """The room with all that it may include."""
    if room in way:
        sys.exit(f"rooms in a circle: {' -> '.join((*way, room))}")
    if room not in uses:
        sys.exit(f"{folder_of(way[-1]) if way else ''}: expected a room after USES, found {room}")
    return {room}.union(*(below(used, uses, (*way, room)) for used in uses[room]))


def linked_rooms(folder, uses):
    """What a program's folder may include: the rooms that its CMakeLists.txt links."""
    target = {room.replace("/", "_"): room for room in uses}
    linked = {target[name] for name in re.findall(r"\bkinalign_(\w+)", cmake_text(folder)) if name in target}
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


def faults(paths, own, allowed, uses):
    """`own`: the folder that the files stand in; `allowed`: rooms they may include."""
    homes = {folder_of(room) for room in allowed}
    is_room = own in map(folder_of, uses)
    # The files of the folders that a program's part stands in, as apps/kinalign/verbs.h.
    above = {str(p) for p in pathlib.PurePath(own).parents} if own.startswith("apps/") else set()
    for path in paths:
        for quote, name in INCLUDE.findall(path.read_text(errors="replace")):
            place = path.relative_to(ROOT)
            top, folder = name.split("/")[0], name.rpartition("/")[0]
            if path.suffix in HEADERS and name.startswith(HEAVY) and name not in HEADERS_MAY:
                yield f"{place}: <{name}> is heavy: only a .cpp file may include it"
            if quote == '"' and top not in OURS:
                yield f"{place}: \"{name}\": expected a path from the repository's root"
            if quote == '"' and not is_there(name):
                yield f"{place}: \"{name}\" is not there"
            if top == "kinalign" and folder not in homes:
                yield f"{place}: {own.removeprefix('kinalign/')} may not include {name}: it uses {', '.join(sorted(allowed))}"
            if own.startswith("apps") and top == "apps" and folder not in homes | above | {own}:
                yield f"{place}: {own} may not include {name}: a parent never includes its child, others by USES"
            if is_room and top in ("firmware", "tests", "tools") and not (own.startswith("apps") and top == "firmware"):
                yield f"{place}: a room may not include {name}"
            if own.startswith("kinalign") and top == "apps":
                yield f"{place}: a room may not include {name}"


def sources(folder, deep):
    found = folder.rglob("*") if deep else folder.glob("*")
    return sorted(p for p in found if p.suffix in ENDINGS)


def main():
    uses = rooms()
    found = []
    for room in uses:
        folder = folder_of(room)
        found += faults(sources(ROOT / folder, deep=False), folder, below(room, uses), uses)
        files = sum(path.is_file() for path in (ROOT / folder).iterdir())
        if files > MOST_FILES:
            found.append(f"{folder}: expected at most {MOST_FILES} files, found {files}: make a room of some that go together")
    folders = {str(p.parent.relative_to(ROOT)) for p in sources(ROOT / "kinalign", deep=True)}
    for folder in sorted(folders - set(map(folder_of, uses))):
        found.append(f"{folder}: no room: expected a CMakeLists.txt with kinalign_room")
    programs = [p for p in sorted(ROOT.glob("apps/*")) if p.is_dir() and str(p.relative_to(ROOT)) not in uses]
    for folder in programs:
        own = str(folder.relative_to(ROOT))
        found += faults(sources(folder, deep=False), own, linked_rooms(own, uses), uses)
    for own in ("tools", "fuzz", "bench"):
        found += faults(sources(ROOT / own, deep=True), own, linked_rooms(own, uses), uses)
    if (ROOT / "firmware").is_dir():
        found += faults(sources(ROOT / "firmware", deep=True), "firmware", {"wire"}, uses)
        found += node_faults()
    found += faults(sources(ROOT / "tests", deep=True), "tests", set(uses), uses)
    print("\n".join(found))
    return 1 if found else 0


sys.exit(main())
