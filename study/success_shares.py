#!/usr/bin/env python3
"""Success shares of low and high fidelity over many seeds, with 95 % Wilson intervals.

    study/success_shares.py [--canyon build/release/bin/canyon] [--seeds 20] [--first 1] [MISSION.toml]

Each seed is one `canyon compare` of low against high on the same random numbers. Prints a Markdown table.
"""
import argparse
import collections
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile


def wilson(successes, n, z=1.96):
    """95 % score interval of a share (Wilson 1927)."""
    p = successes / n
    centre = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return max(0.0, centre - half), min(1.0, centre + half)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mission", nargs="?", help="mission file; without it the built-in mission")
    parser.add_argument("--canyon", default="build/release/bin/canyon")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=1)
    options = parser.parse_args()

    outcomes = collections.defaultdict(collections.Counter)
    errors = collections.defaultdict(list)
    for seed in range(options.first, options.first + options.seeds):
        with tempfile.TemporaryDirectory() as folder:
            command = [options.canyon, "compare"] + ([options.mission] if options.mission else [])
            command += ["--fidelities", "low,high", "--no-2x2", "--seed", str(seed), "--json", "--out", os.path.join(folder, "out")]
            done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
            if done.returncode != 0:
                return done.returncode
        words = []
        for run in json.loads(done.stdout)["runs"]:
            outcomes[run["fidelity"]][run["outcome"]] += 1
            errors[run["fidelity"]].append(run["position_error_rms_m"])
            words.append(f'{run["fidelity"]} {run["outcome"]}')
        print(f"seed {seed}: {', '.join(words)}", file=sys.stderr, flush=True)

    print("| fidelity | success | 95 % interval | outcomes | position error RMS, median over seeds |")
    print("|---|---|---|---|---|")
    for fidelity, counts in outcomes.items():
        n = sum(counts.values())
        low, high = wilson(counts["success"], n)
        kinds = ", ".join(f"{kind} {count}" for kind, count in sorted(counts.items()))
        median = statistics.median(errors[fidelity])
        print(f'| {fidelity} | {counts["success"]} of {n} | {low:.2f} to {high:.2f} | {kinds} | {median:.2f} m |')
    return 0


if __name__ == "__main__":
    sys.exit(main())
