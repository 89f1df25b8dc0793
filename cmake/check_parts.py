#!/usr/bin/env python3
"""check_parts.py BUILD: builds the program without each of its optional parts, and without all of them, and runs it.

BUILD is a complete build of this tree. Of a build with CANYON_WITH_X=OFF only what its own compile commands say otherwise is
compiled; every other object would come out as in BUILD (same command, same source) and is taken from there. Then it is linked,
and the program must name the option where the part that is missing is asked for. Exit status 1 says what does not hold.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
KEPT = ("CMAKE_BUILD_TYPE", "CMAKE_CXX_COMPILER", "CMAKE_CXX_FLAGS", "CANYON_OPEN_LATE", "CANYON_PRECOMPILED_HEADERS", "CANYON_SANITIZE",
        "CANYON_WERROR")

SQUARE = json.dumps({"type": "FeatureCollection", "features": [{
    "type": "Feature", "properties": {"height": 9},
    "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [1e-4, 0], [1e-4, 1e-4], [0, 1e-4], [0, 0]]]}}]})
TRIANGLE = "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n"

# Option, the part's library, files, a call that needs the part, and what must be said.
PARTS = [
    ("CANYON_WITH_PCL", "pcl", {"m.toml": 'base = "vicksburg"\n[time]\nlimit_s = 1.0\n[registration]\nmethod = "pcl_gicp"\n'}, "run m.toml --fidelity high --out out",
     '"pcl_gicp" was not compiled in, expected a build with CANYON_WITH_PCL=ON'),
    ("CANYON_WITH_CERES", "ceres", {}, "imu fit log/imu.csv --static --out unit.toml", "CANYON_WITH_CERES=ON"),
    ("CANYON_WITH_ASSIMP", "assimp", {"s.glb": "glTF"}, "scene info s.glb",
     "this canyon was built without glTF, expected a build with CANYON_WITH_ASSIMP=ON"),
    ("CANYON_WITH_PROJ", "proj", {"s.geojson": SQUARE}, "scene info s.geojson",
     "this canyon was built without map projections, expected a build with CANYON_WITH_PROJ=ON"),
]
# Calls that need none of them, the first before those above: their logs come from it.
LOG = "imu simulate --at 45,7,200 --duration 1200 --rate 50 --out log"
STILL = [({"t.obj": TRIANGLE}, "scene info t.obj"),
         ({"n.toml": 'base = "vicksburg"\n[time]\nlimit_s = 1.0\n'}, "run n.toml --fidelity high --out still")]


class Failure(Exception):
    """What does not hold, in one line or with the output of the command that failed."""


def call(command, folder):
    done = subprocess.run(command, cwd=folder, shell=isinstance(command, str), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False)
    if done.returncode != 0:
        raise Failure(f"{command if isinstance(command, str) else ' '.join(command)}\n{done.stdout[-3000:]}")
    return done.stdout


def cached(build):
    """What BUILD was configured with, of the keys that a build without a part shares."""
    values = {}
    for line in (build / "CMakeCache.txt").read_text(encoding="utf-8").splitlines():
        found = re.match(r"(\w+):\w+=(.*)", line)
        if found and found[1] in KEPT:
            values[found[1]] = found[2]
    return values


def compile_commands(build):
    """By object file, relative to the build: the command with the build's own folder written as @."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    commands = (entry["command"].replace(str(build), "@") for entry in entries)
    return {re.search(r" -o (\S+)", command)[1]: command for command in commands}


def same_joined_files(full, out, output):
    """Whether files that are compiled as one are the same in both builds."""
    if "/Unity/" not in output:
        return True
    joined = output.removesuffix(".o")
    return (full / joined).read_text(encoding="utf-8") == (out / joined).read_text(encoding="utf-8")


def build_without(full, out, options):
    """Configures, compiles what differs, links. Returns how many objects were compiled and taken."""
    settings = [f"-D{key}={value}" for key, value in cached(full).items()]
    call(["cmake", "-S", str(ROOT), "-B", str(out), "-G", "Ninja", "-DCANYON_TESTS=OFF", *settings,
          *(f"-D{option}=OFF" for option in options)], ROOT)
    there, here = compile_commands(full), compile_commands(out)
    compiled = taken = 0
    for line in call(["ninja", "-t", "commands", "canyon"], out).splitlines():
        target = re.search(r" -o (\S+)", line)
        if target:
            (out / target[1]).parent.mkdir(parents=True, exist_ok=True)
        if target and target[1] in here:
            same = there.get(target[1]) == here[target[1]] and same_joined_files(full, out, target[1])
            if same and (full / target[1]).exists():
                shutil.copyfile(full / target[1], out / target[1])
                taken += 1
                continue
            compiled += 1
        call(line, out)
    for text in (out / "generated").rglob("*.h"):
        twin = full / text.relative_to(out)
        if not twin.exists() or twin.read_bytes() != text.read_bytes():
            raise Failure(f"{text.relative_to(out)} depends on {' '.join(options)}, and objects that may include it were taken")
    return compiled, taken


def say(canyon, folder, arguments):
    done = subprocess.run([canyon, *arguments.split()], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    return done.returncode, done.stderr


def check_program(out, dropped, folder):
    canyon = str(out / "bin/canyon")
    status, said = say(canyon, folder, LOG)
    if status != 0:
        raise Failure(f"{' '.join(dropped)}=OFF: canyon {LOG}: status {status}, said {said!r}")
    for option, library, files, arguments, wanted in PARTS:
        if option not in dropped:
            continue
        if (out / f"lib/canyon/libcanyon_{library}.so").exists():
            raise Failure(f"{option}=OFF still makes the part {library}")
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        status, said = say(canyon, folder, arguments)
        if status != 2 or wanted not in said or said.count("\n") != 1:
            raise Failure(f"{option}=OFF: canyon {arguments}: status {status}, said {said!r}, expected 2 and one line with {wanted!r}")
    for number, (files, arguments) in enumerate(STILL):
        for name, text in files.items():
            (folder / name).write_text(text, encoding="utf-8")
        status, said = say(canyon, folder, f"{arguments}{number if arguments.endswith('still') else ''}")
        if status != 0:
            raise Failure(f"{' '.join(dropped)} OFF: canyon {arguments}: status {status}, said {said!r}")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    full = pathlib.Path(sys.argv[1]).resolve()
    every = [part[0] for part in PARTS]
    try:
        for dropped in [[option] for option in every] + [every]:
            with tempfile.TemporaryDirectory(dir=full, prefix="without_") as folder:
                out, work = pathlib.Path(folder) / "build", pathlib.Path(folder) / "work"
                work.mkdir()
                compiled, taken = build_without(full, out, dropped)
                (work / "log.csv").write_text(resting_log(), encoding="utf-8")
                check_program(out, dropped, work)
            print(f"without {' '.join(dropped)}: {compiled} objects compiled, {taken} taken", flush=True)
    except Failure as failure:
        print(failure, file=sys.stderr)
        return 1
    return 0


def resting_log():
    """Of a unit at rest, 100 s at 100 Hz, with a little noise (a linear congruential generator's)."""
    rows, state = ["t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2"], 1
    for k in range(10000):
        noise = []
        for _ in range(6):
            state = (1103515245 * state + 12345) % 2**31
            noise.append(state / 2**31 - 0.5)
        rows.append(f"{0.01 * k:.2f}," + ",".join(f"{1e-4 * n:.9f}" for n in noise[:5]) + f",{9.8 + 1e-3 * noise[5]:.6f}")
    return "\n".join(rows) + "\n"


if __name__ == "__main__":
    sys.exit(main())
