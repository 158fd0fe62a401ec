"""Runs of the program, and of scripts in its place."""

import os
import signal
import stat
import tempfile
import textwrap
import threading
import time
import unittest
from pathlib import Path
from unittest import mock

import lightsplat
from lightsplat._run import run

# Writes its process id beside itself, and two events. It needs two signals to end, like the program while it writes.
ENDLESS = """\
    import json, os, pathlib, signal, sys, time
    count = []
    def end(*_):
        count.append(1)
        if len(count) > 1:
            os._exit(130)
    signal.signal(signal.SIGTERM, end)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    pathlib.Path(__file__).with_suffix(".pid").write_text(str(os.getpid()))
    print(json.dumps({"v": 1, "event": "progress", "fraction": 0.25}), file=sys.stderr, flush=True)
    while True:
        time.sleep(0.01)
"""

WARNS = """\
    import json, os, sys
    for event in [
        {"event": "start"}, {"event": "unknown of later versions"}, {"event": "progress", "fraction": 0.5},
        {"event": "warning", "text": "a.glb: no fog"}, {"event": "progress", "fraction": 1.0},
        {"event": "wrote", "files": ["a.exr"], "text": "wrote a.exr"}, {"event": "end"},
    ]:
        print(json.dumps(event), file=sys.stderr)
    print("warning: a.glb: no hair", file=sys.stderr)
    print("b.exr is there", file=sys.stderr)
    print(sys.argv[1:], os.environ["LIGHTSPLAT_PROGRESS"])
"""


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def script(self, text):
        """Puts a script in the place of the program."""
        path = self.folder / "program"
        path.write_text("#!/usr/bin/env python3\n" + textwrap.dedent(text))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        patch = mock.patch.dict(os.environ, {"LIGHTSPLAT_PROGRAM": str(path)})
        patch.start()
        self.addCleanup(patch.stop)

    def assert_gone(self):
        process = int((self.folder / "program.pid").read_text())
        with self.assertRaises(ProcessLookupError):
            os.kill(process, 0)

    def test_messages_become_records_and_calls(self):
        self.script(WARNS)
        parts = []
        with self.assertLogs("lightsplat", "INFO") as logs:
            output = run(["render", "a.glb"], parts.append)
        self.assertEqual(output, b"['render', 'a.glb'] ndjson\n")
        self.assertEqual(parts, [0.5, 1.0])
        self.assertEqual([(record.levelname, record.getMessage()) for record in logs.records], [
            ("WARNING", "a.glb: no fog"), ("INFO", "wrote a.exr"), ("WARNING", "a.glb: no hair"), ("INFO", "b.exr is there"),
        ])

    def test_lines_before_an_error_are_no_part_of_it(self):
        self.script("import sys\nsys.exit(print('a note\\nerror: a.toml:3: no\\nb.toml: no', file=sys.stderr) or 3)\n")
        with self.assertRaises(lightsplat.SceneError) as caught:
            run(["info", "a.toml"])
        self.assertEqual(str(caught.exception), "a.toml:3: no\nb.toml: no")
        self.assertEqual((caught.exception.file, caught.exception.line), ("a.toml", 3))

    def test_interrupts_end_the_program(self):
        self.script(ENDLESS)

        def interrupt(fraction):
            self.assertEqual(fraction, 0.25)
            threading.Timer(0.1, os.kill, [os.getpid(), signal.SIGINT]).start()

        with mock.patch("lightsplat._run.PATIENCE", 0.2), self.assertRaises(KeyboardInterrupt):
            run(["render"], interrupt)
        self.assert_gone()

    def test_exceptions_of_the_caller_end_the_program(self):
        self.script(ENDLESS)
        with mock.patch("lightsplat._run.PATIENCE", 0.2), self.assertRaises(ZeroDivisionError):
            run(["render"], lambda fraction: fraction / 0)
        self.assert_gone()

    def test_a_program_killed_is_an_error(self):
        self.script("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)\n")
        with self.assertRaisesRegex(lightsplat.Error, "-9"):
            run(["render"])

    def test_a_missing_program_is_an_error_with_a_remedy(self):
        with mock.patch.dict(os.environ), mock.patch("lightsplat._program._folders", lambda: [self.folder]):
            os.environ.pop("LIGHTSPLAT_PROGRAM", None)
            with self.assertRaisesRegex(FileNotFoundError, "LIGHTSPLAT_PROGRAM"):
                run(["render"])


@unittest.skipUnless(os.environ.get("LIGHTSPLAT_PROGRAM"), "LIGHTSPLAT_PROGRAM names no program")
class Program(unittest.TestCase):
    """The program itself."""

    def assert_error(self, kind, code, text, *words):
        with self.assertRaises(kind) as caught:
            run(["render", *words])
        self.assertEqual(caught.exception.code, code)
        self.assertIn(text, str(caught.exception))
        self.assertFalse(str(caught.exception).startswith("error:"))

    def test_errors_name_file_and_line(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder, "scene: first.toml")
            scene.write_text("resolution = [8, 8]\nfog = 1\n")
            for call in (lightsplat.render, lightsplat.info):
                with self.assertRaises(lightsplat.SceneError) as caught:
                    call(scene)
                self.assertEqual((caught.exception.file, caught.exception.line), (str(scene), 2), caught.exception)
        with self.assertRaises(lightsplat.SceneError) as caught:
            lightsplat.info("none.glb")
        self.assertEqual((caught.exception.file, caught.exception.line), ("none.glb", None))
        with self.assertRaises(lightsplat.UsageError) as caught:
            lightsplat.render("cornell", crop=(0, 0, 0, 0))
        self.assertEqual((caught.exception.file, caught.exception.line), (None, None))

    def test_info_is_a_dictionary(self):
        facts = lightsplat.info("cornell", camera=1)
        self.assertEqual((facts["resolution"], len(facts["cameras"])), ([512, 512], 1))

    def test_errors_have_the_message_of_the_program(self):
        self.assert_error(lightsplat.UsageError, 2, "'--sppp", "cornell", "--sppp=3")
        self.assert_error(ValueError, 2, "--no-png", "cornell", "-o", "a.png", "--no-png")
        self.assert_error(lightsplat.SceneError, 3, "there-is-none.glb", "there-is-none.glb", "-o", "/tmp/a.exr")
        self.assert_error(lightsplat.OutputError, 4, "/proc", "cornell", "-o", "/proc/a.exr")

    def test_a_render_stops_soon_after_an_interrupt(self):
        with tempfile.TemporaryDirectory() as folder:
            start = time.monotonic()
            words = ["cornell", "-o", f"{folder}/a.exr", "--method=path", "--spp=1000000", "--no-denoise", "--no-png"]

            def interrupt(_):
                raise KeyboardInterrupt

            with self.assertRaises(KeyboardInterrupt):
                run(["render", *words], interrupt)
            self.assertLess(time.monotonic() - start, 60)


if __name__ == "__main__":
    unittest.main()
