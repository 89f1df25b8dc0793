#!/usr/bin/env python3
"""check_clang.py BUILD_DIRECTORY: what clang says of the libraries and the program, without making objects of them.

BUILD_DIRECTORY is one that CMake has configured for clang (preset `clang`), its precompiled headers built; its
compile_commands.json names the files and their flags, warnings as errors among them. Prints what is wrong and returns 1.
Tests, and files whose contents the build makes, are left out."""

import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys


def files_to_check(build):
    """(file, directory, command) of what the build compiles, each file once."""
    out = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        file = pathlib.Path(entry["directory"], entry["file"]).resolve()
        command = shlex.split(entry["command"])
        target = command[command.index("-o") + 1]
        if build.resolve() in file.parents or not file.exists():
            continue
        if not target.startswith(("tests/", "bench/")):
            out.setdefault(file, (entry["directory"], command))
    return sorted((file, *rest) for file, rest in out.items())


def complaints(file, directory, command):
    """What clang says of one file: the first messages, or nothing."""
    command = list(command)
    at = command.index("-o")
    del command[at:at + 2]
    done = subprocess.run([*command, "-fsyntax-only"], cwd=directory, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return None
    return "\n".join((done.stderr or f"{file}: clang ended with status {done.returncode}").splitlines()[:40])


def main(arguments):
    build = pathlib.Path(arguments[0])
    files = files_to_check(build)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = [text for text in pool.map(lambda each: complaints(*each), files) if text]
    for text in wrong:
        print(text)
    print(f"clang: {len(files)} files, {len(wrong)} with errors" if wrong else f"clang: {len(files)} files, no warning")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
