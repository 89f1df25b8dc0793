#!/usr/bin/python3
"""What makes the errors of the receiver of `modern` (f9p) in the built-in street: the same observations solved in other ways.

    study/street_receiver.py [--keep DIR] [--seeds N] [--jobs N] [--canyon FILE]

The runs are those of six_receivers.py (and are kept in the same folder). Each row solves all of them with one thing changed; beside it stands
the change of the run's 3-D RMS against the first row, mean over runs and its 95 % interval (paired, Student's t).
"""
import csv
import datetime
import json
import math
import pathlib
import statistics
import sys

import six_receivers

# The receiver's own figures (gnss/receivers/f9p.toml) as keys of `gnss solve`; a Doppler counts a tenth of its range, as in the receiver.
OWN = {"systems": '"GREC"', "mask_deg": 10.0, "max_gdop": 25.0, "frequencies": '"dual"', "ionosphere": '"klobuchar"', "shared_ionosphere": 0.0,
       "smoothing_s": 30.0, "estimator": '"kalman"', "acceleration_m_s2": 1.0, "weighting": '"cn0"', "sigma_m": 1.0, "doppler_sigma_m_s": 0.1,
       "fault_exclusion": '"greedy"'}
IN_SIGHT = ("los", lambda row: row["line_of_sight"] == "1")


def louder(cn0_dbhz):
    return f"cn0_{cn0_dbhz}", lambda row: float(row["cn0_dbhz"] or 0) >= cn0_dbhz


# Name; keys that differ; which observations are kept (None: all).
ROWS = [
    ("as the receiver does", {}, None),
    ("hidden satellites dropped, by the truth", {}, IN_SIGHT),
    ("first band only", {"frequencies": '"single"'}, None),
    ("first band only, hidden ones dropped", {"frequencies": '"single"'}, IN_SIGHT),
    *((f"what is below {c} dB-Hz dropped", {}, louder(c)) for c in (25, 30, 35, 40)),
    ("mask of 20 degrees", {"mask_deg": 20.0}, None),
    ("mask of 30 degrees", {"mask_deg": 30.0}, None),
    ("weights by elevation", {"weighting": '"elevation"'}, None),
    ("weights by elevation and C/N0", {"weighting": '"elevation_cn0"'}, None),
    ("all weights alike", {"weighting": '"uniform"'}, None),
    ("no smoothing by carrier", {"smoothing_s": 0.0}, None),
    ("smoothing over 300 s", {"smoothing_s": 300.0}, None),
    ("acceleration 0.1 m/s^2/sqrt(Hz)", {"acceleration_m_s2": 0.1}, None),
    ("acceleration 5 m/s^2/sqrt(Hz)", {"acceleration_m_s2": 5.0}, None),
    ("Doppler trusted five times more", {"doppler_sigma_m_s": 0.02}, None),
    ("Doppler trusted ten times less", {"doppler_sigma_m_s": 1.0}, None),
    ("epoch by epoch, greedy exclusion", {"estimator": '"least_squares"'}, None),
    ("epoch by epoch, no exclusion", {"estimator": '"least_squares"', "fault_exclusion": '"none"'}, None),
]


def tenths(sow_s):
    return round(10.0 * sow_s)


def of_epoch(line):
    """Second of the week, in tenths, of a RINEX 3 epoch line, and its number of satellites."""
    year, month, day, hour, minute, second = line[1:29].split()
    days = datetime.date(int(year), int(month), int(day)).isoweekday() % 7
    return tenths(86400.0 * days + 3600.0 * int(hour) + 60.0 * int(minute) + float(second)), int(line[32:35])


def kept_observations(folder, run, keep):
    """The run's observations with those that `keep` wants."""
    if keep is None:
        return folder / f"{run}.obs"
    out = folder / f"{run}.{keep[0]}.obs"
    if out.exists():
        return out
    with open(folder / run / "satellites.csv", encoding="utf-8") as stream:
        wanted = {(tenths(float(row["sow"])), row["satellite"]) for row in csv.DictReader(stream) if keep[1](row)}
    lines = (folder / f"{run}.obs").read_text(encoding="utf-8").split("\n")
    at = next(i for i, line in enumerate(lines) if "END OF HEADER" in line) + 1
    made = lines[:at]
    while at < len(lines) and lines[at].startswith(">"):
        t, count = of_epoch(lines[at])
        body = [line for line in lines[at + 1:at + 1 + count] if (t, line[:3]) in wanted]
        made += [f"{lines[at][:32]}{len(body):3d}{lines[at][35:]}", *body]
        at += 1 + count
    out.write_text("\n".join(made) + "\n", encoding="utf-8")
    return out


def truth_of(folder, run):
    path = folder / f"{run}.truth.csv"
    with open(folder / run / "fixes.csv", encoding="utf-8") as stream:
        rows = [[row[key] for key in ("gps_week", "sow", "true_x_m", "true_y_m", "true_z_m")] for row in csv.DictReader(stream)]
    path.write_text("gps_week,sow,x_m,y_m,z_m\n" + "".join(",".join(row) + "\n" for row in rows), encoding="utf-8")
    return path


def solve(options, folder, run, changed, keep):
    config = folder / f"{run}.solve.toml"
    config.write_text("".join(f"{key} = {value}\n" for key, value in {**OWN, **changed}.items()), encoding="utf-8")
    return json.loads(six_receivers.canyon(options, "gnss", "solve", "--threads", "1", "--json", "--obs", str(kept_observations(folder, run, keep)),
                                           "--nav", str(folder / f"{run}.nav"), "--config", str(config), "--truth", str(truth_of(folder, run))))


def half_interval(differences):
    """Student's t at 97.5 % by its expansion in 1 / degrees of freedom (Abramowitz & Stegun 26.7.5)."""
    n, z = len(differences), 1.959964
    if n < 2:
        return math.nan
    t = z + (z**3 + z) / (4 * (n - 1)) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * (n - 1) ** 2)
    return t * statistics.stdev(differences) / math.sqrt(n)


def table(options, folder):
    six_receivers.write_ways(options, folder)
    runs = [six_receivers.observe(options, folder, "f9p", k).stem for k in range(1, options.seeds + 1)]
    print(f"| {len(runs)} runs | fixes, % | H50, m | H95, m | mean height error, m | 3-D RMS, m | against the first row, m |")
    print("|---|---|---|---|---|---|---|")
    first = None
    for name, changed, keep in ROWS:
        made = [solve(options, folder, run, changed, keep) for run in runs]
        off_m = [one["rms_3d_m"] for one in made]
        first = first or off_m
        differences = [a - b for a, b in zip(off_m, first)]
        against = "" if off_m is first else f"{statistics.mean(differences):+.1f} ± {half_interval(differences):.1f}"
        mean = {key: statistics.mean(one[key] for one in made) for key in ("h50_m", "h95_m", "mean_u_m")}
        fixes = 100.0 * sum(one["solved"] for one in made) / sum(one["epochs"] for one in made)
        print(f"| {name} | {fixes:.0f} | {mean['h50_m']:.1f} | {mean['h95_m']:.1f} | {mean['mean_u_m']:+.1f} | {statistics.mean(off_m):.1f} "
              f"| {against} |", flush=True)


if __name__ == "__main__":
    sys.exit(six_receivers.run(__doc__, table))
