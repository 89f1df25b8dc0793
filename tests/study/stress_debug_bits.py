#!/usr/bin/python3
"""The figures of `canyon stress` are the same bits in a debug build: no optimisation of the compiler's has any part in them.

    stress_debug_bits.py RELEASE --build FOLDER [--jobs N]    builds the program there without optimisation, and compares
    stress_debug_bits.py RELEASE --debug PROGRAM              compares with a program that is there

Prints each short case whose figure, bound or verdict differs, with both, and ends with status 1 if there is one.
"""
import argparse
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMPARED = ("figure", "bound", "pass", "thrown")


def built(folder, jobs):
    """The program without optimisation, and without what a debugger wants: that is half of the time of building it."""
    said = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, "check": False}
    for step in (["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O0", "-DCANYON_TESTS=OFF"],
                 ["ninja", "-C", folder, f"-j{jobs}", "canyon"]):
        ran = subprocess.run(step, **said)
        if ran.returncode != 0:
            sys.exit("the program does not build without optimisation:\n" + ran.stdout[-3000:])
    return pathlib.Path(folder) / "bin/canyon"


def cases_of(program):
    ran = subprocess.run([program, "stress", "--json"], stdout=subprocess.PIPE, text=True, check=False)
    try:
        return {case["name"]: case for case in json.loads(ran.stdout)["cases"]}
    except (ValueError, KeyError):
        sys.exit(f"{program}: exit status {ran.returncode}, no cases")


def differences(release, debug):
    """A line for each case that one of the two has not, or has otherwise."""
    for name in sorted(release.keys() | debug.keys()):
        if name not in release or name not in debug:
            yield f"{name}: in one of the two alone"
            continue
        one, other = release[name], debug[name]
        different = [key for key in COMPARED if one.get(key) != other.get(key)]
        if different:
            yield f"{name}: " + ", ".join(f"{key} {one.get(key)!r}, without optimisation {other.get(key)!r}" for key in different)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("release")
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--debug")
    which.add_argument("--build")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    release, debug = cases_of(options.release), cases_of(options.debug or built(options.build, options.jobs))
    lines = list(differences(release, debug))
    print("\n".join(lines + [f"{len(release)} cases, {len(lines)} differ"]))
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
