#!/usr/bin/env python3
"""install_test.py BUILD_FOLDER: what `cmake --install` makes is used by a program that is not ours, from a folder that it was not
installed in. The program reads RINEX, and neither it nor what it links knows of scenes."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1))


def run(*words, **keywords):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **keywords)
    if done.returncode != 0:
        raise AssertionError(f"{words}: exit status {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.top = pathlib.Path(cls.folder.name)
        run("cmake", "--install", BUILD, "--prefix", cls.top / "first")
        cls.prefix = cls.top / "moved"
        (cls.top / "first").rename(cls.prefix)
        cls.canyon = cls.prefix / "bin" / "canyon"
        run(cls.canyon, "gnss", "simulate", "--at", "52.5,13.4,80", "--start", "2020-06-01", "--duration", "10", "--rate", "1",
            "--errors", "none", "--rinex-obs", cls.top / "a.obs", "--rinex-nav", cls.top / "a.nav")
        cls.scene = cls.top / "square.geojson"
        cls.scene.write_text(
            '{"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25833"}}, "features": '
            '[{"type": "Feature", "properties": {"height": 10}, "geometry": {"type": "Polygon", "coordinates": '
            "[[[390000, 5820000], [390020, 5820000], [390020, 5820020], [390000, 5820020], [390000, 5820000]]]}}]}",
            encoding="utf-8")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def example(self, package="canyon REQUIRED COMPONENTS gnss", after=""):
        """The example configured, with another find_package and further lines at its end."""
        source = self.top / "example"
        shutil.rmtree(source, ignore_errors=True)
        shutil.copytree(SOURCE / "examples" / "positions_from_rinex", source)
        text = (source / "CMakeLists.txt").read_text(encoding="utf-8")
        (source / "CMakeLists.txt").write_text(text.replace("canyon REQUIRED COMPONENTS gnss", package) + after, encoding="utf-8")
        return subprocess.run(["cmake", "-S", source, "-B", source / "build", "-DCMAKE_BUILD_TYPE=Release",
                               f"-DCMAKE_PREFIX_PATH={self.prefix}"], capture_output=True, text=True, check=False)

    def test_a_reader_of_rinex_links_no_scene(self):
        done = self.example()
        self.assertEqual(done.returncode, 0, done.stderr)
        built = self.top / "example" / "build"
        run("cmake", "--build", built)
        program = built / "positions_from_rinex"
        lines = run(program, self.top / "a.obs", self.top / "a.nav").splitlines()
        # The verb solves the same files with the same defaults.
        run(self.canyon, "gnss", "solve", "--obs", self.top / "a.obs", "--nav", self.top / "a.nav", "--out", self.top / "a.csv")
        table = (self.top / "a.csv").read_text(encoding="utf-8").splitlines()[1:]
        self.assertEqual(len(lines), 11)
        self.assertEqual([line.split()[1:4] for line in lines], [row.split(",")[2:5] for row in table])
        libraries = run("ldd", program)
        for heavy in ("libpcl", "libembree", "libassimp", "libproj", "libceres", "libxml2", "libtiff"):
            self.assertNotIn(heavy, libraries)

    def test_an_autonomy_of_ones_own_drives_a_mission(self):
        """docs/own_autonomy.md: its program is the example's, builds against what is installed, and reaches its goal."""
        source = self.top / "own"
        shutil.copytree(SOURCE / "examples" / "own_autonomy", source)
        program = (source / "own_autonomy.cpp").read_text(encoding="utf-8")
        self.assertLessEqual(len(program.splitlines()), 60)
        page = (SOURCE / "docs" / "own_autonomy.md").read_text(encoding="utf-8")
        self.assertIn("```cpp\n" + program + "```", page)
        self.assertIn("```cmake\n" + (source / "CMakeLists.txt").read_text(encoding="utf-8") + "```", page)
        self.assertIn("```toml\n" + (source / "street.toml").read_text(encoding="utf-8") + "```", page)
        run("cmake", "-S", source, "-B", source / "build", "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", source / "build")
        self.assertRegex(run(source / "build" / "own_autonomy", source / "street.toml"), r"^success after 1[0-9]{2} m\n$")

    def test_an_unknown_component_is_named(self):
        done = self.example(package="canyon REQUIRED COMPONENTS gnss sonar")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("there is no component sonar", done.stderr)

    def test_another_version_is_refused(self):
        done = self.example(package="canyon 99 REQUIRED")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("99", done.stderr)

    def test_what_is_the_programs_alone_is_no_component(self):
        done = self.example(package="canyon REQUIRED COMPONENTS apps")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("there is no component apps", done.stderr)

    def test_pcl_leaves_the_project_its_own_vtk(self):
        if not list(self.prefix.rglob("libcanyon_pcl.a")):
            self.skipTest("built without PCL")
        tell = 'message(NOTICE "VTK disabled: <${CMAKE_DISABLE_FIND_PACKAGE_VTK}>")\n'
        for before, after in (("", "<>"), ("set(CMAKE_DISABLE_FIND_PACKAGE_VTK 1)\n", "<1>")):
            done = self.example(after=before + "find_package(canyon REQUIRED COMPONENTS pcl)\n" + tell)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"VTK disabled: {after}", done.stderr)

    def test_the_moved_program_opens_its_parts_late(self):
        for heavy in ("libpcl", "libassimp", "libproj", "libceres", "libcholmod"):
            self.assertNotIn(heavy, run("ldd", self.canyon))
        self.assertIn('"buildings":1', run(self.canyon, "scene", "info", self.scene, "--json").replace(" ", ""))
        # It was the installed part: without it there is none, neither of the build nor of the folder installed into at first.
        part, = self.prefix.rglob("libcanyon_proj.so")
        part.rename(self.top / "aside.so")
        try:
            done = subprocess.run([self.canyon, "scene", "info", self.scene], capture_output=True, text=True, check=False)
        finally:
            (self.top / "aside.so").rename(part)
        self.assertEqual((done.returncode, done.stderr),
                         (1, f"canyon could not finish: libcanyon_proj.so is missing; it is looked for in {part.parent} "
                          "(or in CANYON_PART_DIR)\n"))

    def test_a_file_that_is_no_part_is_named(self):
        other = next((part for part in self.prefix.rglob("libcanyon_*.so") if part.name != "libcanyon_proj.so"), None)
        if other is None:
            self.skipTest("built with one part alone")
        libraries = self.top / "others"
        libraries.mkdir()
        shutil.copy(other, libraries / "libcanyon_proj.so")
        done = subprocess.run([self.canyon, "scene", "info", self.scene], capture_output=True, text=True, check=False,
                              env={"CANYON_PART_DIR": str(libraries)})
        self.assertEqual((done.returncode, done.stderr),
                         (1, f"canyon could not finish: {libraries}/libcanyon_proj.so is no part of Canyon: it has no canyon_proj_part\n"))

    def test_a_part_that_is_missing_is_named(self):
        done = subprocess.run([self.canyon, "scene", "info", self.scene, "--json"], capture_output=True, text=True, check=False,
                              env={"CANYON_PART_DIR": str(self.top / "nowhere")})
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr, "canyon could not finish: libcanyon_proj.so is missing; it is looked for in "
                         f"{self.top}/nowhere (or in CANYON_PART_DIR)\n")


if __name__ == "__main__":
    unittest.main()
