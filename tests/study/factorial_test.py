#!/usr/bin/python3
"""study/factorial.py: its arithmetic on tables that can be done by hand, and the whole of it with a program in canyon's place."""
import itertools
import json
import pathlib
import sys
import tomllib
import unittest

STUDY = pathlib.Path(__file__).resolve().parents[2] / "study"
sys.dont_write_bytecode = True
sys.path.insert(0, str(STUDY))
import factorial  # noqa: E402
from script_case import ScriptCase  # noqa: E402

# Successes of four seeds by what is there: blockage, reflections, drift.
TABLE = {"f000": 4, "f001": 4, "f010": 3, "f011": 2, "f100": 2, "f101": 1, "f110": 1, "f111": 0}

# All that it is asked for succeeds without blockage, and collides with it.
CANYON = '''#!/usr/bin/env python3
import json, pathlib, sys
pathlib.Path(r"{calls}").open("a").write(" ".join(sys.argv[1:]) + "\\n")
if "{status}" != "0":
    sys.exit("no such mission")
asked = sys.argv[sys.argv.index("--fidelities") + 1].split(",")
pathlib.Path(sys.argv[sys.argv.index("--out") + 1]).mkdir()
print(json.dumps({{"runs": [{{"fidelity": name, "outcome": "success" if name[1] == "0" else "collision",
                              "failure": None if name[1] == "0" else {{"seen": {{"in_scans_s": 1.5}}}}}} for name in asked]}}))
'''


def seeds_with(table):
    """Four seeds, of which each setting succeeds with so many."""
    return [{name: {"outcome": "success" if k < count else "collision", "seen_s": None} for name, count in table.items()} for k in range(4)]


class Arithmetic(unittest.TestCase):
    def assert_interval(self, found, low, high):
        self.assertEqual([round(end, 3) for end in found], [low, high])

    def test_wilsons_interval(self):
        self.assert_interval(factorial.wilson(0, 20), 0.0, 0.161)
        self.assert_interval(factorial.wilson(20, 20), 0.839, 1.0)
        # Wilson 1927 by hand: (5 + z^2 / 2 -+ z sqrt(5 * 15 / 20 + z^2 / 4)) / (20 + z^2), z^2 = 3.8415.
        self.assert_interval(factorial.wilson(5, 20), 0.112, 0.469)
        for n in range(1, 30):
            for successes in range(n + 1):
                low, high = factorial.wilson(successes, n)
                a_few_roundings = 1e-15  # of numbers below 1
                self.assertTrue(0.0 <= low <= successes / n + a_few_roundings, (successes, n))
                self.assertTrue(successes / n - a_few_roundings <= high <= 1.0, (successes, n))
                # Of failures it is the same, mirrored.
                self.assertAlmostEqual(low, 1.0 - factorial.wilson(n - successes, n)[1], delta=a_few_roundings)

    def test_effects_are_those_done_by_hand(self):
        # Shares in eighths and quarters: every sum is exact.
        by_hand = {"blockage": ((2 - 4) + (1 - 4) + (1 - 3) + (0 - 2)) / 16,
                   "reflections": ((3 - 4) + (2 - 4) + (1 - 2) + (0 - 1)) / 16,
                   "drift": ((4 - 4) + (2 - 3) + (1 - 2) + (0 - 1)) / 16,
                   # Half of: blockage's effect among reflections, less that without.
                   "blockage x reflections": (((1 - 3) + (0 - 2)) / 8 - ((2 - 4) + (1 - 4)) / 8) / 2,
                   "blockage x drift": (((1 - 4) + (0 - 2)) / 8 - ((2 - 4) + (1 - 3)) / 8) / 2,
                   "reflections x drift": (((2 - 4) + (0 - 1)) / 8 - ((3 - 4) + (1 - 2)) / 8) / 2,
                   # Half of: the interaction of the first two with drift, less that without.
                   "blockage x reflections x drift": ((((0 - 2) - (1 - 4)) / 4) / 2 - (((1 - 3) - (2 - 4)) / 4) / 2) / 2}
        seeds = seeds_with(TABLE)
        found = {label: factorial.effect(weights, seeds) for label, weights in factorial.contrasts().items()}
        self.assertEqual(found, by_hand)
        self.assertEqual(found["blockage"], -0.5625)

    def test_contrasts_see_one_effect_each(self):
        contrasts = factorial.contrasts()
        self.assertEqual(len(contrasts), 7)
        for label, weights in contrasts.items():
            self.assertEqual(sum(weights.values()), 0.0, label)
            for other, others in contrasts.items():
                self.assertEqual(sum(weights[name] * others[name] for name in weights), 0.5 if label == other else 0.0, (label, other))
        only_drift = seeds_with({name: 0 if name[3] == "1" else 4 for name in TABLE})
        self.assertEqual({label for label, weights in contrasts.items() if factorial.effect(weights, only_drift) != 0.0}, {"drift"})

    def test_intervals_are_of_whole_seeds(self):
        # What every seed says alike is sure, however few they are; what half of them say is anything from none to all.
        alike = [seeds_with(TABLE)[2]] * 4
        weights = factorial.contrasts()["blockage"]
        self.assertEqual(factorial.interval(lambda drawn: factorial.effect(weights, drawn), alike, draws=100), (factorial.effect(weights, alike),) * 2)
        halves = seeds_with({name: 4 if name[1] == "0" else 2 for name in TABLE})
        self.assertEqual(factorial.interval(lambda drawn: factorial.effect(weights, drawn), halves, draws=1000), (-1.0, 0.0))

    def test_seeds_are_a_range_or_one(self):
        self.assertEqual(list(factorial.seeds_of("3-5")), [3, 4, 5])
        self.assertEqual(list(factorial.seeds_of("7")), [7])

    def test_the_mission_has_every_setting(self):
        tree = tomllib.loads(factorial.mission("high_aided", factorial.REMEDIES))
        names = [factorial.name_of(there) for there in itertools.product((False, True), repeat=3)]
        self.assertEqual(list(tree["fidelity"]), names + [f"r{k}" for k in range(len(factorial.REMEDIES))])
        self.assertEqual(tree["fidelity"]["f111"], {"base": "high_aided"})
        self.assertEqual(tree["fidelity"]["f011"], {"base": "high_aided", "gnss": {"hidden_signals": "in_sight"}})
        self.assertEqual(tree["fidelity"]["f000"], {"base": "high_aided", "gnss": {"hidden_signals": "in_sight", "multipath_scale": 0.0},
                                                    "imu": {"errors": "none"}})
        self.assertEqual(tree["fidelity"]["r5"], {"base": "modern"})

    def test_controls_drop_and_parts_lack_one_each(self):
        tree = tomllib.loads(factorial.mission("high", factorial.CONTROLS | factorial.PARTS))["fidelity"]
        dropped = {"multipath_scale": 0.0, "hidden_signals": "dropped"}
        self.assertEqual([tree["r0"], tree["r1"]], [{"base": "high", "gnss": dropped, "imu": {"errors": "none"}}, {"base": "high", "gnss": dropped}])
        states = ["biases", "gains", "mounting", "wheel_scale", "fix_error", "velocity_error"]
        measurements = ["position", "velocity", "non_holonomic", "standstill"]
        gone = [({"fix_error"}, set()), ({"velocity_error"}, {"velocity"}), (set(), {"non_holonomic"}), (set(), {"standstill"})]
        for k, (of_states, of_measurements) in enumerate(gone):
            self.assertEqual(tree[f"r{k + 2}"], {"base": "high", "fusion": {
                "filter": "vehicle", "states": [s for s in states if s not in of_states],
                "measurements": [m for m in measurements if m not in of_measurements]}})


class Script(ScriptCase):
    SCRIPT, PROGRAM = "factorial.py", CANYON

    def test_help(self):
        done = self.call("--help")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("--seeds FIRST-LAST", done.stdout)

    def test_a_table_of_shares_and_one_of_effects(self):
        arguments = ["--canyon", self.root / "canyon", "--seeds", "4-5", "--keep", self.root / "kept"]
        done = self.call(*arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        lines = done.stdout.splitlines()
        self.assertIn("| none of the three | 2 of 2 | 0.34 to 1.00 |  |", lines)
        self.assertIn("| blockage, drift | 0 of 2 | 0.00 to 0.66 | collision 2 |", lines)
        self.assertIn("| blockage | -1.00 | -1.00 to -1.00 |", lines)
        self.assertIn("| reflections x drift | +0.00 | +0.00 to +0.00 |", lines)
        self.assertEqual(lines[-1], "Of 16 runs 8 collide, 8 with what had stood in the scans for over a second.")
        calls = (self.root / "calls").read_text(encoding="utf-8").splitlines()
        self.assertEqual([call.split(" --seed ")[1].split()[0] for call in calls], ["4", "5"])
        # What is kept is not driven again.
        self.assertEqual(self.call(*arguments).stdout, done.stdout)
        self.assertEqual((self.root / "calls").read_text(encoding="utf-8").splitlines(), calls)
        self.assertEqual(json.loads((self.root / "kept/high-4.json").read_text())["f100"], {"outcome": "collision", "seen_s": 1.5})

    def test_controls_and_parts_stand_beside_the_eight(self):
        # r0 to r5; in canyon's place all but r0 collide. Wilson's interval of 1 of 1 begins at 1 / (1 + 3.84).
        arguments = ["--canyon", self.root / "canyon", "--seeds", "4", "--keep", self.root / "kept"]
        plain = self.call(*arguments)
        self.assertEqual((plain.returncode, plain.stderr), (0, ""))
        self.assertNotIn("dropped", plain.stdout)
        done = self.call(*arguments, "--controls", "--parts")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        lines = done.stdout.splitlines()
        own = lines[10:16]
        self.assertEqual(own[0], "| blockage, hidden signals dropped | 1 of 1 | 0.21 to 1.00 |  |")
        rest = ["blockage, hidden signals dropped, drift"] + [f"all, `vehicle` filter, no odometer, no `{part}`"
                                                              for part in ("fix_error", "velocity", "non_holonomic", "standstill")]
        self.assertEqual(own[1:], [f"| {label} | 0 of 1 | 0.00 to 0.79 | collision 1 |" for label in rest])
        self.assertEqual(lines[-1], "Of 14 runs 9 collide, 9 with what had stood in the scans for over a second.")
        # The eight are kept, so only the six are driven; what they are is in the mission that canyon is given.
        calls = (self.root / "calls").read_text(encoding="utf-8").splitlines()
        self.assertEqual([call.split(" --fidelities ")[1].split()[0] for call in calls],
                         ["f000,f001,f010,f011,f100,f101,f110,f111", "r0,r1,r2,r3,r4,r5"])
        given = pathlib.Path(calls[1].split()[1])
        self.assertEqual(given.read_text(encoding="utf-8"), factorial.mission("high", factorial.CONTROLS | factorial.PARTS))

    def test_what_canyon_says_is_passed_on(self):
        self.make_canyon(2)
        done = self.call("--canyon", self.root / "canyon", "--seeds", "1")
        self.assertEqual((done.returncode, done.stderr), (1, "seed 1: no such mission\n\n"))


if __name__ == "__main__":
    unittest.main()
