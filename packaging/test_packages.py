"""Tests of the packages in dist/: installed into fresh folders, as users do, and with nothing of this machine's build.

The wheel goes into a new virtual environment, the tarball into a new folder that is then moved. Both render, and their
images are compared bit by bit, with each other and with images of the Python module.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DIST = ROOT / "dist"

# Largest versions of symbols that manylinux_2_28 allows.
SYMBOLS = {b"GLIBC": (2, 28), b"GLIBCXX": (3, 4, 25), b"CXXABI": (1, 3, 11)}

# A render that takes about a second.
SMALL = ["render", "cornell", "-r", "64x64", "--threads", "2", "--reproducible"]

# Environment of a machine with neither Rust nor a build of lightsplat.
CLEAN = {"PATH": "/usr/bin:/bin", "HOME": "/nonexistent", "LANG": "C.UTF-8"}

# Processors that emulators know: one below x86-64-v3, and one of it.
LESSER, OF_V3 = "Nehalem", "Haswell"


def only(pattern):
    """Returns the one file in dist/ with this pattern."""
    found = sorted(DIST.glob(pattern))
    if len(found) != 1:
        sys.exit(f"dist/ has {len(found)} files {pattern}; run `make package-test`")
    return found[0]


def setUpModule():
    global FOLDER, WHEEL, TARBALL, PYTHON
    FOLDER = Path(tempfile.mkdtemp(prefix="lightsplat-packages-"))
    unittest.addModuleCleanup(shutil.rmtree, FOLDER)
    subprocess.run([sys.executable, "-m", "venv", FOLDER / "venv"], check=True)
    PYTHON = FOLDER / "venv/bin/python"
    start = time.monotonic()
    subprocess.run([PYTHON, "-m", "pip", "install", "--quiet", only("*.whl")], check=True)
    print(f"pip install: {time.monotonic() - start:.1f} s", file=sys.stderr)
    WHEEL = FOLDER / "venv/bin/lightsplat"
    archive = only("*.tar.xz")
    subprocess.run(["tar", "-C", FOLDER, "-xf", archive], check=True)
    moved = FOLDER / "moved here"
    (FOLDER / archive.name.removesuffix(".tar.xz")).rename(moved)
    TARBALL = moved / "bin/lightsplat"


class Packages(unittest.TestCase):
    def setUp(self):
        self.work = Path(tempfile.mkdtemp(dir=FOLDER))

    def run_program(self, program, *words, code=0, isa=None, **options):
        environment = CLEAN | ({"LIGHTSPLAT_ISA": isa} if isa else {})
        done = subprocess.run([program, *words], cwd=self.work, env=environment, capture_output=True, text=True, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def render(self, program, name, *more, **options):
        self.run_program(program, *SMALL, *more, "-o", name, **options)
        return (self.work / name).read_bytes(), (self.work / name).with_suffix(".png").read_bytes()

    def test_both_packages_render_the_same_bits(self):
        for isa in ["x86-64-v3", "x86-64-v4"]:
            wheel = self.render(WHEEL, f"wheel-{isa}.exr", isa=isa)
            tarball = self.render(TARBALL, f"tarball-{isa}.exr", isa=isa)
            variant = self.render(TARBALL.parent.parent / f"lib/lightsplat/lightsplat-{self.chosen(isa)}", f"{isa}.exr")
            self.assertTrue(wheel == tarball == variant, isa)
        self.assertTrue(self.render(WHEEL, "default.exr") == wheel)

    def chosen(self, isa):
        said = self.run_program(TARBALL, "--version", isa=isa).stdout
        return re.search(r"x86-64-v\d", said)[0]

    def test_the_version_names_libraries_of_the_package(self):
        for program in [WHEEL, TARBALL]:
            said = self.run_program(program, "--version").stdout
            for part in ["lightsplat 0.", "compiled for: x86-64-v", "Embree:       4.", "TBB ", "Open Image Denoise"]:
                self.assertIn(part, said)

    def test_libraries_come_from_the_package(self):
        for lib in [FOLDER / "venv/libexec/lightsplat", TARBALL.parent.parent / "lib/lightsplat"]:
            variants = list(lib.glob("lightsplat-*"))
            self.assertEqual(len(variants), 2)
            for variant in variants:
                said = subprocess.run([variant], env=CLEAN | {"LD_TRACE_LOADED_OBJECTS": "1"}, capture_output=True, text=True)
                of_render = [line for line in said.stdout.splitlines() if "embree" in line or "tbb" in line]
                self.assertEqual(len(of_render), 2, said.stdout)
                self.assertTrue(all(f"=> {lib}/" in line for line in of_render), of_render)

    def test_symbols_are_those_of_old_systems(self):
        programs = [path for path in TARBALL.parent.parent.rglob("*") if path.is_file()]
        programs = [path for path in programs if path.read_bytes()[:4] == b"\x7fELF"]
        self.assertEqual(len(programs), 9)
        for path in programs:
            for kind, largest in SYMBOLS.items():
                for found in re.findall(rb"\0" + kind + rb"_([\d.]+)\0", path.read_bytes()):
                    self.assertLessEqual(tuple(map(int, found.split(b"."))), largest, path)
            # No program looks for anything in the folder that it was built in.
            self.assertFalse(str(ROOT).encode() in path.read_bytes(), path)

    def test_links_names_and_codes_are_kept(self):
        (self.work / "link").symlink_to(TARBALL)
        linked = self.run_program(self.work / "link", "--version").stdout
        self.assertEqual(linked, self.run_program(TARBALL, "--version").stdout)
        for program in [WHEEL, TARBALL, self.work / "link"]:
            self.assertIn("--sppp", self.run_program(program, "render", "cornell", "--sppp", code=2).stderr)
            self.assertIn("kitchens", self.run_program(program, "info", "kitchens", code=3).stderr)

    def test_signals_reach_the_program(self):
        for number, code in [(signal.SIGINT, 75), (signal.SIGTERM, 75), (signal.SIGKILL, -9)]:
            endless = [TARBALL, "render", "cornell", "--method", "path", "--spp", "1000000", "--progress", "ndjson"]
            with subprocess.Popen(endless, cwd=self.work, env=CLEAN, stderr=subprocess.PIPE, text=True) as child:
                for line in child.stderr:
                    if '"progress"' in line:
                        child.send_signal(number)
                        break
                child.stderr.read()
            self.assertEqual(child.returncode, code)

    def test_a_launcher_alone_says_what_is_missing(self):
        shutil.copy(TARBALL, self.work / "lightsplat")
        said = self.run_program(self.work / "lightsplat", "--version", code=1).stderr
        self.assertRegex(said, r"^error: cannot start .*lib/lightsplat/lightsplat-x86-64-v\d: .*install it again")
        self.assertIn("LIGHTSPLAT_ISA=v9", self.run_program(TARBALL, "--version", code=1, isa="v9").stderr)

    def test_pip_installs_into_any_folder(self):
        target = self.work / "target"
        subprocess.run([PYTHON, "-m", "pip", "install", "-q", "--no-deps", "--target", target, only("*.whl")], check=True)
        said = self.run_program(target / "bin/lightsplat", "--version").stdout
        self.assertEqual(said, self.run_program(WHEEL, "--version").stdout)
        found = subprocess.run([PYTHON, "-c", "import lightsplat; print(lightsplat.program())"],
                               env=CLEAN | {"PYTHONPATH": str(target)}, capture_output=True, text=True, check=True)
        self.assertEqual(found.stdout.strip(), str(target / "bin/lightsplat"))

    def test_what_comes_with_the_program_is_there(self):
        folder = TARBALL.parent.parent
        share = FOLDER / "venv/share"
        for path in [folder / "man/man1/lightsplat.1", share / "man/man1/lightsplat.1", folder / "completions/_lightsplat"]:
            self.assertIn("no", path.read_text())
            self.assertGreater(path.stat().st_size, 10_000, path)
        for name in ["LICENSE-MIT", "LICENSE-APACHE", "Embree-and-oneTBB", "OpenImageDenoise-and-oneTBB", "Rust-crates"]:
            self.assertTrue((folder / "LICENSES" / name).is_file(), name)
            self.assertTrue(list((FOLDER / "venv/lib").rglob(f"*.dist-info/licenses/**/{name}")), name)
        for scene in ["kitchen", "cornell"]:
            self.run_program(TARBALL, "info", folder / f"scenes/{scene}.toml", "--strict")

    @unittest.skipUnless(shutil.which("qemu-x86_64"), "qemu-user is not installed")
    def test_lesser_processors(self):
        emulate = ["qemu-x86_64", "-cpu"]
        for program in [WHEEL, TARBALL]:
            said = self.run_program(*emulate, LESSER, program, "--version", code=1).stderr
            self.assertRegex(said, r"(?m)^error: this processor lacks \w+; this package needs x86-64-v3")
            self.assertEqual(len([line for line in said.splitlines() if line.startswith("error")]), 1)
        variant = TARBALL.parent.parent / "lib/lightsplat/lightsplat-x86-64-v3"
        self.assertIn("x86-64-v3", self.run_program(*emulate, OF_V3, variant, "--version").stdout)


class Python(unittest.TestCase):
    """The module of the wheel."""

    def check(self, text, code=0):
        work = tempfile.mkdtemp(dir=FOLDER)
        done = subprocess.run([PYTHON, "-c", text], cwd=work, env=CLEAN, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def test_an_image_is_an_array_with_the_pixels_of_the_program(self):
        work = Path(tempfile.mkdtemp(dir=FOLDER))
        subprocess.run([WHEEL, *SMALL, "-q", "-o", work / "a.exr", "--aov", "depth,normal,material"], env=CLEAN, check=True)
        self.check(f"""
import pickle, lightsplat, numpy, OpenEXR
image = lightsplat.render("cornell", resolution=(64, 64), threads=2, aov=["depth", "normal", "material"])
assert image.shape == (64, 64, 3) and image.dtype == numpy.float32 and image.flags.c_contiguous
assert isinstance(image, numpy.ndarray) and image.stats["run"]["settings"]["seed"] == 0
assert image.layers["depth"].shape == (64, 64) and image.layers["normal"].shape == (64, 64, 3)
file = OpenEXR.File({str(work / "a.exr")!r}, separate_channels=True).channels()
for number, name in enumerate("RGB"):
    assert (image[..., number] == file[name].pixels).all()
assert (image.layers["normal"][..., 1] == file["normal.Y"].pixels).all()
assert image.layers["materialId"].dtype == numpy.uint32
assert type(image * 2) is numpy.ndarray and type(image.mean()) is numpy.float32
again = pickle.loads(pickle.dumps(image))
assert (again == image).all() and again.stats == image.stats and again.layers.keys() == image.layers.keys()
assert image[:2].stats is None
kept = lightsplat.render("cornell", "kept.exr", resolution=(64, 64), denoise=False)
assert (kept != image).any()
import os
assert sorted(os.listdir()) == ["kept.exr", "kept.png"], os.listdir()
""")

    def test_errors_are_exceptions(self):
        self.check("""
import lightsplat
try:
    lightsplat.render("none.glb")
except lightsplat.SceneError as error:
    assert "none.glb" in str(error) and error.code == 3
else:
    raise AssertionError
""")

    def test_ctrl_c_ends_the_render(self):
        text = """
import os, signal, lightsplat
def stop(fraction):
    os.kill(os.getpid(), signal.SIGINT)
try:
    lightsplat.render("cornell", method="path", spp=1000000, progress=stop)
except KeyboardInterrupt:
    print("stopped")
"""
        self.assertEqual(self.check(text).stdout, "stopped\n")

    def test_the_tests_of_the_module_pass(self):
        tests = [PYTHON, "-B", "-m", "unittest", "discover", "-s", ROOT / "python/tests"]
        done = subprocess.run(tests, cwd=FOLDER, env=CLEAN | {"LIGHTSPLAT_PROGRAM": str(WHEEL)}, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("skipped", done.stderr)

    def test_the_module_is_the_program_too(self):
        done = subprocess.run([PYTHON, "-m", "lightsplat", "info", "nothing"], env=CLEAN, capture_output=True)
        self.assertEqual(done.returncode, 3)
        self.assertEqual(self.check("import lightsplat; print(lightsplat.program())").stdout.strip(), str(WHEEL))


if __name__ == "__main__":
    os.environ.pop("PYTHONPATH", None)
    unittest.main(verbosity=2)
