"""cmake/steps.sh: the package list's sections, the progress that is shown, and the count of skipped tests."""

import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def steps(commands, given=""):
    """Runs bash commands after steps.sh; returns exit status, stdout, stderr."""
    script = f'set -euo pipefail; root="{ROOT}"; . "$root/cmake/steps.sh"; {commands}'
    done = subprocess.run(["bash", "-c", script], input=given, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


class Steps(unittest.TestCase):
    def test_sections_of_the_package_list(self):
        build = steps("packages build")[1].split()
        test = steps("packages test")[1].split()
        self.assertIn("libembree-dev", build)
        self.assertIn("libgtest-dev", test)
        self.assertFalse(set(build) & set(test))
        self.assertEqual(steps("packages build test")[1].split(), build + test)
        self.assertEqual(steps("packages nowhere")[:2], (0, ""))

    def test_progress_of_a_build_is_told_by_quarters_and_logged_in_full(self):
        lines = ["ninja: Entering directory"] + [f"[{i}/8] Building CXX object {i}" for i in range(1, 9)]
        with tempfile.TemporaryDirectory() as folder:
            status, out, err = steps(f'show_progress building "{folder}/log"', "\n".join(lines) + "\n")
            log = (pathlib.Path(folder) / "log").read_text(encoding="utf-8").splitlines()
        self.assertEqual((status, out), (0, ""))
        self.assertEqual(err.splitlines(), [f"-- building: {p} %" for p in (25, 50, 75, 100)])
        self.assertEqual(log, lines)

    def test_nothing_to_do_says_nothing(self):
        lines = "[0/1] Re-checking globbed directories...\nninja: no work to do.\n"
        self.assertEqual(steps("show_progress building /dev/null", lines), (0, "", ""))

    def test_a_failed_build_names_the_error_and_exits_1(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "log"
            log.write_text("a\nx.cpp:3:1: error: 'y' was not declared\n" + "note\n" * 30, encoding="utf-8")
            status, out, err = steps(f'fail "the build failed" "{log}"')
        self.assertEqual((status, out), (1, ""))
        self.assertEqual(err.splitlines()[0], "x.cpp:3:1: error: 'y' was not declared")
        self.assertEqual(err.splitlines()[-1], "error: the build failed")

    def test_skipped_tests_are_counted_before_the_closing_lines(self):
        head = "1/3 Test #1: A.B ...   Passed    0.00 sec\n"
        closing = "100% tests passed, 0 tests failed out of 3\n\nTotal Test time (real) =   0.02 sec\n"
        skipped = "\nThe following tests did not run:\n\t  2 - A.C (Skipped)\n"
        self.assertEqual(steps("count_skipped", head + closing)[1], head + "0 tests skipped\n" + closing)
        self.assertEqual(
            steps("count_skipped", head + closing + skipped)[1],
            head + "1 test skipped: A.C\n" + closing + skipped)
        self.assertIn(
            "\n2 tests skipped: A.C, A.D\n100%",
            steps("count_skipped", head + closing + skipped + "\t  3 - A.D (Skipped)\n")[1])

    def test_ctest_status_survives_the_pipe(self):
        self.assertEqual(steps("status=0; (echo x; exit 8) | count_skipped || status=$?; exit $status")[0], 8)


if __name__ == "__main__":
    unittest.main()
