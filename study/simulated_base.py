#!/usr/bin/python3
"""What a base that is simulated makes of a differential receiver, beside one that is assumed: the table of docs/gnss.md.

    study/simulated_base.py                  writes the table to the terminal
    study/simulated_base.py --keep DIR       keeps the built-in way there
    study/simulated_base.py --seeds N        fewer runs: for a quick look, not to be committed

The receiver of fidelity high, `dgps_2010`, in mode dgps and in mode dgps_base: standing ten minutes under an open sky, and on the way of the
built-in mission (that of `low`, seed 1) in its street, open loop. Each of the runs has a seed of its own and begins half an hour after the
one before; both modes have the same seeds.
"""
import concurrent.futures
import csv
import json
import math
import sys

from six_receivers import STEP_S, canyon, percentile, run, write_ways

FIRST_SOW = 306000.0  # 2010-11-17T13:00, as the built-in mission
BASES = {"dgps": 'mode = "dgps"\n', "dgps_base": 'mode = "dgps_base"\n',
         "dgps_base, 20 km": 'mode = "dgps_base"\nbase_place_m = [-12000, 16000, 20]\n',
         "dgps_base, base an m8": 'mode = "dgps_base"\nbase_receiver = "m8"\n'}
PLACES = {"open sky": "[scene]\nempty = true\n", "street": ""}
ROWS = [("open sky", base) for base in BASES] + [("street", "dgps"), ("street", "dgps_base")]


def simulate(options, folder, place, base, k):
    """How far the fixes of one run are off, in the plane and in space, and how many epochs it has."""
    here = folder / f"{place}_{base}_{k}".replace(" ", "_").replace(",", "")
    scene = here.with_suffix(".toml")
    scene.write_text(f'base = "vicksburg"\n{PLACES[place]}[gnss]\n{BASES[base]}', encoding="utf-8")
    way = ["--trajectory", str(folder / f"way_{k}.tum")]
    if place == "open sky":
        way = ["--at", "32.35,-90.88,75", "--start", f"1610:{FIRST_SOW + STEP_S * (k - 1)}", "--duration", "600"]
    told = json.loads(canyon(options, "gnss", "simulate", "--scene", str(scene), *way, "--seed", str(k), "--threads", "1", "--json", "--force",
                             "--out", str(here)))
    with open(here / "fixes.csv", encoding="utf-8") as stream:
        off = [[float(row[f"error_{axis}_m"]) for axis in "enu"] for row in csv.DictReader(stream) if row["error_e_m"]]
    return [math.hypot(e, n) for e, n, _ in off], [math.hypot(*enu) for enu in off], told["epochs"]


def table(options, folder):
    write_ways(options, folder)
    print("| place, mode | fixes, % | H50, m | H95, m | 3-D RMS, m |")
    print("|---|---|---|---|---|")
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for place, base in ROWS:
            made = list(pool.map(lambda k: simulate(options, folder, place, base, k), range(1, options.seeds + 1)))
            plane_m, space_m = (sum((one[i] for one in made), []) for i in (0, 1))
            rms_m = math.sqrt(sum(x * x for x in space_m) / len(space_m))
            fixes = 100.0 * len(space_m) / sum(one[2] for one in made)
            print(f"| {place}, `{base}` | {fixes:.1f} | {percentile(plane_m, 0.5):.3f} | {percentile(plane_m, 0.95):.3f} | {rms_m:.3f} |",
                  flush=True)


if __name__ == "__main__":
    sys.exit(run(__doc__, table))
