"""Keyword arguments become options."""

import unittest
from pathlib import Path

from lightsplat._arguments import to_options


class Arguments(unittest.TestCase):
    def check(self, expected, **keywords):
        self.assertEqual(to_options(keywords), expected)

    def test_values_become_words(self):
        self.check(["--spp=16", "--method=cache"], spp=16, method="cache")
        self.check(["--max-depth=5", "--set=epsilon=0.5"], max_depth=5, set={"epsilon": 0.5})
        self.check(["--exposure=-2"], exposure=-2)
        self.check(["--exposure=auto+1", "--background=none"], exposure="auto+1", background="none")
        self.check(["--env=maps/sky.hdr"], env=Path("maps/sky.hdr"))
        self.check([], spp=None)

    def test_sequences_become_lists(self):
        self.check(["--resolution=640x360"], resolution=(640, 360))
        self.check(["--resolution=50%"], resolution="50%")
        self.check(["--look-from=0,1.5,-4"], look_from=[0, 1.5, -4])
        self.check(["--aov=depth,normal"], aov=["depth", "normal"])
        self.check(["--env=1,0.5,0.25"], env=(1, 0.5, 0.25))
        self.check(["--define=X=1", "--define=Y=a"], define={"X": 1, "Y": "a"})
        self.check(["--light=0.5", "--light=sky,0,60", "--hide=a"], light=["0.5", "sky,0,60"], hide="a")

    def test_booleans_become_flags(self):
        self.check(["--strict", "--reproducible"], strict=True, reproducible=True)
        self.check([], strict=False, keep_noisy=False, no_denoise=False)
        self.check(["--no-denoise"], denoise=False)
        self.check(["--no-denoise"], no_denoise=True)
        self.check(["--denoise"], denoise=True)
        self.check(["--no-default-light"], default_light=False)
        self.check([], default_light=True)

    def test_options_of_the_package_are_refused(self):
        for name in ["stats", "format", "no_png", "quiet", "verbose"]:
            with self.assertRaisesRegex(TypeError, name):
                to_options({name: True})


if __name__ == "__main__":
    unittest.main()
