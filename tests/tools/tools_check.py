# SPDX-License-Identifier: Apache-2.0
"""The tools' own cases, counted like the others: a sentence, a small tree, the exact outcome."""
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))
from run_cases import case, run_cases


def put(folder, name, text):
    path = pathlib.Path(folder) / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def run(*command, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False,
                          **options)
    return done.returncode, done.stdout + done.stderr


def includes(folder):
    return run(sys.executable, ROOT / "tools/check_includes.py", folder)


def house(folder):
    put(folder, "kinalign/wire/CMakeLists.txt", "kinalign_room(wire SOURCES a.cpp)\n")
    put(folder, "kinalign/wire/a.h", "")
    put(folder, "kinalign/core/CMakeLists.txt", "kinalign_room(core USES wire)  # a word\n")
    put(folder, "kinalign/core/b.h", '#include "kinalign/wire/a.h"\n')
    put(folder, "kinalign/io/CMakeLists.txt", "kinalign_room(io SOURCES c.cpp USES core LIBRARIES X::X)\n")
    put(folder, "kinalign/io/c.cpp", '#include "kinalign/wire/a.h"\n#include <hdf5.h>\n')


@case
def a_room_may_include_what_it_uses_and_all_below(folder):
    house(folder)
    assert includes(folder) == (0, "\n"), includes(folder)


@case
def a_room_may_not_include_what_stands_above(folder):
    house(folder)
    put(folder, "kinalign/wire/a.h", '#include "kinalign/core/b.h"\n')
    code, text = includes(folder)
    assert code == 1
    assert text == "kinalign/wire/a.h: wire may not include kinalign/core/b.h: it uses wire\n", text


@case
def a_child_may_include_its_parent_and_not_the_other_way_round(folder):
    house(folder)
    put(folder, "kinalign/io/d.h", '#include "kinalign/core/b.h"\n')
    put(folder, "kinalign/io/bvh/CMakeLists.txt", "kinalign_room(io/bvh SOURCES e.cpp)\n")
    put(folder, "kinalign/io/bvh/e.h", '#include "kinalign/io/d.h"\n#include "kinalign/wire/a.h"\n')
    assert includes(folder) == (0, "\n"), includes(folder)
    put(folder, "kinalign/io/c.cpp", '#include "kinalign/io/bvh/e.h"\n')
    code, text = includes(folder)
    assert code == 1
    assert text == "kinalign/io/c.cpp: io may not include kinalign/io/bvh/e.h: it uses core, io, wire\n", text


@case
def a_child_of_a_child_may_include_both_parents_also_beyond_a_folder_that_is_no_room(folder):
    house(folder)
    put(folder, "kinalign/io/d.h", "")
    put(folder, "kinalign/io/far/bvh/CMakeLists.txt", "kinalign_room(io/far/bvh SOURCES e.cpp)\n")
    put(folder, "kinalign/io/far/bvh/e.hpp", '#include "kinalign/io/d.h"\n')
    put(folder, "kinalign/io/far/bvh/deep/CMakeLists.txt", "kinalign_room(io/far/bvh/deep)\n")
    put(folder, "kinalign/io/far/bvh/deep/f.h",
        '#include "kinalign/io/far/bvh/e.hpp"\n#include "kinalign/io/d.h"\n')
    assert includes(folder) == (0, "\n"), includes(folder)


@case
def a_room_of_too_many_files_is_told_to_be_divided(folder):
    house(folder)
    for i in range(28):
        put(folder, f"kinalign/io/f{i}.h", "")
    assert includes(folder) == (0, "\n"), includes(folder)
    put(folder, "kinalign/io/g.h", "")
    code, text = includes(folder)
    assert code == 1 and text.startswith("kinalign/io: expected at most 30 files, found 31"), text


@case
def siblings_include_each_other_only_by_uses(folder):
    house(folder)
    put(folder, "kinalign/io/bvh/CMakeLists.txt", "kinalign_room(io/bvh)\n")
    put(folder, "kinalign/io/bvh/e.h", "")
    put(folder, "kinalign/io/xdf/CMakeLists.txt", "kinalign_room(io/xdf USES io/bvh)\n")
    put(folder, "kinalign/io/xdf/f.h", '#include "kinalign/io/bvh/e.h"\n')
    assert includes(folder) == (0, "\n"), includes(folder)
    put(folder, "kinalign/io/xdf/CMakeLists.txt", "kinalign_room(io/xdf)\n")
    assert includes(folder)[0] == 1


@case
def a_part_of_a_program_is_a_room_too(folder):
    house(folder)
    put(folder, "apps/cli/CMakeLists.txt", "kinalign_room(apps/cli USES core)\n")
    put(folder, "apps/cli/verb.h", '#include "kinalign/core/b.h"\n')
    put(folder, "apps/k/CMakeLists.txt", "target_link_libraries(k kinalign_apps_cli)\n")
    put(folder, "apps/k/main.cpp", '#include "apps/cli/verb.h"\n')
    assert includes(folder) == (0, "\n"), includes(folder)
    put(folder, "apps/cli/verb.h", '#include "apps/k/main.h"\n')
    put(folder, "apps/k/main.h", "")
    assert includes(folder)[0] == 1


@case
def a_header_may_not_include_a_heavy_library(folder):
    house(folder)
    put(folder, "kinalign/io/d.h", "#include <nlohmann/json.hpp>\n#include <Eigen/Core>\n")
    code, text = includes(folder)
    assert code == 1
    assert text == "kinalign/io/d.h: <nlohmann/json.hpp> is heavy: only a .cpp file may include it\n"


@case
def rooms_in_a_circle_are_refused(folder):
    house(folder)
    put(folder, "kinalign/wire/CMakeLists.txt", "kinalign_room(wire USES io)\n")
    code, text = includes(folder)
    assert code == 1 and text.startswith("rooms in a circle: "), text


@case
def firmware_may_include_wire_and_its_logic_no_board(folder):
    house(folder)
    put(folder, "firmware/node/a.h", '#include "kinalign/wire/a.h"\n#include <span>\n')
    put(folder, "firmware/board/config.example.h", "")
    put(folder, "firmware/board/b.cpp",
        '#include "firmware/board/config.h"\n#include "firmware/node/a.h"\n')
    assert includes(folder) == (0, "\n"), includes(folder)
    put(folder, "firmware/node/a.h", '#include "firmware/board/config.h"\n')
    put(folder, "firmware/board/b.cpp", '#include "kinalign/core/b.h"\n')
    put(folder, "kinalign/wire/a.h", '#include "firmware/node/a.h"\n')
    code, text = includes(folder)
    assert code == 1
    assert text == (
        "kinalign/wire/a.h: a room may not include firmware/node/a.h\n"
        "firmware/board/b.cpp: firmware may not include kinalign/core/b.h: it uses wire\n"
        "firmware/node/a.h: the node's logic may not include firmware/board/config.h: it knows no board\n"
    ), text


@case
def an_app_reaches_the_rooms_that_it_links(folder):
    house(folder)
    put(folder, "apps/a/CMakeLists.txt", "target_link_libraries(a kinalign_core)\n")
    put(folder, "apps/a/main.cpp", '#include "kinalign/wire/a.h"\n')
    assert includes(folder)[0] == 0
    put(folder, "kinalign/io/e.h", "")
    put(folder, "apps/a/main.cpp", '#include "kinalign/io/e.h"\n')
    assert includes(folder)[0] == 1


def count(folder, log, elsewhere="0", ctest=""):
    put(folder, "log", log)
    put(folder, "ctest", ctest)
    return run(sys.executable, ROOT / "tools/count_cases.py", "log", "ctest", elsewhere, cwd=folder)


@case
def the_count_names_skipped_cases_and_ends_with_the_numbers(folder):
    code, text = count(folder, "passed\ta\nskipped\tKeraal\npassed\tb\nskipped\tc\tis slow\n")
    assert code == 0
    assert text == ("skipped, is slow:\n  c\n"
                    "skipped, needs ../shared/data, which is not there:\n  Keraal\n"
                    "2 passed, 0 failed, 2 skipped\n"), text


@case
def a_failed_case_a_crash_and_a_failed_check_each_fail_the_run(folder):
    code, text = count(folder, "failed\ta\n")
    assert code == 1 and text == "failed: a\n0 passed, 1 failed, 0 skipped\n", text
    code, text = count(folder, "passed\ta\n", "1", "\t  3 - io (SEGFAULT)\n")
    assert code == 1 and text.endswith("1 passed, 1 failed, 0 skipped\n"), text
    code, text = count(folder, "passed\ta\n", "1")
    assert code == 1 and text.endswith("1 passed, 0 failed, 0 skipped\n"), text


@case
def packages_that_are_there_are_not_asked_for(folder):
    put(folder, "packages.txt", "# dpkg build\ndpkg build\nno-such-package-here test # a word\n")
    missing = ROOT / "tools/missing_packages.sh"
    assert run(missing, "packages.txt", "build", cwd=folder) == (0, "")
    assert run(missing, "packages.txt", "build", "test", cwd=folder) == (0, "no-such-package-here\n")


def dev_with_a_fake_apt(folder, apt_get):
    """./dev where a package is missing and apt-get is a script; its exit code, and what it prints."""
    put(folder, "packages.txt", "no-such-package-here build\n")
    for name in ("dev", "tools/missing_packages.sh"):
        put(folder, name, (ROOT / name).read_text()).chmod(0o755)
    for name, script in {"apt-get": apt_get, "sudo": 'exec "$@"', "cmake": "", "sleep": ""}.items():
        put(folder, f"fake/{name}", f"#!/bin/sh\n{script}\n").chmod(0o755)
    environment = {**os.environ, "PATH": f"{folder}/fake:{os.environ['PATH']}", "KINALIGN_NO_PACKAGES": ""}
    return run(f"{folder}/dev", "build", "release", env=environment)


@case
def dev_waits_for_another_package_manager(folder):
    lock = "E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7 (aptd)"
    code, text = dev_with_a_fake_apt(
        folder, f'echo "$@" >>calls; [ -e busy ] || {{ touch busy; echo "{lock}"; exit 100; }}')
    assert code == 0, text
    assert text == ("dev: installing no-such-package-here\n"
                    "dev: waiting for another package manager, up to two minutes\n"), text
    calls = (pathlib.Path(folder) / "calls").read_text().splitlines()
    assert calls == ["-qy update", "-qy update",
                     "-qy install --no-install-recommends no-such-package-here"], calls


@case
def dev_prints_why_a_package_could_not_be_installed(folder):
    code, text = dev_with_a_fake_apt(
        folder, '[ "$2" = update ] || { echo "E: Unable to locate package $4"; exit 100; }')
    assert code == 3
    assert text == ("dev: installing no-such-package-here\n"
                    "E: Unable to locate package no-such-package-here\n"
                    f"dev: could not install no-such-package-here: see {folder}/build/apt_*.log; "
                    "if they come from elsewhere, set KINALIGN_NO_PACKAGES=1\n"), text


@case
def dev_names_its_verbs_and_refuses_others(folder):
    code, text = run(ROOT / "dev", "--help", cwd=folder)
    assert code == 0 and "./dev test" in text
    code, text = run(ROOT / "dev", "tset", cwd=folder)
    assert code == 2 and "usage" in text


@case
def every_fault_of_docs_faults_has_tests_by_its_number_and_name(folder):
    # Forty of them, «fault 4 counter_step_fwd».
    listed, tested = {}, {}
    for number, names in re.findall(r"^\| (\d+) \| ([^|]*)", (ROOT / "docs/faults.md").read_text(), re.M):
        listed[int(number)] = set(re.findall(r"`(\w+)`", names))
    for path in (ROOT / "tests").rglob("*_test.cpp"):
        for number, names in re.findall(r'TEST_CASE\(\s*"fault (\d+) ([^":]*):', path.read_text()):
            tested.setdefault(int(number), set()).update(re.split(r", ", names))
    assert sorted(listed) == list(range(1, 41)), set(range(1, 41)) ^ set(listed)
    for number, names in listed.items():
        assert tested.get(number) == names, (number, names ^ tested.get(number, set()))


@case
def a_comment_may_not_begin_with_what_it_is_not_about(folder):
    put(folder, "kinalign/a.cpp", '// Of nodes only the first.\nint a = 1;  // As in b.h\n'
                                  '// The sum, of all.\n// What follows belongs to it.\nauto b = "// Who";\n')
    put(folder, "tools/b.py", "# SPDX-License-Identifier: Apache-2.0\n# Where it lies\n")
    put(folder, "kinalign/CMakeLists.txt", "# In which room\n")
    code, text = run(sys.executable, ROOT / "tools/check_comments.py", folder)
    says = "expected a comment that begins with its subject, found"
    assert code == 1
    assert text == (f"kinalign/CMakeLists.txt:1: {says} «In which room»\n"
                    f"kinalign/a.cpp:1: {says} «Of nodes only the first.»\n"
                    f"kinalign/a.cpp:2: {says} «As in b.h»\n"
                    f"tools/b.py:2: {says} «Where it lies»\n"), text


@case
def a_page_is_short_and_indexed_and_its_links_lead_to_headings(folder):
    verbs = put(folder, "kinalign", "#!/bin/sh\necho; echo verbs; echo '  align   makes a take'; echo\n")
    put(folder, "dev", "#!/bin/sh\necho usage; echo; echo '  test   tests'; echo\n").chmod(0o755)
    verbs.chmod(0o755)
    put(folder, "CONTRIBUTING.md", "`./dev test`\n")
    put(folder, "docs/README.md", "[a](a.md) [gone](gone.md)\n")
    put(folder, "docs/a.md", "# A page\n`kinalign align`\n## Limits, and `why`\n[here](#limits-and-why) [no](#reasons)\n")
    put(folder, "docs/b.md", "line\n" * 151)
    code, text = run(sys.executable, ROOT / "tools/check_docs.py", verbs, folder)
    assert code == 1
    assert text == ("docs/README.md: the link gone.md leads nowhere\n"
                    "docs/a.md: the link #reasons leads to a page without that heading\n"
                    "docs/b.md: expected at most 150 lines, found 151: split it by the reader's question\n"
                    "docs/README.md: expected a link to b.md\n"), text


sys.exit(run_cases("kinalign tools "))
