#!/usr/bin/env python3
"""Filters beside one another on the same fixes, and beside an oracle that is told how far each fix is off.

    study/filter_study.py --route vicksburg --seeds 1-10 --filters naive,vehicle,tight --oracle
    study/filter_study.py --route city7 --seeds 101-103 --set 'loose=filter = "vehicle"; fix_error_scale = 3'
    study/filter_study.py --route city7 --seeds 101-103 --fixes
    study/filter_study.py --like high --seeds 1-20 --filters naive,vehicle,tight --parts --oracle
    study/filter_study.py --like high --seeds 1-20 --filters vehicle --map-aided

Each seed is driven once in an open loop, by truth, with everything that any of the filters measures with; `canyon fuse` then gives each
filter that record. So all of them meet the same motion, fixes, ranges, ticks and noise. The rear axle slips and the unit is mounted
askew. The channel and the receiver are spelled out below and owe nothing to what a fidelity is: with `--channel` another file's, with
`--like` those of a fidelity as it is today.

vicksburg is the built-in route, which is reported. The routes in other cities at other hours are there to choose by.

Oracles get fixes whose covariance is, epoch by epoch, the mean of e e' over the other seeds and the second around. `oracle, white` is
`vehicle` without states for errors that last, with accept_all, on that times `--oracle-scale` for what the errors of one fix and the next have
in common; `oracle, lasting` is `vehicle` as it is on that covariance.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import random
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent

# What `high` was when the figures of docs/fusion.md were measured: a good differential receiver of 2010, walls and edges.
CHANNEL = """
[fidelity.recorded.gnss]
model = "pseudorange"
mode = "dgps"
ephemeris_error = "orbit_clock_2010"
paths = "specular2"
diffraction = "double_knife_edge"
multipath_rule = "correlator"
correlator_spacing_chips = 0.1
front_end_mhz = 16.0
code_loop_hz = 0.25
tracking_threshold_dbhz = 28.0
antenna = "survey"
weighting = "elevation_cn0"
raim = "greedy"
raim_false_alarm = 1e-3
max_gdop = 30.0
"""

COMMON = """
[registration]
method = "none"
[vehicle]
sideslip_deg_per_m_s2 = 0.6
{vehicle}
[imu]
mounting_error_deg = 0.5
[success]
waypoint_radius_m = {radius}
[run]
record_filter_input = true
{run}
[fidelity.recorded]
base = "{base}"
[fidelity.recorded.imu]
errors = "datasheet"
[fidelity.recorded.run]
initial_attitude_error_deg = [0.1, 0.1, 1.0]
[fidelity.recorded.fusion]
states = ["biases", "gains", "mounting", "wheel_scale", "receiver_clock"]
measurements = ["position", "velocity", "non_holonomic", "standstill", "odometer", "ranges"]
acceptance = "innovation_adaptive"
"""

ROUTES = {"vicksburg": None,
          "city7": {"seed": 7, "start": "2010-11-17T04:30:00"},
          "city8": {"seed": 8, "start": "2010-11-19T09:10:00"},
          "city9": {"seed": 9, "start": "2010-11-21T19:40:00"}}

FILTERS = {"naive": 'filter = "naive"', "vehicle": 'filter = "vehicle"', "tight": 'filter = "tight"'}
ORACLE = 'filter = "vehicle"\nstates = ["biases", "gains", "mounting", "wheel_scale"]\nacceptance = "accept_all"'


STATES = ["biases", "gains", "mounting", "wheel_scale", "fix_error", "velocity_error"]
MEASUREMENTS = ["position", "velocity", "non_holonomic", "standstill", "odometer"]


def parts():
    """`vehicle` with one part removed at a time, and with what it assumes wrong by two either way."""
    without = lambda kind, names, one: f'filter = "vehicle"\n{kind} = {json.dumps([n for n in names if n != one])}'
    wrong = lambda by: (f'filter = "vehicle"\nodometer_slip_percent = {0.3 * by}\nnon_holonomic_sigma_m_s = {0.1 * by}\n'
                        f'non_holonomic_sideslip = {0.02 * by}\nfix_error_scale = {1.5 * by}\nfix_velocity_scale = {by}\n'
                        f'velocity_error_scale = {0.5 * by}')
    out = {f"without {m}": without("measurements", MEASUREMENTS, m) for m in MEASUREMENTS if m != "position"}
    out |= {f"without state {s}": without("states", STATES, s) for s in ("mounting", "fix_error", "velocity_error")}
    return out | {"with accept_all": 'filter = "vehicle"\nacceptance = "accept_all"',
                  "without a way back": 'filter = "vehicle"\nlost_after_s = 0', "all doubled": wrong(2.0), "all halved": wrong(0.5)}


def call(arguments, log):
    with open(log, "w") as out:
        done = subprocess.run(arguments, stdout=out, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: exit status {done.returncode}\n{pathlib.Path(log).read_text()[-2000:]}")


def route_of(city, streets, attempt):
    """A way of about a kilometre from the middle of one street to that of another, by numbers that depend on the city alone."""
    draw = random.Random(1000 * attempt + city["seed"])
    edges = [(e["a"], e["b"]) for e in streets if math.dist(e["a"], e["b"]) > 60.0]
    middle = lambda e: [(e[0][0] + e[1][0]) / 2, (e[0][1] + e[1][1]) / 2]
    first = draw.choice(edges)
    points, at, length = [], middle(first), 0.0
    while length < 800.0:
        to = middle(draw.choice(edges))
        if not 120.0 < math.dist(at, to) < 350.0:
            continue
        length += math.dist(at, to)
        points.append(to)
        at = to
    (ax, ay), (bx, by) = sorted(first, key=lambda end: -math.dist(end, points[0]))
    heading = math.degrees(math.atan2(bx - ax, by - ay))
    return middle(first), heading, points


def streets_of(arguments, work, place):
    """A run of nearly nothing from some place that is outside of buildings tells the streets."""
    draw = random.Random(1)
    for _ in range(200):
        x, y = draw.uniform(-300, 300), draw.uniform(-300, 300)
        probe, folder = work / "probe.toml", work / "probe"
        probe.write_text(place.replace("[time]", '[registration]\nmethod = "none"\n[time]\nlimit_s = 0.5') +
                         f'[vehicle]\nstart_m = [{x}, {y}]\n[[autonomy.waypoint]]\nname = "1"\np_m = [{x + 3}, {y}]\n')
        done = subprocess.run([arguments.canyon, "run", probe, "--fidelity", "low", "--out", folder, "--force"], capture_output=True)
        if done.returncode == 0:
            return json.loads((folder / "scene.json").read_text())
    sys.exit("no place outside of buildings found")


def mission(arguments, work, attempt):
    city = ROUTES[arguments.route]
    channel = arguments.channel.read_text() if arguments.channel else "" if arguments.like else CHANNEL
    base = arguments.like or "low"
    if city is None:
        return 'base = "vicksburg"\n' + COMMON.format(vehicle="", run="", radius=3, base=base) + channel
    place = (f'[scene]\nseed = {city["seed"]}\nlat_deg = 32.35\nlon_deg = -90.88\n[time]\nstart = "{city["start"]}"\n')
    scene = work / f"{arguments.route}.scene.json"
    if not scene.exists():
        scene.write_text(json.dumps(streets_of(arguments, work, place)))
    start, heading, points = route_of(city, json.loads(scene.read_text())["streets"], attempt)
    text = place + COMMON.format(vehicle=f"start_m = [{start[0]:.3f}, {start[1]:.3f}]\nstart_heading_deg = {heading:.3f}",
                                 run=f'name = "{arguments.route}"', radius=60, base=base) + channel
    for i, p in enumerate(points):
        text += f'[[autonomy.waypoint]]\nname = "{i + 1}"\np_m = [{p[0]:.3f}, {p[1]:.3f}]\n'
    return text


def record(arguments, work, seed):
    """The folder of a run; of a route's attempts the first one that can be driven."""
    folder, file = work / f"{arguments.route}-{seed}", work / f"{arguments.route}.toml"
    if folder.exists():
        return folder
    log = work / f"{folder.name}.log"
    for attempt in range(1 if ROUTES[arguments.route] is None or file.exists() else 30):
        if not file.exists() or attempt > 0 or ROUTES[arguments.route] is None:
            file.write_text(mission(arguments, work, attempt))
        with open(log, "w") as out:
            done = subprocess.run([arguments.canyon, "compare", file, "--open-loop", "--seed", str(seed), "--fidelities", "recorded",
                                   "--no-2x2", "--plan", "--for", "position", "--threads", str(arguments.threads), "--out",
                                   folder], stdout=out, stderr=subprocess.STDOUT)
        if done.returncode == 0:
            return folder
    file.unlink()
    sys.exit(f"exit status {done.returncode}, {log}: {log.read_text()[-1000:]}")


def fuse(arguments, folder, name, keys):
    name = name.replace(",", "").replace(" ", "_")
    config = folder.parent / f"{name}.fuse.toml"
    config.write_text("[fusion]\n" + keys.replace("; ", "\n") + "\n")
    out = folder.parent / f"fused-{folder.name}-{name}"
    call([arguments.canyon, "fuse", "--results", folder, "--run", "recorded", "--config", config, "--out", out, "--force"],
         folder.parent / f"{out.name}.log")
    summary = json.loads((out / "summary.json").read_text())
    with open(out / "errors.csv") as file:
        rows = [[float(r[k]) for k in ("error_e_m", "error_n_m", "error_u_m", "sigma_e_m", "sigma_n_m", "sigma_u_m")]
                for r in csv.DictReader(file) if r["scored"] == "1"]
    largest = max(math.hypot(*r[:3]) for r in rows)
    ratio = [[(r[i] / r[3 + i]) ** 2 for r in rows] for i in range(3)]
    return {"rms": summary["rms_3d_m"], "e": summary["rms_e_m"], "n": summary["rms_n_m"], "u": summary["rms_u_m"], "max": largest,
            "h": math.hypot(summary["rms_e_m"], summary["rms_n_m"]),
            "mean": [statistics.fmean(r) for r in ratio], "median": [statistics.median(r) for r in ratio],
            "within": horizontal_shares(summary["evidence"])}


def map_aided(arguments, folder):
    """`vehicle` on the same drive, with the motion between registered keyframes: what no record holds, so the drive is simulated again."""
    file, out = folder.parent / f"{arguments.route}-aided.toml", folder.parent / f"aided-{folder.name}"
    text = (folder.parent / f"{arguments.route}.toml").read_text().replace('[registration]\nmethod = "none"\n', "")
    file.write_text(text + '[fidelity.aided]\nbase = "recorded"\n[fidelity.aided.fusion]\nfilter = "vehicle"\nstates = []\nmeasurements = []\n'
                           'acceptance = "as_filter"\nmap_aiding = true\n')
    call([arguments.canyon, "compare", file, "--open-loop", "--seed", folder.name.rpartition("-")[2], "--fidelities", "aided", "--no-2x2", "--plan",
          "--for", "position", "--threads", str(arguments.threads), "--out", out, "--force"], folder.parent / f"{out.name}.log")
    run = json.loads((out / "summary.json").read_text())["runs"][0]
    rows = [[float(r[k]) for k in ("error_e_m", "error_n_m", "error_u_m", "sigma_e_m", "sigma_n_m", "sigma_u_m")]
            for r in table_rows(out / "epochs" / "aided_nav.csv")]
    ratio = [[(r[i] / r[3 + i]) ** 2 for r in rows] for i in range(3)]
    e, n, u = (run[f"position_error_{axis}_rms_m"] for axis in ("e", "n", "up"))
    return {"rms": run["position_error_rms_m"], "e": e, "n": n, "u": u, "max": run["position_error_max_m"], "h": math.hypot(e, n),
            "mean": [statistics.fmean(r) for r in ratio], "median": [statistics.median(r) for r in ratio],
            "within": horizontal_shares(run["evidence"])}


def horizontal_shares(evidence):
    """Of epochs within the 50, 95 and 99.7 % ellipses, %."""
    for block in evidence["blocks"]:
        if block["name"] == "position":
            return [100.0 * block[k] for k in ("within_50", "within_95", "within_997")]
    return [math.nan] * 3


def table_rows(path):
    with open(path) as file:
        return list(csv.DictReader(file))


def fix_errors(folder):
    """By time since the start, ns: error east, north, up."""
    out = {}
    for r in table_rows(folder / "epochs" / "recorded_gnss.csv"):
        if r["status"] != "none":
            out[round(float(r["t_s"]) * 1e9)] = [float(r[k]) for k in ("error_e_m", "error_n_m", "error_u_m")]
    return out


def told_truly(folder, others, origin, scale):
    """A copy of the record whose fixes state `scale` times the covariance that the errors of the other seeds show."""
    copy = folder.parent / f"{folder.name}-told-{scale:g}"
    (copy / "epochs").mkdir(parents=True, exist_ok=True)
    for path in list(folder.iterdir()) + list((folder / "epochs").iterdir()):
        to = copy / path.relative_to(folder)
        if path.is_file() and not to.exists() and path.name != "recorded_fixes.csv":
            os.link(path, to)
    lat, lon = math.radians(origin["lat_deg"]), math.radians(origin["lon_deg"])
    R = [[-math.sin(lon), -math.sin(lat) * math.cos(lon), math.cos(lat) * math.cos(lon)],
         [math.cos(lon), -math.sin(lat) * math.sin(lon), math.cos(lat) * math.sin(lon)],
         [0.0, math.cos(lat), math.sin(lat)]]  # E from east, north, up
    errors = [fix_errors(o) for o in others]
    rows = table_rows(folder / "epochs" / "recorded_fixes.csv")
    for row in rows:
        if row["status"] == "none":
            continue
        t = int(row["t_ns"])
        near = [e[k] for e in errors for k in e if abs(k - t) <= 1.01e9]
        if not near:
            continue
        C = [[scale * sum(e[i] * e[j] for e in near) / len(near) + (1e-4 if i == j else 0.0) for j in range(3)]
             for i in range(3)]
        RC = [[sum(R[i][k] * C[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
        E = [[sum(RC[i][k] * R[j][k] for k in range(3)) for j in range(3)] for i in range(3)]
        for name, (i, j) in {"xx": (0, 0), "xy": (0, 1), "xz": (0, 2), "yy": (1, 1), "yz": (1, 2), "zz": (2, 2)}.items():
            row[name + "_m2"] = repr(E[i][j])
    with open(copy / "epochs" / "recorded_fixes.csv", "w", newline="") as file:
        out = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        out.writeheader()
        out.writerows(rows)
    return copy


def describe_fixes(folders):
    """How large the errors of fixes are beside what they state, and over which way and time they change."""
    bins, lagged, rest = {}, {}, {}
    for folder in folders:
        fixes = []
        for r in table_rows(folder / "epochs" / "recorded_gnss.csv"):
            if r["status"] == "none":
                continue
            f = {k: float(r[k]) for k in r if k.endswith("_m") or k == "t_s"}
            fixes.append((f["t_s"], (f["true_x_m"], f["true_y_m"]), [f[f"error_{a}_m"] for a in "enu"], [f[f"sigma_{a}_m"] for a in "enu"]))
        for _, _, error, sigma in fixes:
            for axis in range(3):
                key = ("up" if axis == 2 else "across", round(2 * math.log2(sigma[axis])) / 2)
                bins.setdefault(key, []).append(error[axis])
        z = [[e / s for e, s in zip(f[2], f[3])] for f in fixes]
        way = [0.0]
        for a, b in zip(fixes, fixes[1:]):
            way.append(way[-1] + math.dist(a[1], b[1]))
        for i in range(len(fixes)):
            for j in range(i + 1, min(i + 240, len(fixes))):
                moved, passed = way[j] - way[i], fixes[j][0] - fixes[i][0]
                product = [math.copysign(min(abs(z[i][k]), 5.0), z[i][k]) * math.copysign(min(abs(z[j][k]), 5.0), z[j][k]) for k in range(3)]
                if moved < 0.5:
                    rest.setdefault(round(passed), []).append(product)
                elif moved < 300.0:
                    lagged.setdefault(round(2 * math.log2(moved)) / 2, []).append(product)
        for k in range(3):
            own = [math.copysign(min(abs(x[k]), 5.0), x[k]) ** 2 for x in z]
            lagged.setdefault("own", []).extend([[own[i] if k == j else math.nan for j in range(3)] for i in range(len(own))])
    print("axis    stated, m   fixes   RMS, m   median |error|, m   RMS / stated")
    for (axis, power), errors in sorted(bins.items()):
        rms = math.sqrt(statistics.fmean(e * e for e in errors))
        print(f"{axis:7} {2**power:8.2f} {len(errors):8} {rms:8.2f} {statistics.median(map(abs, errors)):12.2f} {rms / 2**power:18.2f}")
    own = [statistics.fmean(x[k] for x in lagged["own"] if not math.isnan(x[k])) for k in range(3)]
    print("way, m: correlation east, north, up of errors in units of what is stated, up to 5")
    for key in sorted(k for k in lagged if k != "own"):
        print(f"{2**key:8.1f} " + " ".join(f"{statistics.fmean(p[k] for p in lagged[key]) / own[k]:6.2f}" for k in range(3)), len(lagged[key]))
    print("at rest, s:")
    for key in sorted(rest):
        if key in (1, 2, 4, 8, 12, 16, 24):
            print(f"{key:8} " + " ".join(f"{statistics.fmean(p[k] for p in rest[key]) / own[k]:6.2f}" for k in range(3)), len(rest[key]))


def seeds_of(text):
    first, _, last = text.partition("-")
    return list(range(int(first), int(last or first) + 1))


def times(runs, others):
    """Ratio of the RMS of runs to those of others with the same seeds: its median, and the 95 % interval of that by order statistics."""
    ratios = sorted(a["rms"] / b["rms"] for a, b in zip(runs, others))
    n, left = len(ratios), 0
    while sum(math.comb(n, k) for k in range(left + 1)) / 2**n <= 0.025:
        left += 1
    interval = f" [{ratios[left - 1]:.2f}, {ratios[n - left]:.2f}]" if left else ""
    return f"{statistics.median(ratios):.2f}{interval}"


def print_table(results):
    """The last column is beside `vehicle`, of the same seeds."""
    median = statistics.median
    print("| filter | seeds | 3-D RMS, m (range) | horizontal | east, north, up | largest | coverage, % | (e/sigma)² mean | median | times `vehicle` |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for name, runs in results.items():
        of = lambda key: median(r[key] for r in runs)
        within = " / ".join(f"{statistics.fmean(r['within'][i] for r in runs):.0f}" for i in range(3))
        three = lambda key, d=1: ", ".join(f"{median(r[key][i] for r in runs):.{d}f}" for i in range(3))
        print(f"| {name} | {len(runs)} | {of('rms'):.2f} ({min(r['rms'] for r in runs):.2f} to {max(r['rms'] for r in runs):.2f}) | {of('h'):.2f} | "
              f"{of('e'):.2f}, {of('n'):.2f}, {of('u'):.2f} | {of('max'):.1f} | {within} | {three('mean')} | {three('median')} | "
              f"{times(runs, results['vehicle']) if 'vehicle' in results and name != 'vehicle' else ''} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--canyon", type=pathlib.Path, default=HERE.parent / "build/release/bin/canyon")
    parser.add_argument("--work", type=pathlib.Path, default=HERE.parent / "build/filter_study", help="what is recorded is kept here")
    parser.add_argument("--route", choices=ROUTES, default="vicksburg")
    parser.add_argument("--channel", type=pathlib.Path, help="TOML with [fidelity.recorded.gnss], in place of the one written here")
    parser.add_argument("--like", help="name of a fidelity, whose channel and receiver are taken")
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-3"))
    parser.add_argument("--filters", default="", help="of naive, vehicle, tight")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=KEYS", help="a filter of these keys of [fusion], parted by '; '")
    parser.add_argument("--parts", action="store_true", help="vehicle without each of its parts, and told wrongly")
    parser.add_argument("--map-aided", action="store_true", help="vehicle with the motion between registered keyframes too")
    parser.add_argument("--oracle", action="store_true")
    parser.add_argument("--oracle-scale", type=float, default=3.0)
    parser.add_argument("--fixes", action="store_true", help="what the fixes' errors are like")
    parser.add_argument("--threads", type=int, default=1)
    arguments = parser.parse_args()
    filters = {name: FILTERS[name] for name in arguments.filters.split(",") if name}
    filters |= dict(one.split("=", 1) for one in arguments.set)
    filters |= parts() if arguments.parts else {}
    work = arguments.work
    work.mkdir(parents=True, exist_ok=True)
    folders = {seed: record(arguments, work, seed) for seed in arguments.seeds}
    if arguments.fixes:
        describe_fixes(list(folders.values()))
    results = {name: [fuse(arguments, folder, name, keys) for folder in folders.values()] for name, keys in filters.items()}
    if arguments.map_aided:
        results["vehicle, map-aided"] = [map_aided(arguments, folder) for folder in folders.values()]
    if arguments.oracle:
        origin = json.loads((next(iter(folders.values())) / "summary.json").read_text())["scene"]["origin"]
        for name, keys, scale in (("oracle, white", ORACLE, arguments.oracle_scale), ("oracle, lasting", FILTERS["vehicle"], 1.0)):
            told = [told_truly(folder, [f for s, f in folders.items() if s != seed], origin, scale) for seed, folder in folders.items()]
            results[name] = [fuse(arguments, folder, name, keys) for folder in told]
    if results:
        print_table(results)


if __name__ == "__main__":
    main()
