#!/usr/bin/python3
"""What README.md and docs/ state about missions between markers, measured again and written there.

    study/published.py                          writes them all
    study/published.py --only closed-table,gate writes these
    study/published.py --check                  compares instead of writing, text for text; exit status 1 names what differs
    study/published.py --check --tenth 7        the same for a tenth of them, drawn with this seed ("today": the day's number)
    study/published.py --markers                only that each marker has its entry in published.toml, and each entry its marker

What depends on the machine (timing = true) is written and never compared. --seeds N takes N seeds where an entry has more: for a
quick look, not to be committed.
"""
import argparse
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time
import tomllib

MARKER = re.compile(r"<!-- (/?)canyon:([a-z0-9-]+) -->")
FIELD = re.compile(r"\{([A-Za-z0-9_.]+)(?::([^{}]*))?\}")


class Mistake(Exception):
    """One line for the user; exit status 2."""


class Page:
    """A file with markers; spans: name -> (begin, end) of what stands between."""

    def __init__(self, path, shown):
        self.path, self.shown = path, shown
        self.read()

    def read(self):
        self.text = self.path.read_text(encoding="utf-8")
        self.spans = {}
        shown = self.shown
        opened = None
        for match in MARKER.finditer(self.text):
            line = self.text.count("\n", 0, match.start()) + 1
            closing, name = match[1] == "/", match[2]
            if closing != (opened is not None) or (closing and name != opened[0]):
                raise Mistake(f"{shown}:{line}: {match[0]} without its other half")
            if closing:
                self.spans[name] = (opened[1], match.start())
                opened = None
            elif name in self.spans:
                raise Mistake(f"{shown}:{line}: {match[0]} stands there twice")
            else:
                opened = (name, match.end(), line)
        if opened:
            raise Mistake(f"{shown}:{opened[2]}: <!-- canyon:{opened[0]} --> without its other half")

    def between(self, name):
        begin, end = self.spans[name]
        return self.text[begin:end]

    def replace(self, name, text):
        """Writes it, and finds all markers again."""
        begin, end = self.spans[name]
        self.path.write_text(self.text[:begin] + text + self.text[end:], encoding="utf-8")
        self.read()


def thousandths(model):
    """cpu_ms and error_milli of a rung that has cpu_s and error."""
    of = {"cpu_ms": model.get("cpu_s"), "error_milli": model.get("error")}
    return {key: None if value is None else 1e3 * value for key, value in of.items()}


class Made:
    """What a command gave: the lines that it printed, and its summary.json with short names for what is in its lists."""

    def __init__(self, stdout, summary):
        self.stdout = stdout
        self.values = dict(summary)
        first = summary["mission"]["seed"] if summary.get("runs") else None
        for run in summary.get("runs", []):
            if run["seed"] == first:
                parts = run.get("timing", {}).get("parts", [])
                self.values[run["fidelity"]] = {**run, "part": {part["name"]: part["cpu_s"] for part in parts}}
        loop = summary.get("loop") or {}
        self.values["against"] = {pair["b"]: pair for pair in loop.get("paired_epochs", [])}
        self.values["share"] = {share["fidelity"]: share for share in summary.get("shares") or []}
        self.values["paired"] = {}
        for pair in summary.get("paired") or []:
            self.values["paired"].setdefault(pair["b"], {})[pair["figure"]] = pair
        self.values["whole"] = {run["fidelity"]: run for run in summary.get("fidelities") or []}
        self.values["ladder"] = {}
        for ladder in summary.get("ladders") or []:
            of_key = self.values["ladder"].setdefault(ladder["key"].replace(".", "_"), {})
            of_key[ladder["probe"]] = {re.sub(r"\W", "_", model["name"]): {**model, **thousandths(model)} for model in ladder["models"]}
        self.values["median"] = {run["fidelity"]: {key: row["median"] for key, row in run["figures"].items()}
                                 for run in summary.get("over_seeds") or []}

    def look_up(self, path, entry):
        value = self.values
        for part in path.split("."):
            if isinstance(value, list) and part.isdecimal() and int(part) < len(value):
                part = int(part)
            elif not isinstance(value, dict) or part not in value:
                raise Mistake(f"published.toml: text.{entry}: {{{path}}}: the results have no \"{part}\"")
            value = value[part]
        return value

    def text(self, name, row):
        if row.get("stdout"):
            return "\n" + self.stdout
        if "paragraphs" in row:
            paragraphs = self.stdout.rstrip("\n").split("\n\n")
            found = []
            for words in row["paragraphs"]:
                fitting = [p for p in paragraphs if any(words in line for line in p.lstrip("\n").split("\n")[:2])]
                if len(fitting) != 1:
                    raise Mistake(f"published.toml: text.{name}: {len(fitting)} paragraphs of what was printed begin with \"{words}\"")
                found.append(fitting[0].strip("\n"))
            return "\n```\n" + "\n\n".join(found) + "\n```\n"

        def formatted(match):
            value = self.look_up(match[1], name)
            if value is None:
                return "undefined"
            try:
                return format(value, match[2] or "")
            except (TypeError, ValueError) as error:
                raise Mistake(f"published.toml: text.{name}: {match[0]}: {error}") from error

        return FIELD.sub(formatted, row["text"])


def load(root):
    """The entries and the pages; every marker has an entry, and every entry is wanted somewhere."""
    file = root / "study" / "published.toml"
    with open(file, "rb") as stream:
        try:
            entries = tomllib.load(stream)
        except tomllib.TOMLDecodeError as error:
            raise Mistake(f"published.toml: {error}") from error
    commands, texts = entries.get("command", {}), entries.get("text", {})
    for name, row in texts.items():
        if row.get("command") not in commands:
            raise Mistake(f"published.toml: text.{name}: command \"{row.get('command')}\" is not in the file")
        if sum(key in row for key in ("stdout", "paragraphs", "text")) != 1:
            raise Mistake(f"published.toml: text.{name}: expected one of stdout, paragraphs, text")
    pages = [Page(path, path.relative_to(root).as_posix()) for path in [root / "README.md", *sorted((root / "docs").glob("*.md"))]]
    for page in pages:
        for name in page.spans:
            if name not in texts:
                raise Mistake(f"{page.shown}: marker canyon:{name} has no entry text.{name} in study/published.toml")
    for name in texts:
        if not any(name in page.spans for page in pages):
            raise Mistake(f"published.toml: text.{name}: no page has its marker")
    return commands, texts, pages


def run(root, canyon, name, row, seeds):
    """Calls canyon in a folder of its own."""
    arguments = list(row.get("arguments", []))
    if seeds and "--seeds" in arguments:
        at = arguments.index("--seeds") + 1
        first, _, last = arguments[at].rpartition("-")
        arguments[at] = f"{first}-{min(int(first) + seeds - 1, int(last))}" if first else str(min(seeds, int(last)))
    with tempfile.TemporaryDirectory() as folder:
        if "mission" in row:
            (pathlib.Path(folder) / "mission.toml").write_text(row["mission"], encoding="utf-8")
            arguments.insert(1, "mission.toml")
        has_results = arguments[:1] and arguments[0] in ("compare", "run", "tradeoff")
        if has_results:
            arguments += ["--out", "results"]
        start = time.monotonic()
        program = [sys.executable, str(root / row["script"]), "--canyon", canyon] if "script" in row else [canyon]
        try:
            done = subprocess.run([*program, *arguments], cwd=folder, stdout=subprocess.PIPE, text=True, check=False)
        except OSError as error:
            raise Mistake(f"--canyon: {canyon}: {error.strerror}") from error
        if done.returncode != 0:
            raise Mistake(f"command.{name}: {row.get('script', 'canyon')} {' '.join(arguments)} ended with status {done.returncode}")
        summary = {}
        if has_results:
            summary = json.loads((pathlib.Path(folder) / "results" / "summary.json").read_text(encoding="utf-8"))
        elif "--json" in arguments:
            summary = json.loads(done.stdout)
        print(f"{name}: {time.monotonic() - start:.0f} s", file=sys.stderr, flush=True)
        return Made(done.stdout, summary)


def chosen_texts(texts, options):
    names = sorted(texts)
    if options.only:
        names = options.only.split(",")
        for name in names:
            if name not in texts:
                raise Mistake(f"--only: \"{name}\" is not in published.toml, expected one of {', '.join(sorted(texts))}")
    if options.check:
        names = [name for name in names if not texts[name].get("timing")]
        if not names:
            raise Mistake("--check: nothing to compare: the texts chosen depend on the machine")
    if options.tenth:
        seed = int(time.time() // 86400) if options.tenth == "today" else int(options.tenth)
        names = sorted(random.Random(seed).sample(names, max(1, round(len(names) / 10))))
        print(f"--tenth {seed}: {', '.join(names)}", file=sys.stderr, flush=True)
    return names


def work(options):
    root = pathlib.Path(options.root)
    commands, texts, pages = load(root)
    if options.markers:
        return 0
    differ, made = 0, {}
    for name in chosen_texts(texts, options):
        command = texts[name]["command"]
        if command not in made:
            made[command] = run(root, options.canyon, command, commands[command], options.seeds)
        text = made[command].text(name, texts[name])
        for page in pages:
            if name not in page.spans:
                continue
            if not options.check:
                page.replace(name, text)
            elif page.between(name) != text:
                differ += 1
                print(f"{page.shown}: canyon:{name} says\n{page.between(name)}\nand is now\n{text}")
    return 1 if differ else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--canyon", default=str(here / "build/release/bin/canyon"))
    parser.add_argument("--root", default=str(here), help="of the tree whose pages are meant")
    parser.add_argument("--only", metavar="NAME,NAME")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--tenth", metavar="SEED")
    parser.add_argument("--markers", action="store_true")
    parser.add_argument("--seeds", type=int, metavar="N")
    options = parser.parse_args()
    options.canyon = str(pathlib.Path(options.canyon).resolve())
    try:
        if options.tenth and options.tenth != "today" and not options.tenth.isdecimal():
            raise Mistake(f"--tenth: \"{options.tenth}\", expected a whole number or today")
        return work(options)
    except Mistake as mistake:
        print(mistake, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
