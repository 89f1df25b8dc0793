#!/usr/bin/python3
"""Six receivers of gnss/receivers on the way of the built-in mission, open loop: the table of docs/gnss.md.

    study/six_receivers.py                   writes the table to the terminal
    study/six_receivers.py --keep DIR        keeps finished runs there, and goes on where an earlier call ended
    study/six_receivers.py --seeds N         fewer runs: for a quick look, not to be committed
    study/six_receivers.py --beside POSITIONS TRUTH
                                             what `canyon gnss solve --truth TRUTH --out POSITIONS` made of another drive: the constants there

The way is that of `low` (seed 1). Each of the runs of a receiver has a seed of its own and begins half an hour after the one before, so that
twenty see satellites as they stand over ten hours. Receivers of 2010 have the orbits of fidelity high, the others those of modern.

The second table asks what the covariance that a receiver states of each fix is worth: its log score (mean logarithm of the density of the
horizontal error) beside those of one constant covariance, the mean of e e', of the receiver's own errors and of the best suited of the others.
"""
import argparse
import bisect
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
    """One run: its summary, the (east, north) errors of its fixes, and how far they are off in height."""
    made = observe(options, folder, receiver, k)
    errors = errors_of(folder / f"{receiver}_{k}/fixes.csv", "enu")
    return json.loads(made.read_text(encoding="utf-8")), [(e, n) for e, n, _ in errors], [abs(u) for _, _, u in errors]


def errors_of(path, axes):
    with open(path, encoding="utf-8") as stream:
        return [tuple(float(row[f"error_{a}_m"]) for a in axes) for row in csv.DictReader(stream) if row["error_e_m"]]


def errors_beside(positions, truth):
    """(east, north) errors of positions in E, of one week, where the truth has its times within a second."""
    with open(truth, encoding="utf-8") as stream:
        way = [(float(row["sow"]), [float(row[f"{a}_m"]) for a in "xyz"]) for row in csv.DictReader(stream)]
    times = [t for t, _ in way]
    errors = []
    with open(positions, encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            if not row["x_m"]:
                continue
            t = float(row["sow"])
            after = bisect.bisect_left(times, t)
            if after == len(way) or (after == 0 and times[0] > t) or times[after] - times[max(after - 1, 0)] > 1.0:
                continue
            (t0, p0), (t1, p1) = way[max(after - 1, 0)], way[after]
            share = (t - t0) / (t1 - t0) if t1 > t0 else 0.0
            true = [a + share * (b - a) for a, b in zip(p0, p1)]
            x, y, z = (float(row[f"{a}_m"]) - b for a, b in zip("xyz", true))
            # The latitude of a place on the ellipsoid, which a height of some hundred metres does not change.
            lon, lat = math.atan2(true[1], true[0]), math.atan2(true[2], math.hypot(true[0], true[1]) * (1.0 - 1.0 / 298.257223563) ** 2)
            along = math.cos(lon) * x + math.sin(lon) * y
            errors.append((math.cos(lon) * y - math.sin(lon) * x, math.cos(lat) * z - math.sin(lat) * along))
    return errors


def constant_of(errors):
    """The mean of e e': entries ee, en, nn."""
    return tuple(sum(a * b for a, b in pairs) / len(errors) for pairs in
                 (((e, e) for e, _ in errors), ((e, n) for e, n in errors), ((n, n) for _, n in errors)))


def log_score(constant, errors):
    """Mean logarithm of the density of errors under a normal law of that covariance."""
    ee, en, nn = constant
    det = ee * nn - en * en
    squares = sum(nn * e * e - 2 * en * e * n + ee * n * n for e, n in errors) / (det * len(errors))
    return -math.log(2 * math.pi) - 0.5 * math.log(det) - 0.5 * squares


def best_of(constants, errors):
    """The best suited of these, and its score."""
    return max(((name, log_score(constant, errors)) for name, constant in constants.items()), key=lambda one: one[1])


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else math.nan


def row_of(receiver, runs):
    fixes = sum(run["fixes"] for run, _, _ in runs)

    def mean(key):
        return sum(run[key] * run["fixes"] for run, _, _ in runs if run["fixes"]) / fixes

    off_m = [math.hypot(*en) for run in runs for en in run[1]]
    up_m = sum((run[2] for run in runs), [])
    medians = [percentile([math.hypot(*en) for en in run[1]], 0.5) for run in runs if run[1]]
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
        made = {receiver: [one.result() for one in runs[receiver]] for receiver in runs}
    for receiver in made:
        print(row_of(receiver, made[receiver]))
    errors = {receiver: sum((run[1] for run in made[receiver]), []) for receiver in made}
    constants = {receiver: constant_of(errors[receiver]) for receiver in made}
    print("\n| receiver | what it states | one constant, of its own errors | of the best suited of the others |\n|---|---|---|---|")
    for receiver in made:
        stated = sum(run["horizontal_log_score"] * run["fixes"] for run, _, _ in made[receiver] if run["fixes"]) / len(errors[receiver])
        name, score = best_of({other: constants[other] for other in constants if other != receiver}, errors[receiver])
        print(f"| `{receiver}` | {stated:.2f} | {log_score(constants[receiver], errors[receiver]):.2f} | {score:.2f} (`{name}`) |")
    for positions, truth in options.beside:
        there = errors_beside(positions, truth)
        name, score = best_of(constants, there)
        print(f"\n{positions}: {len(there)} fixes, one constant of its own {log_score(constant_of(there), there):.2f}, "
              f"the best suited of these {score:.2f} (`{name}`)")


def run(description, work, beside=False):
    """The options of such a study, --beside if it has that, and work(options, folder)."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--canyon", default=str(here / "build/release/bin/canyon"))
    parser.add_argument("--keep", metavar="DIR")
    parser.add_argument("--seeds", type=int, default=20, metavar="N")
    parser.add_argument("--jobs", type=int, default=2, metavar="N")
    if beside:
        parser.add_argument("--beside", action="append", default=[], nargs=2, metavar=("POSITIONS", "TRUTH"))
    options = parser.parse_args()
    options.canyon = str(pathlib.Path(options.canyon).resolve())
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(options.keep or temporary).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        work(options, folder)
    return 0


if __name__ == "__main__":
    sys.exit(run(__doc__, table, beside=True))
