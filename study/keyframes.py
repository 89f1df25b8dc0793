#!/usr/bin/python3
"""How far registration's own covariance can be believed in a whole mission, and what it makes of the filter's keyframes.

    study/keyframes.py                             `high` and `high_aided`, seeds 1 to 20
    study/keyframes.py --seeds 21-28 --keep DIR    keeps the keyframes of finished runs there, and goes on where an earlier call ended
    study/keyframes.py --mission my.toml --fidelities high --jobs 2

Each run is driven with `--plan --for outcome,position,map`; read is its epochs/RUN_keyframes.csv (docs/results.md). Of a keyframe's step, the motion since the one before as
the map took it, `step_nees` is the error squared over its own covariance: with 6 degrees of freedom one in a thousand should be beyond 22.46. Unflagged is a step that
converged with no direction open. Registered over prior: root mean squares of the keyframes' position errors, of each seed. Intervals: 95 % by Wilson, of steps as if they
were independent.
"""
import argparse
import concurrent.futures
import csv
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

from factorial import seeds_of, wilson

ROOT = pathlib.Path(__file__).resolve().parents[1]
BOUND = 22.457744484825323  # 99.9 % of chi-square with 6 degrees of freedom
FAR_M = 1.0
ASKED = {"high": 0.6, "high_aided": 1.0}  # registered over prior, at most


def keyframes(options, folder, fidelity, seed):
    """Rows of the run's keyframes."""
    kept = folder / f"{fidelity}-{seed}.csv"
    if not kept.exists():
        out = folder / f"run-{fidelity}-{seed}"
        mission = [options.mission] if options.mission else []
        done = subprocess.run([options.canyon, "run", *mission, "--fidelity", fidelity, "--seed", str(seed), "--plan", "--for", "outcome,position,map",
                               "--threads", "1", "--out", out, "--force"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{fidelity}, seed {seed}: {done.stderr[-1000:]}")
        # Under its name only when it is whole: a call that is interrupted leaves none that a later one would believe.
        shutil.copy(out / f"epochs/{fidelity}_keyframes.csv", f"{kept}.part")
        os.replace(f"{kept}.part", kept)
        shutil.rmtree(out)
    with open(kept) as rows:
        return list(csv.DictReader(rows))


def rms(values):
    return math.sqrt(statistics.fmean(v * v for v in values))


def ratio(rows):
    """Registered over prior, of the keyframes that have both."""
    both = [(float(row["registered_error_m"]), float(row["prior_error_m"])) for row in rows if row["registered_error_m"]]
    return rms([one[0] for one in both]) / rms([one[1] for one in both])


def report(fidelity, seeds):
    """A row of the table, and what the worst steps are. `seeds`: rows of keyframes by seed."""
    steps = [(seed, row) for seed, rows in seeds.items() for row in rows if row["step_nees"]]
    converged = [(seed, row) for seed, row in steps if row["status"] == "converged"]
    if not converged:
        sys.exit(f"{fidelity}: no step converged")
    beyond = sum(float(row["step_nees"]) > BOUND for _, row in converged)
    unflagged = [(seed, row) for seed, row in converged if row["open_directions"] == "0"]
    far = [row for _, row in converged if float(row["step_error_m"]) > FAR_M]
    far_unflagged = sum(float(row["step_error_m"]) > FAR_M for _, row in unflagged)
    ratios = [ratio(rows) for rows in seeds.values()]
    low, high = wilson(beyond, len(converged))
    asked = f"; asked: {ASKED[fidelity]}" if fidelity in ASKED else ""
    print(f"| `{fidelity}` | {len(seeds)} | {len(converged)} of {len(steps)} | {100 * beyond / len(converged):.2f} % ({beyond}; {100 * low:.2f} to {100 * high:.2f} %) | "
          f"{len(far)}, {far_unflagged} | {statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f}{asked}) |")
    if not unflagged:
        return f"`{fidelity}`: no converged step is without open directions."
    seed, worst = max(unflagged, key=lambda one: float(one[1]["step_error_m"]))
    return (f"`{fidelity}`: the largest unflagged step is off by {float(worst['step_error_m']):.2f} m and {float(worst['step_error_deg']):.2f} deg (seed {seed}, {worst['t_s']} s, "
            f"overlap {worst['overlap']}, step_nees {worst['step_nees']}).")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--canyon", type=pathlib.Path, default=ROOT / "build/release/bin/canyon")
    parser.add_argument("--mission", type=pathlib.Path, help="else the built-in one")
    parser.add_argument("--fidelities", type=lambda text: text.split(","), default=["high", "high_aided"], metavar="NAME,NAME")
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-20"), metavar="FIRST-LAST")
    parser.add_argument("--keep", type=pathlib.Path, help="of one mission and one program")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    told = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        print("| fidelity | seeds | steps converged | beyond their own 99.9 % bound | over 1 m; of these unflagged | registered over prior, median (range) |")
        print("|---|---|---|---|---|---|")
        for fidelity in options.fidelities:
            with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
                found = pool.map(lambda seed, name=fidelity: keyframes(options, folder, name, seed), options.seeds)
            told.append(report(fidelity, dict(zip(options.seeds, found))))
            sys.stdout.flush()
    print("\n" + "\n".join(told))


if __name__ == "__main__":
    main()
