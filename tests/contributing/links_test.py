#!/usr/bin/python3
"""Every relative link of README.md, CONTRIBUTING.md and docs/ leads to a file that is there, and to a heading that is in it."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGES = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").glob("*.md"))]


def prose(page):
    """Without code: blocks and what stands between backticks."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)
    return re.sub(r"``.*?``|`[^`\n]*`", "code", text)


def anchors(page):
    """Of headings, as hosts of Markdown make them: small letters, no punctuation, hyphens for blanks."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)
    headings = re.findall(r"^#+ (.*?)\s*$", text, flags=re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken(page):
    for file, anchor in re.findall(r"\]\(([^)#\s]*)(?:#([^)\s]*))?\)", prose(page)):
        if re.match(r"[a-z]+:", file):
            continue
        target = page.parent / file if file else page
        if not target.exists():
            yield f"{page.relative_to(ROOT)}: {file} is not there"
        elif anchor and target.suffix == ".md" and anchor not in anchors(target):
            yield f"{page.relative_to(ROOT)}: {file or page.name} has no heading #{anchor}"


found = [line for page in PAGES for line in broken(page)]
print("\n".join(found) or f"{len(PAGES)} pages: every link leads somewhere")
sys.exit(1 if found else 0)
