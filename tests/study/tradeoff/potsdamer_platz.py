#!/usr/bin/python3
"""potsdamer_platz.py RECORDINGS OUT: makes a recording for `canyon tradeoff --recording OUT/drive.toml`.

RECORDINGS is the folder gnss/urban_berlin of the shared recordings: what a u-blox receiver observed at Potsdamer Platz, Berlin, on
2016-06-06 (smartLoc, TU Chemnitz, CC BY-SA 4.0), its surveyed way, and the buildings there (LoD2, Geoportal Berlin, dl-de/zero-2-0).
Written to OUT: the buildings as GeoJSON, the truth as CSV, the description that names them, and city.toml, a mission of that
scene with the same receiver as far as its maker tells, for `canyon gnss drive-check --scene OUT/city.toml`. street.toml is the
same with wedges, scattering walls and clutter, and with a receiver that tracks down to the weakest signal compared with the log's.

But for the gain and, in street.toml, the threshold nothing is fitted to the drive: the receiver is canyon's patch antenna on a car
roof and its defaults for what is not said.
"""
import json
import pathlib
import sys

UNDULATION_M = 39.5  # of the geoid, at the site
WEEK, START_SOW = 1900, 126641.7  # of the truth's time 0


def buildings(prisms):
    """Footprints in ETRS89 / UTM 33N and heights above the geoid, of `id y0 h x,z ...` in decimetres (the file's own head)."""
    features = []
    for line in prisms.read_text(encoding="utf-8").splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        name, ground_dm, height_dm, *corners = line.split()
        ring = []
        for corner in corners:
            x_dm, z_dm = (float(v) for v in corner.split(","))
            ring.append([round(389500.0 + 0.1 * x_dm, 1), round(5820000.0 - 0.1 * z_dm, 1)])
        ring.append(ring[0])
        features.append({"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [ring]},
                         "properties": {"id": name, "height": 0.1 * float(height_dm), "ground_height": 0.1 * float(ground_dm) + 30.0}})
    return {"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25833"}},
            "features": features}


def truth(track):
    """CSV of places in E, of `point3 t x y z ...`."""
    rows = ["gps_week,sow,x_m,y_m,z_m"]
    for line in track.read_text(encoding="utf-8").splitlines():
        fields = line.split()
        if len(fields) >= 5 and fields[0] == "point3":
            rows.append(f"{WEEK},{START_SOW + float(fields[1]):.3f},{fields[2]},{fields[3]},{fields[4]}")
    return "\n".join(rows) + "\n"


def covered(derived):
    """First and last second of the week of the stretch whose buildings are complete, for which a ray cast was derived."""
    times = [float(line.split(",")[0]) for line in derived.read_text(encoding="utf-8").splitlines()[1:]]
    return min(times), max(times)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    recordings, out = (pathlib.Path(p).resolve() for p in sys.argv[1:])
    out.mkdir(parents=True, exist_ok=True)
    (out / "buildings.geojson").write_text(json.dumps(buildings(recordings / "potsdamer_platz_lod2_prisms.txt"), indent=0))
    (out / "truth.csv").write_text(truth(recordings / "Berlin_Potsdamer_Platz_GT.txt"))
    first, last = covered(recordings / "derived_residuals_and_LOS.csv")
    (out / "drive.toml").write_text(f"""observations = "{recordings}/Berlin_Potsdamer_Platz.obs.gz"
navigation = ["{recordings}/brdc1580.16n"]
sp3 = ["{recordings}/gbm19001.sp3.gz"]
truth = "truth.csv"
systems = "G"
from_sow = {first}
to_sow = {last}

[scene]
file = "buildings.geojson"
undulation_m = {UNDULATION_M}

[gnss]
antenna = "patch"
tracking_threshold_dbhz = 25.0
""")
    (out / "city.toml").write_text(f"""[scene]
file = "buildings.geojson"
undulation_m = {UNDULATION_M}

# A u-blox of 2016 on a car's roof: patch antenna; a front end of some 4 MHz and half a chip are ASSUMPTIONS, for its data sheet does not
# say. 49 dB-Hz at the zenith lie between what it reported of G12 at 85 degrees (51 in the median) and of the others above 45 (38 to 44).
[gnss]
antenna = "patch"
tracking_threshold_dbhz = 25.0
correlator_spacing_chips = 0.5
front_end_mhz = 4.0
cn0_zenith_dbhz = 49.0
scatter = "none"
clutter = "none"
""")
    (out / "street.toml").write_text(f"""[scene]
file = "buildings.geojson"
undulation_m = {UNDULATION_M}

# The catalogue's u-blox of that time, with two figures taken from the log: its gain (above), and the weakest signal above the mask of 10 degrees.
[gnss]
receiver = "m8"
tracking_threshold_dbhz = 21.0
cn0_zenith_dbhz = 49.0
""")


if __name__ == "__main__":
    main()
