#!/usr/bin/python3
"""Six receivers of gnss/receivers on the way of the built-in mission, open loop: the table of docs/gnss.md.

    study/six_receivers.py                   writes the table to the terminal
    study/six_receivers.py --keep DIR        keeps finished runs there, and goes on where an earlier call ended
    study/six_receivers.py --seeds N         fewer runs: for a quick look, not to be committed

The way is that of `low` (seed 1). Each of the runs of a receiver has a seed of its own and begins half an hour after the one before, so that
twenty see satellites as they stand over ten hours. Receivers of 2010 have the orbits of fidelity high, the others those of modern.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

RECEIVERS = {"snapshot_gps": "high", "dgps_2010": "high", "survey_multi": "modern", "m8": "modern", "f9p": "modern", "phone": "modern"}
STEP_S = 1800.0
MISSION = 'base = "vicksburg"\n[registration]\nmethod = "none"\n'


def canyon(options, *arguments, **how):
    return subprocess.run([options.canyon, *arguments], check=True, stdout=subprocess.PIPE, text=True, **how).stdout


def quaternion(yaw_deg, pitch_deg, roll_deg):
    """x, y, z, w of the rotation from B to W: yaw, then pitch, then roll."""
    (cy, sy), (cp, sp), (cr, sr) = ((math.cos(0.5 * math.radians(a)), math.sin(0.5 * math.radians(a))) for a in (yaw_deg, pitch_deg, roll_deg))
    return (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy)


def true_way(options, folder):
    """Poses of `low`: seconds of GPS time, position, attitude."""
    path = folder / "low.csv"
    if not path.exists():
        (folder / "low.toml").write_text(MISSION, encoding="utf-8")
        canyon(options, "run", "low.toml", "--seed", "1", "--fidelity", "low", "--out", "low", cwd=folder)
        path.write_text((folder / "low/epochs/low_nav.csv").read_text(encoding="utf-8"), encoding="utf-8")
    with open(path, encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            t = int(row["gps_week"]) * 604800 + float(row["sow"])
            q = quaternion(*(float(row[f"true_{a}_deg"]) for a in ("yaw", "pitch", "roll")))
            yield t, [row[f"true_{a}_m"] for a in "xyz"], q


def observe(options, folder, receiver, k):
    """One run, unless it is there: RECEIVER_K.json, .obs and .nav, and fixes and satellites in RECEIVER_K."""
    made = folder / f"{receiver}_{k}.json"
    if made.exists():
        return made
    here = str(folder / f"{receiver}_{k}")
    text = canyon(options, "gnss", "simulate", "--fidelity", RECEIVERS[receiver], "--receiver", receiver, "--scene", "vicksburg",
                  "--trajectory", str(folder / f"way_{k}.tum"), "--rate", "1", "--seed", str(k), "--threads", "1", "--json", "--force",
                  "--out", here, "--rinex-obs", here + ".obs", "--rinex-nav", here + ".nav")
    made.write_text(text, encoding="utf-8")
    return made


def simulate(options, folder, receiver, k):
    """One run: its summary, and how far its fixes are off, in the plane and in height."""
    made = observe(options, folder, receiver, k)
    off_m, up_m = [], []
    with open(folder / f"{receiver}_{k}/fixes.csv", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            if row["error_e_m"]:
                off_m.append(math.hypot(float(row["error_e_m"]), float(row["error_n_m"])))
                up_m.append(abs(float(row["error_u_m"])))
    return json.loads(made.read_text(encoding="utf-8")), off_m, up_m


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else math.nan


def row_of(receiver, runs):
    fixes = sum(run["fixes"] for run, _, _ in runs)

    def mean(key):
        return sum(run[key] * run["fixes"] for run, _, _ in runs if run["fixes"]) / fixes

    off_m, up_m = (sum((run[i] for run in runs), []) for i in (1, 2))
    medians = [percentile(run[1], 0.5) for run in runs if run[1]]
    tracked = sum(run["satellites_mean"] for run, _, _ in runs) / len(runs)
    hidden = sum(run["satellites_mean"] * run["nlos_share"] for run, _, _ in runs) / len(runs)
    inside = " / ".join(f"{100 * mean(f'ellipse_{p}_share'):.1f}" for p in (50, 95, 997))
    return (f"| `{receiver}` | {tracked - hidden:.1f} / {hidden:.1f} | {100 * fixes / sum(run['epochs'] for run, _, _ in runs):.1f} "
            f"| {percentile(off_m, 0.5):.2f} ({percentile(medians, 0.05):.1f} to {percentile(medians, 0.95):.1f}) | {percentile(off_m, 0.95):.1f} "
            f"| {percentile(up_m, 0.5):.1f} / {percentile(up_m, 0.95):.1f} | {100 * mean('beyond_3_sigma'):.1f} | {inside} "
            f"| {mean('horizontal_log_score'):.2f} |")


def write_ways(options, folder):
    way = list(true_way(options, folder))
    for k in range(1, options.seeds + 1):
        lines = (f"{t + STEP_S * (k - 1):.3f} {' '.join(p)} {' '.join(f'{x:.9f}' for x in q)}" for t, p, q in way)
        (folder / f"way_{k}.tum").write_text("\n".join(lines) + "\n", encoding="utf-8")


def table(options, folder):
    write_ways(options, folder)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs = {receiver: [pool.submit(simulate, options, folder, receiver, k) for k in range(1, options.seeds + 1)] for receiver in RECEIVERS}
        print("| receiver | tracked, in sight / hidden | fixes, % | H50 (5 to 95 % of the runs' own), m | H95, m | height 50 / 95 %, m "
              "| beyond 3 σ, % | inside 50 / 95 / 99.7 %, % | log score |")
        print("|---|---|---|---|---|---|---|---|---|")
        for receiver, made in runs.items():
            print(row_of(receiver, [one.result() for one in made]), flush=True)


def run(description, work):
    """The options of such a study, and work(options, folder)."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--canyon", default=str(here / "build/release/bin/canyon"))
    parser.add_argument("--keep", metavar="DIR")
    parser.add_argument("--seeds", type=int, default=20, metavar="N")
    parser.add_argument("--jobs", type=int, default=2, metavar="N")
    options = parser.parse_args()
    options.canyon = str(pathlib.Path(options.canyon).resolve())
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(options.keep or temporary).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        work(options, folder)
    return 0


if __name__ == "__main__":
    sys.exit(run(__doc__, table))
