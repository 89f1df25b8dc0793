"""check_clang.py on a small tree: what it checks, what it leaves out, and what it says."""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "cmake" / "check_clang.py"


def check(files):
    """Exit status and lines of the script for a tree of these files (name: text), all of them compiled."""
    with tempfile.TemporaryDirectory() as folder:
        build = pathlib.Path(folder) / "build"
        commands = []
        for name, text in files.items():
            path = pathlib.Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            commands.append({"directory": str(build), "file": str(path),
                             "command": f"clang++ -std=c++20 -Wall -Werror -o {name}.o -c {path}"})
        build.mkdir(exist_ok=True)
        (build / "compile_commands.json").write_text(json.dumps(commands), encoding="utf-8")
        done = subprocess.run([sys.executable, SCRIPT, build], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()


@unittest.skipUnless(shutil.which("clang++"), "clang++ is not installed")
class CheckClang(unittest.TestCase):
    def test_a_good_file_passes(self):
        self.assertEqual(check({"core/a.cpp": "int main() {}\n"}), (0, ["clang: 1 files, no warning"]))

    def test_a_warning_is_an_error_and_is_shown(self):
        status, lines = check({"core/a.cpp": "int main() {}\n", "gnss/b.cpp": "void f() { int unused = 1; }\n"})
        self.assertEqual((status, lines[-1]), (1, "clang: 2 files, 1 with errors"))
        self.assertIn("unused variable 'unused'", lines[0])

    def test_tests_and_what_the_build_makes_are_left_out(self):
        wrong = "void f() { int unused = 1; }\n"
        files = {"core/a.cpp": "int main() {}\n", "tests/core/a_test.cpp": wrong, "build/generated/c.cpp": wrong}
        self.assertEqual(check(files), (0, ["clang: 1 files, no warning"]))

    def test_nothing_to_check_is_no_success(self):
        self.assertEqual(check({"tests/core/a_test.cpp": "int main() {}\n"})[0], 1)


if __name__ == "__main__":
    unittest.main()
