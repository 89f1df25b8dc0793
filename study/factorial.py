#!/usr/bin/python3
"""Blockage, reflections and drift of `high`, each there or not: the full factorial in the closed loop, seeds paired.

    study/factorial.py --seeds 1-100             prints shares, effects and interactions
    study/factorial.py --seeds 1-100 --keep DIR  keeps finished seeds there, and goes on where an earlier call ended
    study/factorial.py --base high_aided --seeds 1-20

Without blockage satellites that a clear sky would show are received, without reflections echoes leave no error, without drift the inertial
sensor has none. An effect is the difference of the shares of success with a source and without it, over all settings of the other two; an
interaction of two is half the difference of one's effect with and without the other, and of three likewise. Intervals: 95 % of 10,000 bootstrap draws of whole seeds, all eight
runs of one together. Beside them single ones: --remedies (a gate, an odometer, the filter that knows the vehicle, both, a better unit, another receiver, truth as
pose), --controls (hidden signals dropped) and --parts (that filter without one of its parts).
"""
import argparse
import concurrent.futures
import itertools
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
SOURCES = {"blockage": ("gnss", 'hidden_signals = "in_sight"'), "reflections": ("gnss", "multipath_scale = 0.0"), "drift": ("imu", 'errors = "none"')}
# Single ones beside the eight, by what the table calls them: the fidelity they are made of (none: the base), and keys of its sections.
REMEDIES = {"all, gate of 3 sigma": ("", {"fusion": 'acceptance = "gate"\ngate_sigma = 3'}),
            "all, unit of tactical grade": ("", {"imu": 'sensor = "hg4930_class"'}),
            "all, odometer, same filter": ("", {"fusion": 'states = ["biases", "gains", "wheel_scale"]\nmeasurements = ["position", "odometer"]'}),
            "all, `vehicle` filter, no odometer": ("", {"fusion": 'filter = "vehicle"\nmeasurements = ["position", "velocity", "non_holonomic", "standstill"]'}),
            "all, odometer, `vehicle` filter": ("high_aided", {}),
            "all, `modern`": ("modern", {}),
            "all, truth as pose": ("", {"run": "truth_as_pose = true"})}
# Blockage with the hidden satellites' signals not received at all, in place of received without error.
DROPPED = 'multipath_scale = 0.0\nhidden_signals = "dropped"'
CONTROLS = {"blockage, hidden signals dropped": ("", {"gnss": DROPPED, "imu": 'errors = "none"'}),
            "blockage, hidden signals dropped, drift": ("", {"gnss": DROPPED})}


def without(part, states='"biases", "gains", "mounting", "wheel_scale", "fix_error", "velocity_error"', measurements='"position", "velocity", "non_holonomic", "standstill"'):
    """The `vehicle` filter without wheels, and without that part."""
    gone = {f'"{part}"', '"velocity_error"'} if part == "velocity" else {f'"{part}"'}  # whose state nothing else observes
    kept = [", ".join(one for one in of.split(", ") if one not in gone) for of in (states, measurements)]
    return ("", {"fusion": f'filter = "vehicle"\nstates = [{kept[0]}]\nmeasurements = [{kept[1]}]'})


PARTS = {f"all, `vehicle` filter, no odometer, no `{part}`": without(part) for part in ("fix_error", "velocity", "non_holonomic", "standstill")}


def name_of(there):
    return "f" + "".join("1" if one else "0" for one in there)


def mission(base, singles):
    """A fidelity for each of the eight settings, f111 being the base itself, and for each single one."""
    text = 'base = "vicksburg"\n'
    for there in itertools.product((False, True), repeat=3):
        sections = {}
        for present, (section, keys) in zip(there, SOURCES.values()):
            if not present:
                sections.setdefault(section, []).append(keys)
        text += f'[fidelity.{name_of(there)}]\nbase = "{base}"\n'
        text += "".join(f"[fidelity.{name_of(there)}.{section}]\n" + "\n".join(keys) + "\n" for section, keys in sections.items())
    for k, (own, sections) in enumerate(singles.values()):
        text += f'[fidelity.r{k}]\nbase = "{own or base}"\n' + "".join(f"[fidelity.r{k}.{section}]\n{keys}\n" for section, keys in sections.items())
    return text


def outcomes(options, folder, singles, seed):
    """Outcome of each fidelity with that seed."""
    kept = folder / f"{options.base}-{seed}.json"
    labels = {f"r{k}": label for k, label in enumerate(singles)}
    names = [name_of(there) for there in itertools.product((False, True), repeat=3)] + [f"r{k}" for k in range(len(singles))]
    # Kept by label: the list of single ones may be another one next time.
    found = json.loads(kept.read_text()) if kept.exists() else {}
    missing = [name for name in names if labels.get(name, name) not in found]
    if missing:
        out = folder / f"run-{options.base}-{seed}"
        done = subprocess.run([options.canyon, "compare", folder / f"{options.base}.toml", "--seed", str(seed), "--fidelities", ",".join(missing), "--no-2x2",
                               "--plan", "--for", "outcome", "--threads", "1", "--out", out, "--force", "--json"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"seed {seed}: {done.stderr[-1000:]}")
        for run in json.loads(done.stdout)["runs"]:
            seen = (run["failure"] or {}).get("seen")
            found[labels.get(run["fidelity"], run["fidelity"])] = {"outcome": run["outcome"], "seen_s": seen["in_scans_s"] if seen else None}
        kept.write_text(json.dumps(found))
        subprocess.run(["rm", "-rf", out], check=True)
    return {name: found[labels.get(name, name)] for name in names}


def wilson(successes, n, z=1.959963984540054):
    middle, half = (successes + z * z / 2) / (n + z * z), z * math.sqrt(successes * (n - successes) / n + z * z / 4) / (n + z * z)
    return max(0.0, middle - half), min(1.0, middle + half)


def contrasts():
    """Weights of the eight settings for each effect: main ones, interactions of two, of all three."""
    out = {}
    for size in (1, 2, 3):
        for of in itertools.combinations(range(3), size):
            names = " x ".join(list(SOURCES)[i] for i in of)
            out[names] = {name_of(there): (-1.0) ** (size - sum(there[i] for i in of)) / 4.0 for there in itertools.product((False, True), repeat=3)}
    return out


def effect(weights, seeds):
    return sum(w * sum(seed[name]["outcome"] == "success" for seed in seeds) / len(seeds) for name, w in weights.items())


def interval(statistic, seeds, draws=10000):
    draw = random.Random(18)
    values = sorted(statistic([draw.choice(seeds) for _ in seeds]) for _ in range(draws))
    return values[int(0.025 * draws)], values[int(0.975 * draws) - 1]


def share_row(label, name, seeds):
    count = sum(seed[name]["outcome"] == "success" for seed in seeds)
    low, high = wilson(count, len(seeds))
    others = sorted(o for o in {seed[name]["outcome"] for seed in seeds} if o != "success")
    ends = ", ".join(f"{o} {sum(seed[name]['outcome'] == o for seed in seeds)}" for o in others)
    return f"| {label} | {count} of {len(seeds)} | {low:.2f} to {high:.2f} | {ends} |"


def report(seeds, singles):
    print("| what is there | success | 95 % interval | other outcomes |\n|---|---|---|---|")
    for there in itertools.product((False, True), repeat=3):
        label = ", ".join(source for source, present in zip(SOURCES, there) if present) or "none of the three"
        print(share_row(label, name_of(there), seeds))
    for k, label in enumerate(singles):
        print(share_row(label, f"r{k}", seeds))
    print("\n| effect on the share of success | | 95 % interval |\n|---|---|---|")
    for label, weights in contrasts().items():
        low, high = interval(lambda drawn, w=weights: effect(w, drawn), seeds)
        print(f"| {label} | {effect(weights, seeds):+.2f} | {low:+.2f} to {high:+.2f} |")
    runs = [run for seed in seeds for run in seed.values()]
    seen = sum(run["outcome"] == "collision" and (run["seen_s"] or 0.0) > 1.0 for run in runs)
    print(f"\nOf {len(runs)} runs {sum(run['outcome'] == 'collision' for run in runs)} collide, {seen} with what had stood in the scans for over a second.")


def seeds_of(text):
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--canyon", type=pathlib.Path, default=ROOT / "build/release/bin/canyon")
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-20"), metavar="FIRST-LAST")
    parser.add_argument("--base", default="high", help="fidelity whose sources are taken away")
    parser.add_argument("--remedies", action="store_true", help="the single remedies too")
    parser.add_argument("--controls", action="store_true", help="blockage by itself with hidden signals dropped too, in place of kept without their errors")
    parser.add_argument("--parts", action="store_true", help="the `vehicle` filter without fix_error, velocity, non_holonomic or standstill too")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    singles = (REMEDIES if options.remedies else {}) | (CONTROLS if options.controls else {}) | (PARTS if options.parts else {})
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{options.base}.toml").write_text(mission(options.base, singles))
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            seeds = list(pool.map(lambda seed: outcomes(options, folder, singles, seed), options.seeds))
    report(seeds, singles)


if __name__ == "__main__":
    main()
