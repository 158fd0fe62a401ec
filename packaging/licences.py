"""Prints the licences of the crates that the program is made of. Its argument is the target that it is built for.

Each text stands once, under the crates that carry it. A crate without a text is listed with the names of its licences.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

NAME = re.compile(r"(licen[cs]e|copying|notice|unlicense)", re.IGNORECASE)


def metadata(target):
    command = ["cargo", "metadata", "--locked", "--format-version=1", f"--filter-platform={target}"]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)


def linked(graph):
    """Returns the packages that the program links: no crates of build scripts, of macros or of tests."""
    packages = {package["id"]: package for package in graph["packages"]}
    nodes = {node["id"]: node for node in graph["resolve"]["nodes"]}
    root = next(p["id"] for p in graph["packages"] if p["name"] == "lightsplat" and p["id"] in graph["workspace_members"])
    found, waiting = set(), [root]
    while waiting:
        crate = waiting.pop()
        is_macro = any("proc-macro" in target["kind"] for target in packages[crate]["targets"])
        if crate in found or is_macro:
            continue
        found.add(crate)
        for edge in nodes[crate]["deps"]:
            if any(kind["kind"] is None for kind in edge["dep_kinds"]):
                waiting.append(edge["pkg"])
    outside = [packages[crate] for crate in found if packages[crate]["source"]]
    return sorted(outside, key=lambda package: (package["name"], package["version"]))


def texts(package):
    """Returns the texts of a crate, with those of the C and C++ sources that it carries."""
    folder = Path(package["manifest_path"]).parent
    paths = sorted(p for p in folder.rglob("*") if p.is_file() and NAME.match(p.name) and p.suffix != ".rs")
    found = [path.read_text(encoding="utf-8", errors="replace").strip() for path in paths]
    return found or [text for path in sorted(folder.rglob("*.h")) if (text := head(path))]


def head(path):
    """Returns the licence at the head of a C header, if one is there."""
    comment = re.match(r"\s*/\*(.*?)\*/", path.read_text(encoding="utf-8", errors="replace"), re.DOTALL)
    if not comment or "Redistribution and use" not in comment[1]:
        return None
    return re.sub(r"^ *\* ?", "", comment[1], flags=re.MULTILINE).strip()


def main(target):
    carriers, bare = {}, []
    for package in linked(metadata(target)):
        title = f"{package['name']} {package['version']} ({package['license'] or 'see its text'})"
        found = texts(package)
        for text in dict.fromkeys(found):
            carriers.setdefault(text, []).append(title)
        if not found:
            bare.append(title)
    if not carriers:
        sys.exit("licences: no texts of licences are found")
    print("Crates that are part of lightsplat, and their licences.")
    for text, titles in carriers.items():
        print("\n" + "=" * 80, *titles, "-" * 80, text, sep="\n")
    if bare:
        print("\n" + "=" * 80, "Crates that carry no text:", *bare, sep="\n")


if __name__ == "__main__":
    main(sys.argv[1])
