#!/usr/bin/env python3
"""The check of docs/licences.md on small trees: a package without a line, or with a line that says no licence, is found."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "cmake"))
import check_licences  # noqa: E402

PACKAGES = "# a list\n[build]\nlibone-dev # a reason\n\n[test]\nlibtwo-dev\nlibthree-dev\n"


class CheckLicences(unittest.TestCase):
    def missing(self, table):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs").mkdir()
            (root / "cmake").mkdir()
            (root / "docs/licences.md").write_text(table, encoding="utf-8")
            (root / "cmake/debian-packages.txt").write_text(PACKAGES, encoding="utf-8")
            return check_licences.missing(root)

    def test_all_there(self):
        self.assertEqual(self.missing("| libone-dev | x | MIT |\n| **libtwo-dev**, libthree-dev | x | BSD |\n"), [])

    def test_no_line(self):
        self.assertEqual(
            self.missing("| libone-dev | x | MIT |\nlibtwo-dev is mentioned\n| libthree-dev | x | MIT |\n"),
            ["docs/licences.md: no line for libtwo-dev"],
        )

    def test_no_licence(self):
        self.assertEqual(
            self.missing("| libone-dev | x | |\n| libtwo-dev, libthree-dev | x | MIT |\n"),
            ["docs/licences.md: no line for libone-dev"],
        )


if __name__ == "__main__":
    unittest.main()
