#!/usr/bin/python3
"""How far registration's own covariance can be believed in a whole mission, and what it makes of the filter's keyframes.

    study/keyframes.py                             `high` and `high_aided`, seeds 1 to 20
    study/keyframes.py --seeds 21-28 --keep DIR    keeps the keyframes of finished runs there, and goes on where an earlier call ended
    study/keyframes.py --mission my.toml --fidelities high --jobs 2
    study/keyframes.py --fidelities high --seeds 1-3 --check    exit status 1 unless the claims hold

Each run is driven with `--plan --for outcome,position,map`; read is its epochs/RUN_keyframes.csv (docs/results.md). Of a keyframe's step, the motion since the one before as
the map took it, `step_nees` is the error squared over its own covariance: with 6 degrees of freedom one in a thousand should be beyond 22.46. Where an alignment did not
converge the step is the predicted motion with its covariance, which is judged like any other. Unflagged is a step that converged with no direction open. Registered over
prior: root mean squares of the keyframes' position errors, of each seed. Intervals: 95 % by Wilson, of steps as if they were independent.

The claims of --check: no more steps beyond their bound than chance makes of one in a thousand (a false alarm of 1e-4), of all and of those that did not converge alone;
none over 1 m unflagged; registered over prior, the median of the seeds, within BAND.
"""
import argparse
import concurrent.futures
import csv
import dataclasses
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
CLAIMED = 1e-3  # of steps beyond it, by their own covariance
ALARM = 1e-4
FAR_M = 1.0
ASKED = {"high": 0.6, "high_aided": 1.0}  # registered over prior, at most
# Registered over prior, of a median of seeds: from the least of seeds 1 to 20 (0.23 to 1.03, README.md) up to where registration would be of no use. A median of three lies
# outside only where two of them do.
BAND = {"high": (0.23, 1.0)}


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


def is_beyond(row):
    """Also where the step has no covariance, or one that is none: it bounds nothing."""
    return not 0.0 <= float(row["step_nees"] or "nan") <= BOUND


def is_far(row):
    return not float(row["step_error_m"] or "nan") <= FAR_M


def unconverged(steps):
    return [(seed, row) for seed, row in steps if row["status"] != "converged"]


def unflagged(steps):
    return [(seed, row) for seed, row in steps if row["status"] == "converged" and row["open_directions"] == "0"]


@dataclasses.dataclass
class Judged:
    """Steps, each with its seed, and of each seed registered over prior."""

    steps: list
    beyond: list
    far: list
    ratios: list


def judged(fidelity, seeds):
    """`seeds`: rows of keyframes by seed. The first keyframe of each has no step."""
    steps = [(seed, row) for seed, rows in seeds.items() for row in rows if row["status"] != "not_registered"]
    if len(unconverged(steps)) == len(steps):
        sys.exit(f"{fidelity}: no step converged")
    return Judged(steps, [one for one in steps if is_beyond(one[1])], [one for one in steps if is_far(one[1])], [ratio(rows) for rows in seeds.values()])


def report(fidelity, found):
    """A row of the table, and what the worst steps are."""
    n, beyond = len(found.steps), len(found.beyond)
    low, high = wilson(beyond, n)
    asked = f"; asked: {ASKED[fidelity]}" if fidelity in ASKED else ""
    print(f"| `{fidelity}` | {len(found.ratios)} | {n - len(unconverged(found.steps))} of {n} | "
          f"{100 * beyond / n:.2f} % ({beyond}; {100 * low:.2f} to {100 * high:.2f} %), {len(unconverged(found.beyond))} | {len(found.far)}, {len(unflagged(found.far))} | "
          f"{statistics.median(found.ratios):.2f} ({min(found.ratios):.2f} to {max(found.ratios):.2f}{asked}) |")
    if not unflagged(found.steps):
        return f"`{fidelity}`: no converged step is without open directions."
    seed, worst = max(unflagged(found.steps), key=lambda one: float(one[1]["step_error_m"]))
    return (f"`{fidelity}`: the largest unflagged step is off by {float(worst['step_error_m']):.2f} m and {float(worst['step_error_deg']):.2f} deg (seed {seed}, {worst['t_s']} s, "
            f"overlap {worst['overlap']}, step_nees {worst['step_nees']}).")


def most_by_chance(n, share):
    """The most of n, each with probability `share`, that come up but for a false alarm of ALARM."""
    term = (1.0 - share) ** n
    up_to, k = term, 0
    while k < n and 1.0 - up_to > ALARM:
        term *= (n - k) / (k + 1) * share / (1.0 - share)
        k += 1
        up_to += term
    return k


def broken(fidelity, found):
    """The claims that do not hold, a line each."""
    out = []
    for what, beyond, steps in (("steps", found.beyond, found.steps), ("steps that did not converge", unconverged(found.beyond), unconverged(found.steps))):
        most = most_by_chance(len(steps), CLAIMED)
        if len(beyond) > most:
            out.append(f"{fidelity}: {len(beyond)} of {len(steps)} {what} are beyond their own 99.9 % bound, expected {most} at most")
    for seed, row in unflagged(found.far):
        out.append(f"{fidelity}: a step is off by {row['step_error_m']} m and nothing says so (seed {seed}, {row['t_s']} s), expected {FAR_M} m at most")
    low, high = BAND.get(fidelity, (0.0, math.inf))
    if not low <= statistics.median(found.ratios) < high:
        out.append(f"{fidelity}: registered over prior is {statistics.median(found.ratios):.3f} (median of {len(found.ratios)}), expected {low} to {high}")
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--canyon", type=pathlib.Path, default=ROOT / "build/release/bin/canyon")
    parser.add_argument("--mission", type=pathlib.Path, help="else the built-in one")
    parser.add_argument("--fidelities", type=lambda text: text.split(","), default=["high", "high_aided"], metavar="NAME,NAME")
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-20"), metavar="FIRST-LAST")
    parser.add_argument("--keep", type=pathlib.Path, help="of one mission and one program")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--check", action="store_true", help="exit status 1 unless the claims hold")
    options = parser.parse_args()
    told, wrong = [], []
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        print("| fidelity | seeds | steps converged | beyond their own 99.9 % bound; not converged | over 1 m; unflagged | registered over prior, median (range) |")
        print("|---|---|---|---|---|---|")
        for fidelity in options.fidelities:
            with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
                found = pool.map(lambda seed, name=fidelity: keyframes(options, folder, name, seed), options.seeds)
            judgement = judged(fidelity, dict(zip(options.seeds, found)))
            told.append(report(fidelity, judgement))
            wrong += broken(fidelity, judgement)
            sys.stdout.flush()
    print("\n" + "\n".join(told))
    if options.check and wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    main()
