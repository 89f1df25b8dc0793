#!/usr/bin/python3
"""One-line faults in numerical code, drawn by a seed, and whether `canyon stress` notices them.

    mutants.py draw --seed 1 --count 30            writes them to tests/mutations.toml
    mutants.py try [--only 3,7] [--work FOLDER]    puts each into a copy of the tree, builds it there, runs the short suite
    mutants.py check                               that each line of mutations.toml still stands where it says

A fault is a wrong sign, factor, index, order of subtraction, comparison, constant (by 10) or trigonometric function, or a guard
that is not there; it is drawn from all lines that could have one, file by file, so that no long file has them all. `try` prints
a line for each: killed (by which cases), survived, or does not compile (drawn again by hand), and ends with status 1 if fewer
than --least are killed.
"""
import argparse
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIST = ROOT / "tests/mutations.toml"
FOLDERS = ["core/earth", "core/math", "core/motion", "core/random", "scene/ground", "scene/tracing", "gnss/satellites", "gnss/errors",
           "gnss/atmosphere", "gnss/paths", "gnss/receiver", "gnss/solver", "inertial/motion", "inertial/mems", "inertial/errors",
           "lidar/beam", "lidar/receiver", "lidar/registration", "fusion", "mission/motion", "mission/scoring"]

# (what it is, what is looked for, what takes its place)
KINDS = [
    ("sign", r"(?<=[\w\)\]]) \+ (?=[\w\(])", " - "),
    ("sign", r"(?<=[\w\)\]]) - (?=[\w\(])", " + "),
    ("sign", r"\+= ", "-= "),
    ("sign", r"-= ", "+= "),
    ("factor", r"(?<=[\w\)\]]) \* (?=[\w\(])", " / "),
    ("factor", r"(?<=[\w\)\]]) / (?=[\w\(])", " * "),
    ("index", r"\.x\(\)", ".y()"),
    ("index", r"\.y\(\)", ".x()"),
    ("index", r"\[i\]", "[0]"),
    ("index", r"\(0, 0\)", "(1, 1)"),
    ("order", r"(\b\w+(?:\.\w+)*) - (\w+(?:\.\w+)*\b)(?![\(\.\[])", r"\2 - \1"),
    ("comparison", r"(?<=\w) < (?=\w)", " > "),
    ("comparison", r"(?<=\w) > (?=\w)", " < "),
    ("constant", r"(?<![\w.])(?!0\.0\b)(\d+\.\d+)\b(?!e)", r"10.0 * \1"),
    ("constant", r"\b(\d(?:\.\d+)?e-\d+)\b", r"1e6 * \1"),
    ("function", r"std::sin\(", "std::cos("),
    ("function", r"std::cos\(", "std::sin("),
    ("guard", r"^(\s*)if \(.*\) (?:return|continue)\b.*;$", r"\1"),
]


def sources():
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.cpp")):
            if "/stress/" not in path.as_posix():
                yield path.relative_to(ROOT).as_posix()


def faults(name):
    """All faults that a file could have: (line number, kind, line before, line after)."""
    out = []
    for number, line in enumerate((ROOT / name).read_text(encoding="utf-8").split("\n"), 1):
        code = line.split("//")[0].rstrip()
        if not code.strip() or '"' in code or code.lstrip().startswith(("#", "template", "using", "constexpr const char")):
            continue
        for kind, wanted, instead in KINDS:
            for match in re.finditer(wanted, code):
                after = code[:match.start()] + match.expand(instead) + code[match.end():]
                if after != code:
                    out.append((number, kind, code, after.rstrip()))
    return out


def draw(seed, count):
    """`count` faults, one from each of as many files, as TOML."""
    generator = random.Random(seed)
    names = [name for name in sources() if faults(name)]
    rows = []
    for name in generator.sample(names, count):
        kinds = sorted({kind for _, kind, _, _ in faults(name)})
        kind = generator.choice(kinds)
        number, kind, before, after = generator.choice([fault for fault in faults(name) if fault[1] == kind])
        rows.append((name, number, kind, before, after))
    text = f"# Drawn by tests/mutants/mutants.py draw --seed {seed} --count {count}.\nseed = {seed}\n"
    for name, number, kind, before, after in rows:
        text += f"\n[[mutant]]\nfile = {json.dumps(name)}\nline = {number}\nkind = \"{kind}\"\n"
        text += f"before = {json.dumps(before.strip())}\nafter = {json.dumps(after.strip())}\n"
    return text


def read_list():
    return tomllib.loads(LIST.read_text(encoding="utf-8"))["mutant"]


def place_of(mutant, root):
    """Index of the mutant's line: where it was drawn, else the nearest that reads the same; None if there is none."""
    lines = (root / mutant["file"]).read_text(encoding="utf-8").split("\n")
    same = [i for i, line in enumerate(lines) if line.split("//")[0].strip() == mutant["before"]]
    return min(same, key=lambda i: abs(i + 1 - mutant["line"])) if same else None


def apply(mutant, root):
    path = root / mutant["file"]
    lines = path.read_text(encoding="utf-8").split("\n")
    at = place_of(mutant, root)
    indent = lines[at][: len(lines[at]) - len(lines[at].lstrip())]
    lines[at] = indent + mutant["after"]
    path.write_text("\n".join(lines), encoding="utf-8")


def attempt(mutant, work, jobs):
    """(verdict, which cases) of one fault in the copy of the tree."""
    original = (ROOT / mutant["file"]).read_text(encoding="utf-8")
    apply(mutant, work)
    try:
        built = subprocess.run(["ninja", "-C", work / "build/release", f"-j{jobs}", "canyon"], capture_output=True, text=True, check=False)
        if built.returncode != 0:
            return "does not compile", []
        try:
            ran = subprocess.run([work / "build/release/bin/canyon", "stress", "--json", "--threads", str(jobs)], capture_output=True,
                                 text=True, timeout=900, check=False)
        except subprocess.TimeoutExpired:
            return "killed", ["no end after 900 s"]
        if ran.returncode not in (0, 1):
            return "killed", [f"exit status {ran.returncode}"]
        failed = [case["name"] for case in json.loads(ran.stdout)["cases"] if not case["pass"] and "open" not in case]
        return ("killed", failed) if failed else ("survived", [])
    finally:
        (work / mutant["file"]).write_text(original, encoding="utf-8")


def copy_of_tree(work):
    shutil.copytree(ROOT, work, symlinks=True, dirs_exist_ok=True, ignore=shutil.ignore_patterns("build", ".git", "results"))
    for command in (["cmake", "--preset", "release", "-DCANYON_TESTS=OFF"], ["ninja", "-C", "build/release", "canyon"]):
        subprocess.run(command, cwd=work, check=True, stdout=subprocess.DEVNULL)


def try_all(options):
    work = pathlib.Path(options.work).resolve()
    copy_of_tree(work)
    only = {int(each) for each in options.only.split(",")} if options.only else None
    killed = tried = 0
    for number, mutant in enumerate(read_list(), 1):
        if only and number not in only:
            continue
        verdict, cases = attempt(mutant, work, options.jobs)
        tried += 1
        killed += verdict == "killed"
        print(f"{number:2} {verdict:16} {mutant['kind']:10} {mutant['file']}:{mutant['line']}: {mutant['after']}"
              + (f"   [{len(cases)}: {cases[0]}]" if cases else ""), flush=True)
    print(f"{killed} of {tried} killed")
    return 0 if killed >= options.least else 1


def check():
    lost = [mutant for mutant in read_list() if not (ROOT / mutant["file"]).exists() or place_of(mutant, ROOT) is None]
    for mutant in lost:
        print(f"{mutant['file']}:{mutant['line']}: {mutant['before']!r} is no more: draw again")
    return 1 if lost else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(dest="verb", required=True)
    drawing = verbs.add_parser("draw")
    drawing.add_argument("--seed", type=int, required=True)
    drawing.add_argument("--count", type=int, default=30)
    trying = verbs.add_parser("try")
    trying.add_argument("--only", default="")
    trying.add_argument("--work", default=str(ROOT / "build/mutants"))
    trying.add_argument("--jobs", type=int, default=2)
    trying.add_argument("--least", type=int, default=25)
    verbs.add_parser("check")
    options = parser.parse_args()
    if options.verb == "draw":
        LIST.write_text(draw(options.seed, options.count), encoding="utf-8")
        return 0
    return check() if options.verb == "check" else try_all(options)


if __name__ == "__main__":
    sys.exit(main())
