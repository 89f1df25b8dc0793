#!/usr/bin/python3
"""How fast range errors move under a vehicle that creeps along a street: largest steps of signals in lock from one epoch to the next.

    study/slow_vehicle.py                          reflections alone, mirrors that end sharply against such that fade out
    study/slow_vehicle.py --speeds 0.1 --row 'code_loop_memory=false' --row 'clutter="none";code_loop_memory=false'

600 epochs, ten a second, along --directions from (113, -75) of the built-in city, each of --starts times another hour and seed. Each --row is a key of [gnss] over --base;
the first is what the others are compared with: the difference drive by drive, with a 95 % interval of 10,000 bootstrap draws of drives.
"""
import argparse
import collections
import csv
import datetime
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
EPOCHS, RATE_HZ = 600, 10.0
BARE = ['clutter = "none"', 'scatter = "none"', "code_loop_memory = false"]


def write_way(path, begin_s, east, speed_m_s):
    turn = "0 0 0 1" if east else "0 0 0.70710678 0.70710678"
    with open(path, "w") as way:
        for k in range(EPOCHS):
            along_m = speed_m_s * k / RATE_HZ
            x_m, y_m = (113.0 + along_m, -75.0) if east else (113.0, -75.0 + along_m)
            way.write(f"{begin_s + k / RATE_HZ:.1f} {x_m:.6f} {y_m:.6f} 0.5 {turn}\n")


def steps_of(satellites):
    """|change| of the range error of each signal in lock at two epochs on end."""
    by_signal = collections.defaultdict(dict)
    for row in csv.DictReader(satellites):
        if row["tracked"] == "1":
            by_signal[row["satellite"]][round(RATE_HZ * float(row["sow"]))] = float(row["multipath_m"])
    return sorted(abs(error - errors[k - 1]) for errors in by_signal.values() for k, error in errors.items() if k - 1 in errors)


def drive(options, folder, keys, start, east, speed_m_s):
    begin = datetime.datetime(2012, 1, start, 5 * start % 24)
    write_way(folder / "way.tum", (begin - datetime.datetime(1980, 1, 6)).total_seconds(), east, speed_m_s)
    (folder / "mission.toml").write_text(f'base = "vicksburg"\n[fidelity.asked]\nbase = "{options.base}"\n[fidelity.asked.gnss]\n' + "\n".join(keys) + "\n")
    done = subprocess.run([options.canyon, "gnss", "simulate", "--scene", folder / "mission.toml", "--fidelity", "asked", "--trajectory", folder / "way.tum",
                           "--rate", str(RATE_HZ), "--errors", "multipath", "--start", begin.isoformat(), "--seed", str(start), "--out", folder / "out",
                           "--force", "--threads", "1"], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    with open(folder / "out/satellites.csv") as satellites:
        steps = steps_of(satellites)
    return steps[int(0.99 * len(steps))], steps[-1]


def interval(differences, draws=10000):
    draw = random.Random(17)
    means = sorted(statistics.fmean(draw.choices(differences, k=len(differences))) for _ in range(draws))
    return means[int(0.025 * draws)], means[int(0.975 * draws) - 1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--canyon", type=pathlib.Path, default=ROOT / "build/release/bin/canyon")
    parser.add_argument("--base", default="high", help="fidelity that the rows change")
    parser.add_argument("--row", action="append", help="KEY=VALUE, more of them with ; between")
    parser.add_argument("--starts", type=int, default=10)
    parser.add_argument("--speeds", type=lambda text: [float(v) for v in text.split(",")], default=[0.1, 0.025], metavar="M_S,M_S")
    parser.add_argument("--directions", type=lambda text: text.split(","), default=["east", "north"])
    options = parser.parse_args()
    rows = [row.split(";") for row in options.row] if options.row else [BARE + ["reflection_borders = false"], BARE + ["reflection_borders = true"]]
    with tempfile.TemporaryDirectory() as scratch:
        for speed_m_s in options.speeds:
            print(f"{speed_m_s} m/s: one of a hundred, most (median over drives, largest), m; most, less than in the first row (mean, 95 %)")
            first = None
            for keys in rows:
                drives = [drive(options, pathlib.Path(scratch), keys, start, direction == "east", speed_m_s)
                          for direction in options.directions for start in range(1, options.starts + 1)]
                most = [one[1] for one in drives]
                text = f"  {'; '.join(keys)}: {statistics.median(one[0] for one in drives):.2f}, {statistics.median(most):.2f}, {max(most):.2f}"
                if first:
                    less = [a - b for a, b in zip(first, most)]
                    low, high = interval(less)
                    text += f"; less by {statistics.fmean(less):.2f} [{low:.2f}, {high:.2f}]"
                first = first or most
                print(text, flush=True)


if __name__ == "__main__":
    main()
