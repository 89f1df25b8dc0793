#!/usr/bin/env python3
"""tradeoff_twice.py CANYON [ARGUMENT...]: calls `canyon tradeoff ARGUMENT...` twice and compares the fronts.

Exit status 1 if a model is on the front in one and not in the other, and the first call had not marked it as tied with every
model that dominates it where it is not: then the spreads that the verb gives do not say how far its times move. Errors and work must
be the same to the last digit.
"""
import json
import subprocess
import sys
import tempfile


def measured(canyon, arguments):
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([canyon, "tradeoff", *arguments, "--json", "--out", f"{folder}/out"], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"canyon tradeoff {' '.join(arguments)} ended with status {done.returncode}")
    return {(ladder["part"], ladder["key"], ladder["of"], ladder["probe"], model["name"]): model
            for ladder in json.loads(done.stdout)["ladders"] for model in ladder["models"]}


def dominates(a, b):
    """As mark_front of study/tradeoff/measuring/front.cpp."""
    which = "common_error" if a["common_error"] is not None and b["common_error"] is not None else "error"
    if a[which] is None or b[which] is None:
        return False
    return (a[which] <= b[which] and a["cpu_s"] <= b["cpu_s"] and a["undefined_share"] <= b["undefined_share"]
            and (a[which] < b[which] or a["cpu_s"] < b["cpu_s"]))


def untied(key, first, second):
    """The models that dominate this one in the call in which it is not on the front, and that the first call does not say it is tied with."""
    off = second if first[key]["on_front"] else first
    rivals = [other for other in off if other[:-1] == key[:-1] and other != key and dominates(off[other], off[key])]
    return [other for other in rivals if other[-1] not in first[key]["tied_with"]]


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    first, second = (measured(sys.argv[1], sys.argv[2:]) for _ in range(2))
    if first.keys() != second.keys():
        sys.exit(f"other models: {sorted(map(str, first.keys() ^ second.keys()))}")
    other = [key for key in first for figure in ("error", "work") if first[key][figure] != second[key][figure]]
    changed = [key for key in first if first[key]["on_front"] != second[key]["on_front"]]
    untold = [key for key in changed if untied(key, first, second)]
    print(f"{len(first)} models: {len(changed)} changed places on the front, {len(untold)} of them without a tie in the first call with what "
          f"dominates them in the other; {len(other)} with another error or work")
    for key in changed:
        print("  " + " ".join(str(part) for part in key if part) + f": {1e3 * first[key]['cpu_s']:.4g} and {1e3 * second[key]['cpu_s']:.4g} ms per s"
              + (", tied" if key not in untold else ", NOT TIED"))
    for key in other:
        print("  " + " ".join(str(part) for part in key if part) + ": another error or work")
    return 1 if untold or other else 0


if __name__ == "__main__":
    sys.exit(main())
