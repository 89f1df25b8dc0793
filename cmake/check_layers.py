#!/usr/bin/env python3
"""check_layers.py [TREE]: checks what may include what; one line `file:line: what is wrong` for each breach.

A folder includes only folders of lower floors, rooms of a folder do not include one another in circles, each heavy library stays in its few named .cpp files, headers stay light, and
truth does not reach those who must not see it. The rules are the tables below; docs/design.md says why.
"""

import collections
import fnmatch
import pathlib
import re
import sys

# What each folder may include beside itself. Folders of one floor never include one another.
SENSORS = ["gnss", "inertial", "lidar", "fusion"]
FLOORS = {
    "core": [],
    "scene": ["core"],
    "gnss": ["core", "scene"],
    "inertial": ["core"],
    "lidar": ["core", "scene"],
    "fusion": ["core"],
    "mission": ["core", "scene", *SENSORS],
    "study": ["core", "scene", *SENSORS, "mission"],
    "report": ["core"],
    "apps": ["core", "scene", *SENSORS, "mission", "study", "report"],
}
# Outside the floors: free to include any of them.
OUTSIDE = ["tests", "bench"]

# Rooms of a folder that are a library of their own: the rest of the folder includes neither them nor what they alone may include,
# so that a program that reads RINEX links no ray tracer.
ROOMS = {"gnss": (["gnss/paths/*", "gnss/receiver/*", "gnss/sensor/*", "gnss/stress/*"], ["scene/*"])}

# So many sources a folder holds, headers and all; a fuller one wants rooms.
FOLDER_FILES_MAX = 25

# Heavy libraries: which includes are theirs, and the only files that may have them.
LIBRARIES = [
    ("Embree", r"embree\d?/", ["scene/tracing/embree_*.cpp"]),
    ("PCL", r"pcl/", ["lidar/registration/pcl_*.cpp"]),
    ("toml++", r"toml\+\+/", ["core/*.cpp"]),
    ("GeographicLib", r"GeographicLib/", ["core/*.cpp"]),
    ("Random123", r"Random123/", ["core/random/*.cpp"]),
    ("oneTBB", r"(tbb|oneapi)/", ["core/*.cpp"]),
    ("OpenSSL", r"openssl/", ["core/*.cpp"]),
    ("zlib", r"zlib\.h", ["core/*.cpp", "report/*.cpp"]),
    ("nlohmann-json", r"nlohmann/", ["core/*.cpp", "mission/*.cpp", "study/*.cpp", "report/*.cpp", "apps/*.cpp", "scene/*.cpp", "lidar/*.cpp"]),
    ("CLI11", r"CLI/", ["apps/*.cpp"]),
    ("Ceres", r"ceres/", ["inertial/*ceres_*.cpp", "inertial/*ceres_*.h", "fusion/smoothing/graph/ceres_*.cpp", "fusion/smoothing/pose_graph/ceres_*.cpp"]),
    ("assimp", r"assimp/", ["scene/importers/assimp.cpp"]),
    ("libxml2", r"libxml/", ["scene/importers/parsing/xml_file.cpp"]),
    ("libtiff", r"tiff\w*\.h", ["scene/elevation/geotiff.cpp"]),
    ("PROJ", r"proj\w*\.h", ["scene/proj_*.cpp"]),
    ("SQLite", r"sqlite3\.h", ["study/*.cpp"]),
]
# PCL's registration headers take 18 s and 1.4 GB per file.
REGISTRATION_FILES_MAX = 3

# What stands before a function whose loops are to be vectors, and the options that make it so.
VECTOR_CLONES, VECTOR_LOOPS = "CANYON_VECTOR_CLONES", "CANYON_VECTOR_LOOPS"

STANDARD = r"[a-z_0-9]+"
EIGEN = r"(unsupported/)?Eigen/\w+"
FORWARD_DECLARATIONS = r"nlohmann/json_fwd\.hpp"
SYSTEM = r"(malloc|unistd|fcntl|signal|termios|poll|dlfcn|sched|immintrin|cpuid|x86intrin)\.h|(sys|arpa|netinet)/\w+\.h"

# Truth is for sensors, recorder and scorer: these files must not see it, not even through another header.
TRUTH = "core/truth.h"
BLIND_TO_TRUTH = [
    "fusion/*",
    "lidar/deskew*", "lidar/sweep_motion*",
    "lidar/registration/*",
    "lidar/voxels/*",
    "mission/mapping/mapper*", "mission/autonomy/*",
]

# Random numbers come from core/random/random.h: the standard's distributions differ from library to library.
OTHER_RANDOMNESS = r"std::(\w+_distribution|mt19937(_64)?|default_random_engine|random_device)\b"

# Tests run side by side: a file that each of them names alike is taken away by one while another reads it.
SHARED_FILE = r'TempDir\(\) \+ "[^"]*"(?! \+ std::to_string\((::)?getpid)(?<!XXXXXX")'

# What defines a type at the level of a namespace: no indent.
NAMESPACE = re.compile(r"namespace (canyon(?:::\w+)*) \{")
TYPE = re.compile(r"(?:struct|class|enum class|enum|using) (\w+)\b[^;(]*(?:\{|=)|using (\w+) =")

# How the tree's own headers are included, in the tree as where they are installed.
PREFIX = "canyon/"
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')


def without_comments(text):
    """The text with comments blanked, lines kept."""
    pattern = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.S)
    return pattern.sub(lambda m: m[0] if m[0][0] == '"' else re.sub(r"[^\n]", " ", m[0]), text)


def matches(name, patterns):
    return any(fnmatch.fnmatch(name, pattern) for pattern in patterns)


def room_of(name, folder):
    """The room of a folder that a file is in, or None: report/draw/chart.h is in draw."""
    parts = name.split("/")
    return parts[1] if parts[0] == folder and len(parts) > 2 else None


def way_back(steps, start):
    """The shortest way from a room through others back to it, or None."""
    ways = [[start]]
    seen = set()
    while ways:
        way = ways.pop(0)
        for room in sorted(steps.get(way[-1], {})):
            if room == start:
                return way
            if room not in seen:
                seen.add(room)
                ways.append([*way, room])
    return None


class Tree:
    """All sources of a tree: breaches are gathered by check()."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.breaches = []
        self.lines = {}  # name -> lines without comments
        self.includes = {}  # name -> [(line number, path in quotes or None, path in angles or None)]
        for folder in [*FLOORS, *OUTSIDE]:
            for path in sorted((self.root / folder).rglob("*")):
                if path.suffix in (".h", ".cpp") and path.is_file():
                    self.read(path)

    def read(self, path):
        name = path.relative_to(self.root).as_posix()
        self.lines[name] = without_comments(path.read_text(encoding="utf-8")).split("\n")
        found = [(number, INCLUDE.match(line)) for number, line in enumerate(self.lines[name], 1)]
        self.includes[name] = [(number, match[1], match[2]) for number, match in found if match]

    def named(self, quoted):
        """The file of the tree that an include names, or None: "canyon/core/time.h" is core/time.h."""
        return quoted.removeprefix(PREFIX) if quoted and quoted.startswith(PREFIX) else None

    def breach(self, name, number, what):
        self.breaches.append(f"{name}:{number}: {what}")

    def check(self):
        for name in self.lines:
            folder = name.split("/")[0]
            if name.endswith(".h"):
                self.check_pragma_once(name)
            else:
                self.check_own_header(name)
            for number, quoted, angled in self.includes[name]:
                if quoted:
                    self.check_quoted(name, folder, number, quoted)
                elif folder in FLOORS:
                    self.check_angled(name, number, angled)
            if folder in FLOORS:
                self.check_randomness(name)
            if folder == "tests":
                self.check_shared_files(name)
            self.check_vector_loops(name)
            if matches(name, BLIND_TO_TRUTH):
                self.check_truth(name)
        self.check_registration_files()
        self.check_hidden_types()
        self.check_folder_sizes()
        for folder in FLOORS:
            self.check_circles(folder)
        for folder in FLOORS:
            self.check_links(folder)
        return self.breaches

    def check_pragma_once(self, name):
        for number, line in enumerate(self.lines[name], 1):
            if line.strip():
                if line.strip() != "#pragma once":
                    self.breach(name, number, "a header starts with #pragma once")
                return

    def check_own_header(self, name):
        own = name.removesuffix(".cpp") + ".h"
        if own in self.lines and (not self.includes[name] or self.named(self.includes[name][0][1]) != own):
            number = self.includes[name][0][0] if self.includes[name] else 1
            self.breach(name, number, f'the first include is the own header, "{PREFIX}{own}"')

    def check_quoted(self, name, folder, number, quoted):
        if quoted.startswith("embedded/") and folder in ("core", "tests"):  # generated from the data files
            return
        included = self.named(quoted) or ""
        target = included.split("/")[0]
        if target not in FLOORS and target not in OUTSIDE:
            self.breach(name, number, f'"{quoted}" is not named from the root of the tree ("{PREFIX}{folder}/...")')
        elif included not in self.lines:
            self.breach(name, number, f'"{quoted}" does not exist')
        elif folder in FLOORS and target != folder and target not in FLOORS[folder]:
            allowed = ", ".join(FLOORS[folder]) or "no other folder"
            self.breach(name, number, f'{folder}/ may not include "{quoted}"; it may include {allowed}')
        elif folder in ROOMS:
            rooms, theirs = ROOMS[folder]
            if not matches(name, rooms) and matches(included, [*rooms, *theirs]):
                self.breach(name, number, f'"{quoted}": only {", ".join(rooms)} may include it')

    def check_angled(self, name, number, angled):
        library = next((row for row in LIBRARIES if re.match(row[1], angled)), None)
        if re.fullmatch(STANDARD, angled) or re.fullmatch(EIGEN, angled):
            return
        if name.endswith(".h"):
            if re.fullmatch(FORWARD_DECLARATIONS, angled):
                return
            self.breach(name, number, f"<{angled}> in a header; headers take only the standard library and Eigen")
        elif library and not matches(name, library[2]):
            self.breach(name, number, f"<{angled}>: {library[0]} belongs in {' or '.join(library[2])}")
        elif not library and not re.fullmatch(SYSTEM, angled):
            self.breach(name, number, f"<{angled}> is of a library that has no place in cmake/check_layers.py")

    def check_randomness(self, name):
        for number, line in enumerate(self.lines[name], 1):
            found = re.search(OTHER_RANDOMNESS, line)
            if found:
                self.breach(name, number, f"{found[0]}: random numbers come from core/random/random.h")

    def check_shared_files(self, name):
        for number, line in enumerate(self.lines[name], 1):
            if re.search(SHARED_FILE, line):
                self.breach(name, number, "tests that run side by side share this file: canyon::testing::temporary_file gives each its own")

    def check_vector_loops(self, name):
        """The compiler makes vectors of the loops of those files alone that are told to it."""
        found = [number for number, line in enumerate(self.lines[name], 1) if re.search(rf"\b{VECTOR_CLONES}\b", line) and not line.startswith("#")]
        folder, _, within = name.partition("/")
        lists = self.root / folder / "CMakeLists.txt"
        text = re.sub(r"#.*", "", lists.read_text(encoding="utf-8")) if lists.is_file() else ""
        told = re.findall(r"set_source_files_properties\(([^)]*)\)", text)
        if found and not any(VECTOR_LOOPS in call and within in call.split() for call in told):
            self.breach(name, found[0], f"{VECTOR_CLONES} without {VECTOR_LOOPS} in {folder}/CMakeLists.txt: its loops stay scalar")

    def check_truth(self, name):
        """Breadth first through the includes, so that the shortest way to the truth is the one told."""
        ways = [(number, [self.named(quoted)]) for number, quoted, _ in self.includes[name] if self.named(quoted)]
        seen = set()
        while ways:
            number, way = ways.pop(0)
            if way[-1] == TRUTH:
                through = f" (through {' -> '.join(way[:-1])})" if len(way) > 1 else ""
                self.breach(name, number, f'"{TRUTH}"{through}: truth is for sensors, recorder and scorer only')
                return
            if way[-1] not in seen:
                seen.add(way[-1])
                ways += [(number, [*way, self.named(quoted)]) for _, quoted, _ in self.includes.get(way[-1], []) if self.named(quoted)]

    def check_registration_files(self):
        heavy = [name for name in self.lines if any(a and a.startswith("pcl/registration/") for _, _, a in self.includes[name])]
        for name in heavy[REGISTRATION_FILES_MAX:]:
            self.breach(name, 1, f"more than {REGISTRATION_FILES_MAX} files include PCL's registration headers (18 s each)")

    def types(self, name):
        """(line number, namespace, type) for what a file defines at the level of a namespace."""
        space = None
        for number, line in enumerate(self.lines[name], 1):
            opened, found = NAMESPACE.match(line), TYPE.match(line)
            space = opened[1] if opened else space
            if space and found:
                yield number, space, found[1] or found[2]

    def check_hidden_types(self):
        """A type of canyon::mission that is named as one of canyon takes its place in every header read after it: files that
        are joined in another order then disagree about what a structure holds."""
        folders = [name for name in self.lines if name.split("/")[0] in FLOORS]
        common = {kind: name for name in folders if name.endswith(".h") for _, space, kind in self.types(name) if space == "canyon"}
        for name in folders:
            for number, space, kind in self.types(name):
                if kind in common and space != "canyon":
                    self.breach(name, number, f"{space}::{kind} hides canyon::{kind} of {common[kind]}: it wants a name of its own")

    def check_folder_sizes(self):
        sizes = collections.Counter(name.rsplit("/", 1)[0] for name in self.lines)
        for folder, files in sorted(sizes.items()):
            if files > FOLDER_FILES_MAX:
                self.breach(folder, 1, f"{files} sources in one folder; more than {FOLDER_FILES_MAX} want rooms")

    def check_circles(self, folder):
        """Rooms of a folder, each with all below it, do not include one another in circles. The folder's own files, which join
        its rooms, are of none. Of each circle the shortest way around is told, by one include for every step."""
        steps = {}  # room -> {room it includes: (file, line number, what it includes)}
        for name in self.lines:
            for number, quoted, _ in self.includes[name]:
                included = self.named(quoted) or ""
                room, other = room_of(name, folder), room_of(included, folder)
                if room and other and room != other and included in self.lines:
                    steps.setdefault(room, {}).setdefault(other, (name, number, quoted))
        told = set()
        for start in sorted(steps):
            way = way_back(steps, start)
            if way and not told.intersection(way):
                told.update(way)
                for room, other in zip(way, [*way[1:], start]):
                    name, number, quoted = steps[room][other]
                    self.breach(name, number, f'"{quoted}": {folder}/ has a circle of rooms, {" -> ".join([*way, start])}')

    def check_links(self, folder):
        """A folder links what it may include, no more."""
        path = self.root / folder / "CMakeLists.txt"
        if not path.is_file():
            return
        for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
            for target in re.findall(r"\bcanyon_(\w+)", line.split("#")[0]):
                of = target.split("_")[0]  # canyon_gnss_sensor is of gnss/
                if of in FLOORS and of != folder and of not in FLOORS[folder]:
                    self.breach(f"{folder}/CMakeLists.txt", number, f"{folder}/ may not link canyon_{target}")


def main():
    root = sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    tree = Tree(root)
    breaches = tree.check()
    print("\n".join(breaches) if breaches else f"layers: {len(tree.lines)} files, no breach")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
