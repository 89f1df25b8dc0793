#!/usr/bin/python3
"""One-line faults in numerical code, drawn by a seed, and whether `canyon stress` notices them.

    mutants.py draw --seed 1 --count 30            writes them to tests/mutations.toml
    mutants.py try [--only 3,7] [--work FOLDER]    puts each into a copy of the tree, builds it there, runs the short suite
    mutants.py check                               that each line of the list still stands where it says
    mutants.py --list FILE draw|try|check ...      another list, as of a second seed

A fault is a wrong sign, factor, index, order of subtraction, comparison, constant (by 10) or trigonometric function, or a guard
that is not there. It is drawn from all lines of the numerical folders that could have one, headers too, every line alike, and
then one of the faults that the line could have; the only other rule is that the list has faults in 15 files at least.

A row that has been proved to change nothing says so, `equivalent = "why"`, and so does one that the compiler refuses,
`refused = "why"`; both stand beside the count: the next draw has taken their place. One that survives says which case is
missing, `missing = "case"`. All are kept when the same seed is drawn again.

`try` brings a copy of the tree up to date, file by file, and begins with it as it is, which must hold; so a second call compiles
nothing anew, and a fault costs its own file, a link and the suite, of which the cases of the file's own floor come first. A fault in
a header compiles whatever includes it. It prints a line for each fault: killed, and by what (a case that failed, a crash, a hang: ten
times the CPU time of the tree as it is, another exit status), survived, or does not compile. It ends with status 1 if fewer than
--least are killed.
"""
import argparse
import json
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIST = ROOT / "tests/mutations.toml"
FLOORS = ["core", "scene", "gnss", "inertial", "lidar", "fusion", "mission"]
# Rooms of configurations, texts and files, and the cases themselves.
NOT_NUMERICAL = ["core/config", "core/files", "core/output", "core/process", "core/printable_text", "core/tables", "scene/importers", "gnss/rinex",
                 "gnss/nmea", "gnss/tables", "inertial/catalogue", "inertial/log", "lidar/files", "mission/config", "mission/recorder"] + [floor + "/stress" for floor in FLOORS]
LEAST_FILES = 15
REMARKS = ("equivalent", "refused", "missing")
MEMORY_BYTES = 8 << 30

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
    for floor in FLOORS:
        for path in sorted((ROOT / floor).rglob("*")):
            name = path.relative_to(ROOT).as_posix()
            if path.suffix in (".cpp", ".h") and not name.startswith(tuple(room + end for room in NOT_NUMERICAL for end in "/.")):
                yield name


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


def spread(lines, count):
    """The first `count` of the shuffled lines, the last ones exchanged for later ones until 15 files have one."""
    taken, rest = lines[:count], lines[count:]
    while len({name for name, _ in taken}) < min(LEAST_FILES, count) and rest:
        files = [name for name, _ in taken]
        taken.pop(max(i for i, name in enumerate(files) if files.count(name) > 1))
        taken.append(rest.pop(0))
    return taken, rest


def counts(mutant):
    return "equivalent" not in mutant and "refused" not in mutant


def draw(seed, count, known):
    """`count` faults that count, and those of `known` that do not and are drawn on the way, as rows of the list."""
    generator = random.Random(seed)
    by_line = {}
    for name in sources():
        for fault in faults(name):
            by_line.setdefault((name, fault[0]), []).append(fault)
    lines = sorted(by_line)
    generator.shuffle(lines)
    chosen = {line: generator.choice(by_line[line]) for line in lines}
    remarks = {(row["file"], row["before"], row["after"]): row for row in known}

    def row(line):
        number, kind, before, after = chosen[line]
        out = {"file": line[0], "line": number, "kind": kind, "before": before.strip(), "after": after.strip()}
        old = remarks.get((out["file"], out["before"], out["after"]), {})
        return out | {key: old[key] for key in REMARKS if key in old}

    taken, rest = spread(lines, count)
    rows = [row(line) for line in taken]
    while sum(counts(each) for each in rows) < count and rest:
        rows.append(row(rest.pop(0)))
    return rows, len(lines)


def list_text(seed, count, rows, lines):
    text = f"# Drawn by tests/mutants/mutants.py draw --seed {seed} --count {count}, from {lines} lines.\nseed = {seed}\n"
    for each in rows:
        text += "\n[[mutant]]\n" + "".join(f"{key} = {json.dumps(value, ensure_ascii=False)}\n" for key, value in each.items())
    return text


def read_list(path):
    return tomllib.loads(path.read_text(encoding="utf-8"))["mutant"] if path.exists() else []


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


def limits(cpu_s):
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CPU, (int(cpu_s), int(cpu_s) + 5))


def run_cases(work, names, jobs, cpu_s):
    """(what became of these cases, or of all short ones, which cases or what else), "held" if nothing. A hang is told by CPU time,
    which other work on the machine does not change; what waits for nothing ends after an hour."""
    try:
        ran = subprocess.run([work / "build/release/bin/canyon", "stress", *names, "--json", "--threads", str(jobs)],
                             capture_output=True, text=True, timeout=3600.0, check=False, preexec_fn=lambda: limits(cpu_s))
    except subprocess.TimeoutExpired:
        return "hang", ["no end after an hour"]
    if ran.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return "hang", [f"no end after {cpu_s:.0f} s of CPU time"]
    if ran.returncode < 0:
        return "crash", [signal.Signals(-ran.returncode).name]
    try:
        cases = json.loads(ran.stdout)["cases"]
    except (ValueError, KeyError):
        return "crash", [f"exit status {ran.returncode}: {ran.stderr.strip()[:200]}"]
    failed = [case["name"] for case in cases if not case["pass"] and "open" not in case]
    if failed or ran.returncode == 1:
        return "case failed", failed
    return ("held", []) if ran.returncode == 0 else ("other exit", [f"exit status {ran.returncode}"])


def cases_by_floor(work):
    """Names of the short cases of each floor, by what stands before their "/" in its room stress/."""
    ran = subprocess.run([work / "build/release/bin/canyon", "stress", "--json"], capture_output=True, text=True, check=True)
    names = [case["name"] for case in json.loads(ran.stdout)["cases"]]
    out = {}
    for floor in FLOORS:
        texts = [path.read_text(encoding="utf-8") for path in (ROOT / floor / "stress").rglob("*.cpp")]
        subjects = {found for text in texts for found in re.findall(r'"([a-z_0-9]+)/', text)}
        out[floor] = [name for name in names if name.split("/")[0] in subjects]
    return out


def run_suite(work, own, jobs, cpu_s):
    """The whole short suite, `own` cases first: what they notice needs no others."""
    what, by = run_cases(work, own, jobs, cpu_s) if own else ("held", [])
    return (what, by) if what != "held" else run_cases(work, [], jobs, cpu_s)


def cpu_of_children_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def build(work, jobs):
    return subprocess.run(["ninja", "-C", work / "build/release", f"-j{jobs}", "canyon"], capture_output=True, text=True, check=False)


def attempt(mutant, work, own, jobs, cpu_s):
    """(verdict, by what) of one fault in the copy of the tree."""
    original = (ROOT / mutant["file"]).read_text(encoding="utf-8")
    apply(mutant, work)
    try:
        if build(work, jobs).returncode != 0:
            return "does not compile", []
        what, by = run_suite(work, own, jobs, cpu_s)
        return ("survived", []) if what == "held" else ("killed", [what] + by)
    finally:
        (work / mutant["file"]).write_text(original, encoding="utf-8")


def files_of(root):
    """Of a tree, without what builds and runs have made at its top; study/results is source."""
    return {path.relative_to(root) for top in sorted(root.iterdir()) if top.name not in ("build", ".git", "results")
            for path in ([top] if not top.is_dir() else top.rglob("*")) if path.is_file()}


def copy_of_tree(work, jobs):
    """The tree as it is. What differs there, as of a try before that was ended, gets a time of today; the rest keeps its own."""
    work.mkdir(parents=True, exist_ok=True)
    wanted = files_of(ROOT)
    for name in files_of(work) - wanted:
        (work / name).unlink()
    for name in wanted:
        to = work / name
        if not to.exists() or to.read_bytes() != (ROOT / name).read_bytes():
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, to)
    # File by file and not eight as one, and linked by what is quick, where it is there.
    linker = [f"-DCMAKE_{what}_LINKER_FLAGS=-fuse-ld=lld" for what in ("EXE", "MODULE") if shutil.which("ld.lld")]
    subprocess.run(["cmake", "--preset", "release", "-DCANYON_TESTS=OFF", "-DCANYON_PRECOMPILED_HEADERS=OFF"] + linker, cwd=work, check=True,
                   stdout=subprocess.DEVNULL)
    built = build(work, jobs)
    if built.returncode != 0:
        sys.exit("the tree as it is does not build:\n" + built.stdout[-2000:])


def try_all(options):
    work = pathlib.Path(options.work).resolve()
    copy_of_tree(work, options.jobs)
    before_s = cpu_of_children_s()
    what, by = run_cases(work, [], options.jobs, 3600.0)
    cpu_s = max(60.0, 10.0 * (cpu_of_children_s() - before_s))
    if what != "held":
        sys.exit(f"the tree as it is: {what}: {', '.join(by)}")
    own = cases_by_floor(work)
    only = {int(each) for each in options.only.split(",")} if options.only else None
    killed = tried = 0
    for number, mutant in enumerate(read_list(options.list), 1):
        if (only and number not in only) or not counts(mutant):
            continue
        verdict, by = attempt(mutant, work, own[mutant["file"].split("/")[0]], options.jobs, cpu_s)
        tried += 1
        killed += verdict == "killed"
        why = f"   [{by[0]}: {len(by) - 1}, {by[1] if len(by) > 1 else ''}]" if by else ""
        print(f"{number:2} {verdict:16} {mutant['kind']:10} {mutant['file']}:{mutant['line']}: {mutant['after']}{why}", flush=True)
    print(f"{killed} of {tried} killed")
    return 0 if killed >= options.least else 1


def check(path):
    rows = read_list(path)
    lost = [mutant for mutant in rows if not (ROOT / mutant["file"]).exists() or place_of(mutant, ROOT) is None]
    for mutant in lost:
        print(f"{mutant['file']}:{mutant['line']}: {mutant['before']!r} is no more: draw again")
    counted = [mutant for mutant in rows if counts(mutant)]
    if len(counted) < 30 or len({mutant["file"] for mutant in counted}) < LEAST_FILES:
        print(f"{path}: {len(counted)} faults in {len({mutant['file'] for mutant in counted})} files, of 30 in {LEAST_FILES}")
        return 1
    return 1 if lost else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", type=pathlib.Path, default=LIST)
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
        rows, lines = draw(options.seed, options.count, read_list(options.list))
        options.list.write_text(list_text(options.seed, options.count, rows, lines), encoding="utf-8")
        return 0
    return check(options.list) if options.verb == "check" else try_all(options)


if __name__ == "__main__":
    sys.exit(main())
