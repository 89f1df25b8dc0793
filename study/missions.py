#!/usr/bin/python3
"""How every mission of missions/ ends, seeds paired over the fidelities.

    study/missions.py                              seeds 1 to 20, low, high, high_aided and modern; what brings its own scene or the built-in one
    study/missions.py --cities DIR                 also missions/delivery/, whose buildings lie in folders below DIR
    study/missions.py --seeds 21-40 --keep DIR     keeps finished seeds there, and goes on where an earlier call ended
    study/missions.py --only underpass,shibuya --jobs 2

Each run is driven with `--plan --for outcome,position`. Position error: of each run the root mean square over all epochs, of these the median. Intervals: 95 % by Wilson.
"""
import argparse
import collections
import concurrent.futures
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

from factorial import seeds_of, wilson

ROOT = pathlib.Path(__file__).resolve().parents[1]
NOT_MISSIONS = {"fidelities"}


def prepared(mission, folder, cities):
    """The mission's file, beside the data that it names; None where these are not there."""
    named = re.findall(r'"data/([^"]+)"', mission.read_text())
    if not named or all((mission.parent / "data" / name).exists() for name in named):
        return mission
    held = [path.parent.resolve() for path in sorted(cities.rglob(named[0]))] if cities else []
    held = [path for path in held if all((path / name).exists() for name in named)]
    if not held:
        return None
    beside = folder / mission.stem
    beside.mkdir(exist_ok=True)
    shutil.copy(mission, beside)
    link = beside / "data"
    link.unlink(missing_ok=True)
    link.symlink_to(held[0])
    return beside / mission.name


def runs(options, folder, name, file, seed):
    """By fidelity."""
    kept = folder / f"{name}-{seed}.json"
    found = json.loads(kept.read_text()) if kept.exists() else {}
    missing = [fidelity for fidelity in options.fidelities if fidelity not in found]
    if missing:
        out = folder / f"run-{name}-{seed}"
        done = subprocess.run([options.canyon, "compare", file, "--seed", str(seed), "--fidelities", ",".join(missing), "--no-2x2", "--plan",
                               "--for", "outcome,position", "--threads", "1", "--out", out, "--force", "--json"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{name}, seed {seed}: {done.stderr[-1000:]}")
        found |= {run["fidelity"]: run for run in json.loads(done.stdout)["runs"]}
        part = kept.with_suffix(".part")
        part.write_text(json.dumps(found))
        part.replace(kept)
        shutil.rmtree(out)
    return found


def row(name, fidelity, seen):
    ends = collections.Counter(run["outcome"] for run in seen)
    successes = ends.pop("success", 0)
    low, high = wilson(successes, len(seen))
    known_m = [run["position_error_rms_m"] for run in seen if run["position_error_rms_m"] is not None]  # a run may end before it has one
    error = f"{statistics.median(known_m):.2f} m" if known_m else "-"
    others = ", ".join(f"{end} {count}" for end, count in sorted(ends.items()))
    return f"| {name} | `{fidelity}` | {successes} of {len(seen)} ({low:.2f} to {high:.2f}) | {others} | {error} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--canyon", type=pathlib.Path, default=ROOT / "build/release/bin/canyon")
    parser.add_argument("--fidelities", type=lambda text: text.split(","), default=["low", "high", "high_aided", "modern"], metavar="NAME,NAME")
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-20"), metavar="FIRST-LAST")
    parser.add_argument("--only", type=lambda text: text.split(","), metavar="NAME,NAME", help="files by name, without .toml")
    parser.add_argument("--cities", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path, help="of one program")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    missing = []
    missions = {path.stem: path for path in sorted((ROOT / "missions").rglob("*.toml")) if path.stem not in NOT_MISSIONS}
    unknown = [name for name in options.only or [] if name not in missions]
    if unknown:
        sys.exit(f"--only: {', '.join(unknown)}, expected some of {', '.join(missions)}")
    with tempfile.TemporaryDirectory() as scratch:
        folder = (options.keep or pathlib.Path(scratch)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        print("| mission | fidelity | success | other ends | position error, median |\n|---|---|---|---|---|")
        for name, mission in missions.items():
            if options.only and name not in options.only:
                continue
            file = prepared(mission, folder, options.cities)
            if not file:
                missing.append(name)
                continue
            with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
                found = list(pool.map(lambda seed: runs(options, folder, name, file, seed), options.seeds))
            for fidelity in options.fidelities:
                print(row(name, fidelity, [one[fidelity] for one in found]), flush=True)
    if missing:
        print(f"\nNot driven, as their buildings are not there (--cities): {', '.join(missing)}.")


if __name__ == "__main__":
    main()
