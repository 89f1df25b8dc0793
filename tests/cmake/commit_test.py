#!/usr/bin/env python3
"""The commit that the program is built from: of a checkout, of one with changes, of an archive, of bare files."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "cmake/commit.cmake"


def git(folder, *words):
    identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "init.defaultBranch=main"]
    return subprocess.run(["git", *identity, "-C", folder, *words], check=True, capture_output=True, text=True).stdout


class Commit(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.folder.name) / "tree"
        (self.top / "cmake").mkdir(parents=True)
        (self.top / "cmake/commit.txt").write_text("$Format:%H$\n", encoding="utf-8")
        (self.top / ".gitattributes").write_text("cmake/commit.txt export-subst\n", encoding="utf-8")

    def tearDown(self):
        self.folder.cleanup()

    def checkout(self):
        git(self.top, "init", "-q")
        git(self.top, "add", ".")
        git(self.top, "commit", "-qm", "first")
        return git(self.top, "rev-parse", "HEAD").strip()

    def told(self, source=None):
        out = pathlib.Path(self.folder.name) / "commit.cpp"
        subprocess.run(["cmake", f"-DSOURCE={source or self.top}", f"-DOUT={out}", "-P", SCRIPT], check=True)
        return re.search(r'= "(.*)";', out.read_text(encoding="utf-8"))[1]

    def test_checkout(self):
        commit = self.checkout()
        self.assertEqual(self.told(), commit)
        (self.top / "notes.txt").write_text("git does not know it", encoding="utf-8")
        self.assertEqual(self.told(), commit)
        (self.top / ".gitattributes").write_text("# changed\n", encoding="utf-8")
        self.assertEqual(self.told(), commit + "-modified")

    def test_archive(self):
        commit = self.checkout()
        other = pathlib.Path(self.folder.name) / "archive"
        other.mkdir()
        packed = subprocess.run(["git", "-C", self.top, "archive", "HEAD"], check=True, capture_output=True).stdout
        subprocess.run(["tar", "x", "-C", other], input=packed, check=True)
        self.assertEqual(self.told(other), commit)

    def test_bare_files(self):
        self.assertEqual(self.told(), "")


if __name__ == "__main__":
    if not shutil.which("git"):
        sys.exit(77)
    unittest.main()
