# SPDX-License-Identifier: Apache-2.0
"""What README.md and docs/ show is what the program prints: pages_check.py KINALIGN DEMO_RECORDING [--write]

Every command of a block fenced as ```console runs, each page in a fresh folder that holds what ./dev
demo leaves: a recording in demo/ (seed 1, 60 s) and its take; what it prints must be what stands below it. A line `...` stands
for any number of lines. A block that names ../shared/data or docs/examples is skipped where that
data is absent, one that trains where kinalign-learn was not built. Each command is a case. --write puts what is printed into the pages instead.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SHARED = ROOT.parent / "shared"
LEARN = pathlib.Path(sys.argv[1]).resolve().parents[1] / "kinalign-learn/kinalign-learn"
BLOCK = re.compile(r"^```console\n(.*?)^```$", re.S | re.M)
# ./dev demo builds and makes the recording, which is done here already; what it prints is align's.
STANDS_FOR = {"./dev demo": "kinalign align demo/recording.toml -o demo/take.h5 --force"}


def commands_of(block):
    """[command, its lines, expected lines] in order. A command goes on after a backslash at the end of its line,
    and after <<END up to a line END."""
    found = []
    here_document = False
    for line in block.splitlines():
        if here_document:
            found[-1][0] += "\n" + line
            found[-1][1].append(line)
            here_document = line != "END"
        elif line.startswith("$ "):
            found.append([line[2:], [line], []])
            here_document = line.endswith("<<END")
        elif found and found[-1][0].endswith("\\") and not found[-1][2]:
            found[-1][0] = found[-1][0][:-1] + line.strip()
            found[-1][1].append(line)
        elif found:
            found[-1][2].append(line.rstrip())
    return found


def same(expected, printed):
    """Lines against lines; "..." stands for any number of them."""
    pattern = "".join(r"(?:.*\n)*?" if line.strip() == "..." else re.escape(line) + r"\n"
                      for line in expected)
    return re.fullmatch(pattern, "".join(line.rstrip() + "\n" for line in printed)) is not None


def written(page, outputs):
    """The page with what its commands printed; what stands around a "..." stays as it is."""
    def block(found):
        lines = []
        for _, command_lines, expected in commands_of(found[1]):
            printed = next(outputs)
            lines += command_lines + (expected if "..." in expected else printed)
        return "```console\n" + "".join(line.rstrip() + "\n" for line in lines) + "```"
    page.write_text(BLOCK.sub(block, page.read_text()))


def run(command, folder, environment):
    done = subprocess.run(["bash", "-c", STANDS_FOR.get(command, command)], cwd=folder,
                          env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False, timeout=300)
    return done.stdout.splitlines()


def check_page(page, folder, environment, say):
    """What the page's commands printed, in order."""
    outputs = []
    for block in BLOCK.finditer(page.read_text()):
        line = page.read_text()[: block.start()].count("\n") + 1
        needs_data = "../shared/" in block[1] or "docs/examples/" in block[1]
        trains = "kinalign train" in block[1] or "kinalign eval" in block[1]
        for command, _, expected in commands_of(block[1]):
            name = f"{page.relative_to(ROOT)}:{line} shows what `{command}` prints"
            if (needs_data and not SHARED.exists()) or (trains and not LEARN.exists()):
                say("skipped", f"{name}\tneeds kinalign-learn (libtorch-dev)" if trains else name)
                outputs.append(expected)
                continue
            printed = run(command, folder, environment)
            outputs.append(printed)
            if same(expected, printed):
                say("passed", name)
            else:
                print(f"{name}\n--- expected\n" + "\n".join(expected))
                print("--- printed\n" + "\n".join(printed))
                say("failed", name)
    return outputs


def main():
    kinalign, demo_recording = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
    environment = {"PATH": f"{kinalign.parent}:{kinalign.parents[2]}/examples:/usr/bin:/bin", "HOME": "/nowhere", "LC_ALL": "C.UTF-8"}
    log = os.environ.get("KINALIGN_TEST_LOG")
    outcomes = []

    def say(outcome, name):
        outcomes.append(outcome)
        if log:
            with open(log, "a", encoding="utf-8") as out:
                out.write(f"{outcome}\t{name}\n")

    pages = [ROOT / "README.md", *sorted(ROOT.glob("docs/**/*.md"))]
    for page in [p for p in pages if BLOCK.search(p.read_text())]:
        with tempfile.TemporaryDirectory(prefix="kinalign-pages-") as name:
            folder = pathlib.Path(name) / "kinalign"
            for copied in ("docs/examples", "layouts"):
                shutil.copytree(ROOT / copied, folder / copied)
            if SHARED.exists():
                (pathlib.Path(name) / "shared").symlink_to(SHARED)
            subprocess.run([demo_recording, folder / "demo", "--seed", "1", "--seconds", "60"], check=True)
            run("./dev demo", folder, environment)
            outputs = check_page(page, folder, environment, say)
            if "--write" in sys.argv:
                written(page, iter(outputs))
    print(f"{outcomes.count('passed')} of {len(outcomes)} commands print what is shown")
    return 1 if "failed" in outcomes or not outcomes else 0


sys.exit(main())
