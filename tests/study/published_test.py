#!/usr/bin/env python3
"""study/published.py on small trees, with a program in canyon's place that prints what is asked of it."""
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "study" / "published.py"

CANYON = '''#!/usr/bin/env python3
import json, pathlib, sys
pathlib.Path(r"{calls}").open("a").write(" ".join(sys.argv[1:]) + "\\n")
if sys.argv[1] == "keys":
    print("| key |\\n|---|")
    sys.exit(0)
if "broken" in sys.argv:
    sys.exit(1)
if sys.argv[1] == "plan":
    print(json.dumps({{"mission": "small", "planned_cpu_s": 14.4, "tolerances": [{{"bound": 0.25}}]}}))
    sys.exit(0)
if sys.argv[1] == "tradeoff":
    out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
    out.mkdir()
    (out / "summary.json").write_text(json.dumps({{
        "mission": "small", "fidelities": [{{"fidelity": "high_planned", "closed_loop": {{"success": 2}}}}],
        "ladders": [{{"key": "gnss.paths", "probe": "pseudorange", "models": [{{"name": "0.5", "error": 1.25, "cpu_s": 0.003}}]}},
                    {{"key": "gnss.paths", "probe": "fix", "models": [{{"name": "none", "error": 7.5}}]}}]}}))
    print("whole")
    sys.exit(0)
error = {error}
runs = [{{"fidelity": "low", "seed": seed, "error_m": error + seed, "outcome": "success", "gdop": None,
         "timing": {{"cpu_s": 3.25, "parts": [{{"name": "GNSS", "cpu_s": 1.5}}]}}}} for seed in (1, 2)]
out = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
out.mkdir()
(out / "summary.json").write_text(json.dumps({{
    "mission": {{"seed": 1}}, "runs": runs, "shares": [{{"fidelity": "low", "success": 2, "n": 2}}],
    "loop": {{"kind": "open", "paired_epochs": [{{"b": "high", "low_m": 3.84}}]}},
    "paired": [{{"b": "high", "figure": "error_m", "p": 0.25}}, {{"b": "high", "figure": "gdop", "p": 0.5}}],
    "over_seeds": [{{"fidelity": "low", "figures": {{"error_m": {{"median": 2.0}}}}}}]}}))
print("Mission small\\n\\n      low\\nclosed loop\\n  error, m  " + str(error + 1) + "\\n\\n2 x 2\\n  a b\\n\\nDriven in 3 s.")
'''

ENTRIES = '''
[command.one]
arguments = ["compare", "--seeds", "20"]
mission = "base = 1"
[command.list]
arguments = ["keys"]
[text.number]
command = "one"
text = "{low.error_m:.2f} m, {share.low.success} of {share.low.n}, {against.high.low_m:.1f}, {median.low.error_m:.0f}, {paired.high.error_m.p:.2f}, {low.gdop:.1f}, {low.outcome}"
[text.block]
command = "one"
paragraphs = ["closed loop", "2 x 2"]
[text.cost]
command = "one"
text = "{low.timing.cpu_s} s, {low.part.GNSS} of them for GNSS"
timing = true
[text.list]
command = "list"
stdout = true
'''

README = """It is <!-- canyon:number -->?<!-- /canyon:number --> off and takes <!-- canyon:cost -->?<!-- /canyon:cost -->.
<!-- canyon:block -->
<!-- /canyon:block -->
"""
OTHER_VERBS = '''
[command.errors]
arguments = ["tradeoff", "--part", "gnss"]
[command.left]
arguments = ["plan", "--json"]
[text.errors]
command = "errors"
text = "{whole.high_planned.closed_loop.success} {ladder.gnss_paths.pseudorange.0_5.error_milli:.0f} {ladder.gnss_paths.pseudorange.0_5.cpu_ms:.1f} {ladder.gnss_paths.fix.none.error:.1f}"
[text.left]
command = "left"
text = "{planned_cpu_s:.1f} s, {tolerances.0.bound:.2f} m"
'''
OTHER_PAGE = "<!-- canyon:errors --><!-- /canyon:errors --> <!-- canyon:left --><!-- /canyon:left -->\n"
PAGE = "<!-- canyon:list -->\n<!-- /canyon:list -->\n"


class Published(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        (self.root / "study").mkdir()
        (self.root / "docs").mkdir()
        self.write("study/published.toml", ENTRIES)
        self.write("README.md", README)
        self.write("docs/page.md", PAGE)
        self.make_canyon(0.146)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name, text):
        (self.root / name).write_text(text, encoding="utf-8")

    def read(self, name):
        return (self.root / name).read_text(encoding="utf-8")

    def make_canyon(self, error):
        self.write("canyon", CANYON.format(error=error, calls=self.root / "calls"))
        (self.root / "canyon").chmod(stat.S_IRWXU)

    def call(self, *arguments):
        return subprocess.run([sys.executable, str(SCRIPT), "--root", str(self.root), "--canyon", str(self.root / "canyon"),
                               *arguments], capture_output=True, text=True, check=False)

    def mistake(self, line, *arguments):
        done = self.call(*arguments)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(done.stderr.splitlines()[-1], line)

    def test_writes_numbers_blocks_and_lists_between_their_markers(self):
        self.assertEqual(self.call().returncode, 0)
        self.assertEqual(self.read("README.md"), """\
It is <!-- canyon:number -->1.15 m, 2 of 2, 3.8, 2, 0.25, undefined, success<!-- /canyon:number --> off and takes <!-- canyon:cost -->3.25 s, 1.5 of them for GNSS<!-- /canyon:cost -->.
<!-- canyon:block -->
```
      low
closed loop
  error, m  1.146

2 x 2
  a b
```
<!-- /canyon:block -->
""")
        self.assertEqual(self.read("docs/page.md"), "<!-- canyon:list -->\n| key |\n|---|\n<!-- /canyon:list -->\n")
        # One call for all that a command gives; the mission beside it.
        self.assertEqual(sorted(self.read("calls").splitlines()), ["compare mission.toml --seeds 20 --out results", "keys"])

    def test_what_tradeoff_and_json_tell(self):
        self.write("study/published.toml", OTHER_VERBS)
        self.write("README.md", "")
        self.write("docs/page.md", OTHER_PAGE)
        self.assertEqual(self.call().returncode, 0)
        self.assertEqual(self.read("docs/page.md"), "<!-- canyon:errors -->2 1250 3.0 7.5<!-- /canyon:errors --> "
                                                    "<!-- canyon:left -->14.4 s, 0.25 m<!-- /canyon:left -->\n")
        self.assertEqual(sorted(self.read("calls").splitlines()), ["plan --json", "tradeoff --part gnss --out results"])

    def test_a_script_is_called_in_canyons_place_and_told_where_it_is(self):
        self.write("study/table.py", "import sys; print(' '.join(sys.argv[1:]))")
        self.write("study/published.toml", """
[command.table]
script = "study/table.py"
arguments = ["--seeds", "20"]
[text.table]
command = "table"
stdout = true
""")
        self.write("README.md", "")
        self.write("docs/page.md", "<!-- canyon:table --><!-- /canyon:table -->\n")
        self.assertEqual(self.call("--seeds", "3").returncode, 0)
        self.assertEqual(self.read("docs/page.md"),
                         f"<!-- canyon:table -->\n--canyon {self.root.resolve() / 'canyon'} --seeds 3\n<!-- /canyon:table -->\n")

    def test_what_was_written_is_found_again(self):
        self.call()
        before = self.read("README.md")
        self.assertEqual(self.call("--check").returncode, 0)
        self.assertEqual(self.read("README.md"), before)
        self.call()
        self.assertEqual(self.read("README.md"), before)

    def test_a_number_that_changed_is_told_and_not_written(self):
        self.call()
        before = self.read("README.md")
        self.make_canyon(0.152)
        done = self.call("--check")
        self.assertEqual(done.returncode, 1)
        self.assertIn("README.md: canyon:block says", done.stdout)
        self.assertEqual(done.stdout.count(" says\n"), 1, "1.15 m is still 1.15 m, and times are not compared")
        self.assertEqual(self.read("README.md"), before)

    def test_a_tenth_is_drawn_by_its_seed_and_never_of_times(self):
        self.call()
        drawn = {seed: self.call("--check", "--tenth", str(seed)).stderr.splitlines()[0] for seed in range(12)}
        self.assertEqual(drawn[5], self.call("--check", "--tenth", "5").stderr.splitlines()[0])
        self.assertEqual({line.split(": ")[1] for line in drawn.values()}, {"number", "block", "list"})
        self.assertEqual(self.call("--check", "--tenth", "today").returncode, 0)

    def test_only_and_fewer_seeds(self):
        self.assertEqual(self.call("--only", "number", "--seeds", "3").returncode, 0)
        self.assertEqual(self.read("calls"), "compare mission.toml --seeds 3 --out results\n")
        self.assertEqual(self.read("docs/page.md"), PAGE)

    def test_mistakes(self):
        self.mistake('--tenth: "x", expected a whole number or today', "--check", "--tenth", "x")
        self.mistake('--only: "nmber" is not in published.toml, expected one of block, cost, list, number', "--only", "nmber")
        self.mistake("--check: nothing to compare: the texts chosen depend on the machine", "--check", "--only", "cost")
        self.mistake("--check: nothing to compare: the texts chosen depend on the machine", "--check", "--tenth", "1", "--only", "cost")
        self.mistake("--canyon: /no/canyon: No such file or directory", "--canyon", "/no/canyon")
        self.write("study/published.toml", ENTRIES.replace("{low.outcome}", "{low.outcome:.1f}"))
        self.mistake("published.toml: text.number: {low.outcome:.1f}: Unknown format code 'f' for object of type 'str'", "--only", "number")
        self.write("study/published.toml", ENTRIES)
        self.write("docs/page.md", PAGE + "<!-- canyon:block -->")
        self.mistake("docs/page.md:3: <!-- canyon:block --> without its other half", "--markers")
        self.write("docs/page.md", PAGE + "<!-- canyon:new -->1<!-- /canyon:new -->")
        self.mistake("docs/page.md: marker canyon:new has no entry text.new in study/published.toml", "--markers")
        self.write("docs/page.md", "nothing")
        self.mistake("published.toml: text.list: no page has its marker", "--markers")
        self.write("docs/page.md", PAGE)
        self.write("study/published.toml", ENTRIES.replace("low.error_m:.2f", "low.eror_m:.2f"))
        self.mistake('published.toml: text.number: {low.eror_m}: the results have no "eror_m"')
        self.write("study/published.toml", ENTRIES.replace('"closed loop"', '"open loop"'))
        self.mistake('published.toml: text.block: 0 paragraphs of what was printed begin with "open loop"')
        self.write("study/published.toml", ENTRIES.replace('"--seeds", "20"', '"broken"'))
        self.mistake("command.one: canyon compare mission.toml broken --out results ended with status 1")


if __name__ == "__main__":
    unittest.main()
