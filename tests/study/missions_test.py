#!/usr/bin/python3
"""study/missions.py: its rows done by hand, what it does about data that are not there, and the whole of it with a program in canyon's place."""
import json
import pathlib
import sys
import tempfile
import unittest

STUDY = pathlib.Path(__file__).resolve().parents[2] / "study"
sys.dont_write_bytecode = True
sys.path.insert(0, str(STUDY))
import missions  # noqa: E402
from script_case import ScriptCase  # noqa: E402

# Errs by as many metres as its seed says; of even seeds it is stuck.
CANYON = '''#!/usr/bin/env python3
import json, pathlib, sys
pathlib.Path(r"{calls}").open("a").write(" ".join(sys.argv[1:]) + "\\n")
if "{status}" != "0":
    sys.exit("no such mission")
seed = int(sys.argv[sys.argv.index("--seed") + 1])
pathlib.Path(sys.argv[sys.argv.index("--out") + 1]).mkdir()
print(json.dumps({{"runs": [{{"fidelity": name, "outcome": "stuck" if seed % 2 == 0 else "success", "position_error_rms_m": seed}}
                            for name in sys.argv[sys.argv.index("--fidelities") + 1].split(",")]}}))
'''


def run(outcome, error_m):
    return {"outcome": outcome, "position_error_rms_m": error_m}


class Rows(unittest.TestCase):
    def test_a_row_says_how_many_succeed_how_others_end_and_the_median(self):
        seen = [run("success", 1.0), run("stuck", 9.0), run("collision", 2.0), run("stuck", 3.0)]
        # Wilson 1927 by hand: (1 + z^2 / 2 -+ z sqrt(1 * 3 / 4 + z^2 / 4)) / (4 + z^2), z^2 = 3.8415.
        self.assertEqual(missions.row("street", "high", seen), "| street | `high` | 1 of 4 (0.05 to 0.70) | collision 1, stuck 2 | 2.50 m |")
        self.assertEqual(missions.row("street", "low", [run("success", 0.25)] * 20), "| street | `low` | 20 of 20 (0.84 to 1.00) |  | 0.25 m |")

    def test_a_mission_stands_beside_its_data_or_is_left_out(self):
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            (root / "work").mkdir()
            (root / "cities/far/away").mkdir(parents=True)
            (root / "cities/far/away/town.gml").write_text("houses", encoding="utf-8")
            plain, town = root / "plain.toml", root / "town.toml"
            plain.write_text('base = "vicksburg"\n', encoding="utf-8")
            town.write_text('[scene]\nfile = "data/town.gml"\n', encoding="utf-8")
            self.assertEqual(missions.prepared(plain, root / "work", None), plain)
            self.assertIsNone(missions.prepared(town, root / "work", None))
            self.assertIsNone(missions.prepared(town, root / "work", root / "work"))
            for _ in range(2):  # where an earlier call has been, too
                file = missions.prepared(town, root / "work", root / "cities")
                self.assertEqual(file, root / "work/town/town.toml")
                self.assertEqual(file.read_text(encoding="utf-8"), town.read_text(encoding="utf-8"))
                self.assertEqual((file.parent / "data/town.gml").read_text(encoding="utf-8"), "houses")


class Script(ScriptCase):
    SCRIPT, PROGRAM = "missions.py", CANYON

    def test_help(self):
        done = self.call("--help")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("--cities", done.stdout)

    def test_a_table_of_the_missions_that_are_asked_for(self):
        arguments = ["--canyon", self.root / "canyon", "--only", "vicksburg", "--fidelities", "low,high", "--seeds", "1-4", "--keep", self.root / "kept"]
        done = self.call(*arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout.splitlines()[2:], ["| vicksburg | `low` | 2 of 4 (0.15 to 0.85) | stuck 2 | 2.50 m |",
                                                        "| vicksburg | `high` | 2 of 4 (0.15 to 0.85) | stuck 2 | 2.50 m |"])
        calls = (self.root / "calls").read_text(encoding="utf-8").splitlines()
        self.assertEqual(len(calls), 4, "the fidelities of a seed together")
        # What is kept is not driven again.
        self.assertEqual(self.call(*arguments).stdout, done.stdout)
        self.assertEqual((self.root / "calls").read_text(encoding="utf-8").splitlines(), calls)
        self.assertEqual(len(json.loads((self.root / "kept/vicksburg-3.json").read_text())), 2)

    def test_all_that_needs_no_city_is_driven_and_the_rest_is_told(self):
        done = self.call("--canyon", self.root / "canyon", "--fidelities", "low", "--seeds", "1")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        *rows, blank, missing = done.stdout.splitlines()[2:]
        self.assertEqual(blank, "")
        self.assertTrue(missing.startswith("Not driven, as their buildings are not there (--cities): "), missing)
        told = {row.split("|")[1].strip() for row in rows} | set(missing.rstrip(".").split(": ", 1)[1].split(", "))
        self.assertEqual(told, {file.stem for file in (STUDY.parent / "missions").rglob("*.toml")} - {"fidelities"})

    def test_what_canyon_says_is_passed_on(self):
        self.make_canyon(2)
        done = self.call("--canyon", self.root / "canyon", "--only", "vicksburg", "--seeds", "1")
        self.assertEqual((done.returncode, done.stderr), (1, "vicksburg, seed 1: no such mission\n\n"))


if __name__ == "__main__":
    unittest.main()
