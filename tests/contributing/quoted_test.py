#!/usr/bin/env python3
"""CONTRIBUTING.md shows files of tests/contributing/ word for word: each code block names its file in the line before it."""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
GUIDE = HERE.parents[1] / "CONTRIBUTING.md"

EXAMPLES = {"diurnal_ionosphere.cpp", "fix_share_figure.h", "gravity_verb.cpp", "boxes_reader.cpp"}


def body(text):
    """What a quotation holds of a file: from the first namespace on."""
    return text[text.index("namespace canyon"):].strip()


def main():
    quoted = re.findall(r"\(tests/contributing/([\w.]+)\)[^\n]*\n+```cpp\n(.*?)```", GUIDE.read_text(encoding="utf-8"), re.S)
    wrong = [f"CONTRIBUTING.md: {name}: not what stands in the file"
             for name, code in quoted if code.strip() != body((HERE / name).read_text(encoding="utf-8"))]
    wrong += [f"CONTRIBUTING.md: {name}: not shown" for name in sorted(EXAMPLES - {name for name, _ in quoted})]
    print("\n".join(wrong) if wrong else f"{len(quoted)} examples")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
