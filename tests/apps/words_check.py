# SPDX-License-Identifier: Apache-2.0
"""What the program says of itself: help pages, man page, completions and settings agree.
words_check.py BUILD_FOLDER [CASE...]"""
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cases
from cases import Skip, case, done_with, kinalign, main

FLAG = re.compile(r"^  (?:-\w, )?(--[\w-]+)(?: ([\w|=-]+))?", re.M)


def verbs():
    """All verbs in the order of the help page; those of a group with two words."""
    all_of_them = []
    for name, group in re.findall(r"^  ([\w-]+)( \.\.\.)?  +\w", done_with(0, "help")[0].split("\nverbs\n")[1], re.M):
        listed = done_with(0, name, "--help")[0].split("\nverbs\n")[1] if group else ""
        all_of_them += re.findall(rf"^  ({name} [\w-]+)  +\w", listed, re.M) if group else [name]
    return all_of_them


def page(verb):
    return done_with(0, *verb.split(), "--help")[0]


def flags(verb):
    """Of the help page: each flag with what stands behind it."""
    return dict(FLAG.findall(page(verb).split("\nusage  ")[1]))


def run(*words, **how):
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, timeout=60, **how)
    assert done.returncode == 0, f"{words}\n{done.stdout}{done.stderr}"
    return done.stdout


def offered_by_bash(folder, *questions):
    """For each list of words, the last one begun, what bash offers in its place."""
    script = folder / "ask.sh"
    script.write_text(f"source <('{cases.PROGRAM}' completion bash)\n"
                      "ask() { COMP_WORDS=(kinalign \"$@\"); COMP_CWORD=$#; _kinalign; echo \"${COMPREPLY[*]}\"; }\n"
                      + "".join(f"ask {shlex.join(words)}\n" for words in questions))
    return [set(line.split()) for line in run("bash", script).splitlines()]


def sections(text, head):
    """The parts of the man page that begin with such a line, by the first word or two behind it."""
    return {part.split("\n")[0]: part.split("\n.S")[0] for part in text.split(f"\n{head} ")[1:]}


@case
def the_man_page_has_every_verb_with_the_flags_of_its_help_page(folder):
    roff = done_with(0, "man")[0]
    assert not re.search(r"(?<!\\)-", roff), "roff makes a hyphen of a minus sign, which nobody can type"
    text = roff.replace("\\-", "-")
    everywhere = set(re.findall(r"^\.B .*?(--[\w-]+)", sections(text, ".SH")["FLAGS OF EVERY VERB"], re.M))
    of_verbs = {re.match(r"kinalign ([a-z-]+(?: [a-z-]+)?) ", name.strip('"') + " ")[1]: part
                for name, part in sections(text, ".SS").items()}
    assert list(of_verbs) == verbs(), list(of_verbs)
    for verb, part in of_verbs.items():
        own = set(re.findall(r"^\.B (?:-\w, )?(--[\w-]+)", part, re.M))
        assert not own & everywhere, own & everywhere
        assert own | everywhere == set(flags(verb)) | {"--help"}, (verb, own ^ set(flags(verb)))


@case
def what_man_shows_can_be_typed_as_it_stands(folder):
    if not shutil.which("man"):
        raise Skip("no man")
    (folder / "kinalign.1").write_text(done_with(0, "man")[0])
    shown = run("man", "-E", "UTF-8", "-l", folder / "kinalign.1", env={"MANWIDTH": "400", "PATH": "/usr/bin:/bin"})
    shown = re.sub(r".\x08", "", shown)
    for verb in verbs():
        examples = [l.strip() for l in page(verb).split(f"\n{verb}: ")[0].splitlines() if l.startswith("  kinalign ")]
        for command in [*examples, *flags(verb)]:
            assert command in shown, f"{command} is not in what man shows"


@case
def bash_offers_the_flags_of_the_help_page_and_the_choices_that_the_program_takes(folder):
    for verb in verbs():
        taken = flags(verb)
        every, *values = offered_by_bash(folder, (*verb.split(), "--"), *((*verb.split(), flag, "") for flag in taken))
        assert every == set(taken) | {"--help"}, (verb, every)
        for (flag, behind), offered in zip(taken.items(), values, strict=True):
            if "|" in behind:
                assert offered == set(behind.split("|")), f"{verb} {flag}: {offered}, not {behind}"
            for word in offered if "|" in behind else ():
                done_with(0, *verb.split(), flag, word, "--help")  # words in front of --help are judged


@case
def what_stands_behind_a_flag_says_what_it_is(_):
    text = {f"{verb} {flag}" for verb in verbs() for flag, behind in flags(verb).items() if behind == "TEXT"}
    assert not text, text
    assert flags("time-server")["--listen"] == "ADDRESS" and flags("node-key")["--new-lab-key"] == "FILE"


@case
def zsh_and_fish_offer_the_same_flags(folder):
    zsh, fish = (done_with(0, "completion", shell)[0] for shell in ("zsh", "fish"))
    for verb in verbs():
        arguments = zsh.split(f"\n    '{verb}') _arguments")[1].split(";;")[0]
        assert set(re.findall(r"'\*?(--[\w-]+)\[", arguments)) == set(flags(verb)), verb
        of_verb = "; and ".join(f"__fish_seen_subcommand_from {word}" for word in verb.split())
        lines = [l for l in fish.splitlines() if f" '{of_verb}'" in l]
        assert {f"--{name}" for l in lines for name in re.findall(r" -l ([\w-]+)", l)} == set(flags(verb)), verb
    if shutil.which("fish"):
        (folder / "kinalign.fish").write_text(fish)
        for verb in verbs():
            asked = f"source '{folder}/kinalign.fish'; complete -C 'kinalign {verb} --'"
            offered = {l.split("\t")[0] for l in run("fish", "--no-config", "-c", asked).splitlines()}
            assert set(flags(verb)) <= offered, (verb, set(flags(verb)) - offered)


@case
def a_word_that_is_no_choice_is_refused_with_those_of_the_help_page(folder):
    for verb in verbs():
        for flag, behind in flags(verb).items():
            if "|" not in behind:
                continue
            _, err = done_with(2, *verb.split(), flag, "neither")
            *most, last = behind.split("|")
            assert err.startswith(f"kinalign {verb}: {flag}: expected {', '.join(most)} or {last}, found neither"), err


def settings(**how):
    """What is in force: (verb, name) to value and whence."""
    said = json.loads(done_with(0, "config", "--json", **how)[0])["settings"]
    return {(one["verb"], one["name"]): (one["value"], one["whence"]) for one in said}


def another(verb, name, value):
    """Another value of a setting that the program takes, by what its help page says."""
    behind = flags(verb or "align")["--" + name.replace("_", "-")]
    if not behind:
        return "false" if value == "true" else "true"
    return [word for word in [*behind.split("|"), "7"] if word != value and not word.isupper()][0]


@case
def the_standard_value_in_a_help_page_is_the_one_in_force(folder):
    none = {"HOME": str(folder), "XDG_CONFIG_HOME": ""}
    told = 0
    for (verb, name), (value, whence) in settings(cwd=folder, env=none).items():
        assert whence == "standard", (verb, name, whence)
        text = re.sub(r"\s+", " ", page(verb or "align"))
        described = re.search(rf" --{name.replace('_', '-')} [^[]*?(?:\[(\S*)\] )?(?=--|-\w, --|flags of all verbs|$)", text)
        told += described.group(1) is not None
        assert described.group(1) in (None, value), (verb, name, value, described.group(1))
    assert told >= 4, told


@case
def every_setting_is_taken_from_each_place_and_the_nearer_place_wins(folder):
    project, user = folder / "kinalign.toml", folder / ".config/kinalign/config.toml"
    user.parent.mkdir(parents=True)
    deep = folder / "a/b"
    deep.mkdir(parents=True)
    how = {"cwd": deep, "env": {"HOME": str(folder), "XDG_CONFIG_HOME": ""}}

    def line(verb, name, value):
        number = re.fullmatch(r"[\d.]+|true|false", value)
        return (f"[{verb}]\n" if verb else "") + f"{name} = {value if number else json.dumps(value)}\n"

    standard = settings(**how)
    for (verb, name), (value, _) in standard.items():
        if name in ("quiet", "verbose", "color"):
            continue  # they change what config itself prints
        other = another(verb, name, value)
        user.write_text(line(verb, name, other))
        assert settings(**how)[verb, name] == (other, str(user)), (verb, name)
        project.write_text(line(verb, name, value) if value else "")
        if value:
            assert settings(**how)[verb, name] == (value, str(project)), (verb, name)
        variable = f"KINALIGN_{name.upper()}"
        nearer = {**how, "env": {**how["env"], variable: other}}
        assert settings(**nearer)[verb, name] == (other, variable), (verb, name)
        changed = {key for key, said in settings(**nearer).items() if said != standard[key]}
        assert {n for _, n in changed} == {name}, changed
        project.unlink()
    user.unlink()
    assert settings(**how) == standard


@case
def a_flag_that_is_nearly_one_is_answered_with_it(folder):
    for verb in verbs():
        known = flags(verb)
        for i, flag in enumerate(known):
            if len(flag) < 6:
                continue  # too short to be told from others
            wrong = (flag + "s", flag[:3] + flag[4:], flag[:4] + "x" + flag[5:])[i % 3]
            done = kinalign(verb, wrong)
            assert done.returncode == 2, (verb, wrong)
            near = re.search(rb"did you mean (--[\w-]+)\?", done.stderr)
            assert near and near.group(1).decode() in known, (verb, wrong, done.stderr)


if __name__ == "__main__":
    sys.exit(main())
