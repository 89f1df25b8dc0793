#!/usr/bin/env python3
"""check_licences.py [BINARY]: every package of cmake/debian-packages.txt has its line in docs/licences.md, and so has, of a
BINARY, every package that one of its shared libraries comes from. One line for each that is missing.
"""

import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def packages_listed(text):
    """The names of a package list: one a line, [sections] and comments left out."""
    lines = (line.split("#")[0].strip() for line in text.splitlines())
    return [line for line in lines if line and not line.startswith("[")]


def packages_with_a_line(text):
    """The names in the first column of the tables, of rows that say a licence."""
    names = set()
    for line in text.splitlines():
        cells = [cell.strip().strip("*") for cell in line.strip().strip("|").split("|")]
        if line.startswith("|") and len(cells) >= 3 and cells[2].strip("- "):
            names.update(name.strip().strip("*") for name in cells[0].split(","))
    return names


def packages_of(binary):
    """Where the shared libraries of a binary, and of the parts that it opens late, come from, or nothing where there is no dpkg to ask."""
    if not shutil.which("dpkg-query") or not shutil.which("ldd"):
        return []
    parts = sorted(pathlib.Path(binary).resolve().parent.parent.glob("lib/canyon/*.so"))
    output = subprocess.run(["ldd", binary, *parts], capture_output=True, text=True, check=True).stdout
    # A library is known to dpkg by the path that its package was made with: with /usr in front of it, or without.
    paths = {str(pathlib.Path(path).resolve()) for path in re.findall(r"=> (/\S+)", output)}
    paths |= {path.removeprefix("/usr") for path in paths}
    owners = subprocess.run(["dpkg-query", "-S", *sorted(paths)], capture_output=True, text=True).stdout  # of those it knows
    found = {line.split(":")[0] for line in owners.splitlines()}
    return sorted(found)


def missing(root, binary=None):
    told = packages_with_a_line((root / "docs/licences.md").read_text(encoding="utf-8"))
    needed = packages_listed((root / "cmake/debian-packages.txt").read_text(encoding="utf-8"))
    if binary:
        needed += packages_of(binary)
    return [f"docs/licences.md: no line for {name}" for name in needed if name not in told]


if __name__ == "__main__":
    lines = missing(ROOT, sys.argv[1] if len(sys.argv) > 1 else None)
    for line in lines:
        print(line)
    sys.exit(1 if lines else 0)
