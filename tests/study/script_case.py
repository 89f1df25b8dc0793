"""A study script as it is typed, with a program in canyon's place."""
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

STUDY = pathlib.Path(__file__).resolve().parents[2] / "study"


class ScriptCase(unittest.TestCase):
    """A class of its own names the script, and the program: its text, with {calls}, a file for its command lines, and {status}, what it ends with."""

    SCRIPT = PROGRAM = ""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        self.make_canyon(0)

    def tearDown(self):
        self.folder.cleanup()

    def make_canyon(self, status):
        (self.root / "canyon").write_text(self.PROGRAM.format(calls=self.root / "calls", status=status), encoding="utf-8")
        (self.root / "canyon").chmod(stat.S_IRWXU)

    def call(self, *arguments):
        return subprocess.run([sys.executable, STUDY / self.SCRIPT, *arguments], capture_output=True, text=True, check=False)
