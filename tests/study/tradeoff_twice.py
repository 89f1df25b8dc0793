#!/usr/bin/env python3
"""tradeoff_twice.py CANYON [ARGUMENT...]: calls `canyon tradeoff ARGUMENT...` twice and compares the fronts.

Exit status 1 if a model that is on the front in one and not in the other was tied with none in either: then the spreads that the
verb gives do not say how far its times move. It also says how many models changed, and how many of those the first call had
marked. Errors and work must be the same to the last digit.
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


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    first, second = (measured(sys.argv[1], sys.argv[2:]) for _ in range(2))
    if first.keys() != second.keys():
        sys.exit(f"other models: {sorted(map(str, first.keys() ^ second.keys()))}")
    other = [key for key in first for figure in ("error", "work") if first[key][figure] != second[key][figure]]
    changed = [key for key in first if first[key]["on_front"] != second[key]["on_front"]]
    told = [key for key in changed if first[key]["tied_with"]]
    untold = [key for key in changed if not first[key]["tied_with"] and not second[key]["tied_with"]]
    print(f"{len(first)} models: {len(changed)} changed places on the front, {len(told)} of them were tied in the first call, "
          f"{len(untold)} in neither; {len(other)} with another error or work")
    for key in changed:
        print("  " + " ".join(str(part) for part in key if part) + f": {1e3 * first[key]['cpu_s']:.4g} and {1e3 * second[key]['cpu_s']:.4g} ms per s"
              + (", tied" if key not in untold else ", NOT TIED"))
    for key in other:
        print("  " + " ".join(str(part) for part in key if part) + ": another error or work")
    return 1 if untold or other else 0


if __name__ == "__main__":
    sys.exit(main())
