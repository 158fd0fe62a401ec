"""Images, cameras and data sets of the program as arrays."""

import logging
import os
import pickle
import tempfile
import unittest
from pathlib import Path

import lightsplat

try:
    import numpy
    import OpenEXR
except ImportError:
    # A machine that builds the program need not have both. `make package-test` runs these tests with the wheel.
    numpy = None

FAST = {"method": "path", "spp": 1, "denoise": False, "threads": 2}

# A camera before the Cornell box, turned about its axis.
POSE = [[0.8, 0.6, 0, 0.2], [-0.6, 0.8, 0, 0.3], [0, 0, 1, -0.7], [0, 0, 0, 1]]
BACK = [[-1, 0, 0], [0, 1, 0], [0, 0, -1]]


def load_tests(loader, tests, pattern):
    return tests if numpy else unittest.TestSuite()


def pose():
    turned = numpy.array(POSE)
    turned[:3, :3] = numpy.array(BACK) @ turned[:3, :3]
    return turned


class Images(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def assert_projects(self, image):
        """Asserts that positions are projected to the middles of their pixels, and have their depth."""
        height, width = image.shape[:2]
        x, y = numpy.meshgrid(numpy.arange(width) + 0.5, numpy.arange(height) + 0.5)
        seen = image.layers["depth"] < 1e9
        self.assertGreater(seen.mean(), 0.5)
        points = numpy.append(image.layers["position"][seen], numpy.ones((seen.sum(), 1)), axis=1)
        local = points @ numpy.linalg.inv(image.camera.opencv).T
        numpy.testing.assert_allclose(local[:, 2], image.layers["depth"][seen], rtol=1e-4)
        film = local[:, :3] @ image.camera.intrinsics.T
        numpy.testing.assert_allclose(film[:, 0] / film[:, 2], x[seen], atol=1e-3 * width)
        numpy.testing.assert_allclose(film[:, 1] / film[:, 2], y[seen], atol=1e-3 * height)

    def test_cameras_go_in_and_out(self):
        layers = {"aov": ["position", "depth"], "set": {"aov-mode": "first"}, **FAST}
        lens = {"intrinsics": [[30, 0, 14], [0, 25, 13], [0, 0, 1]], "resolution": (32, 24)}
        cameras = [
            lightsplat.Camera(pose(), 50, resolution=(24, 32), name="a.b"),
            lightsplat.Camera(pose(), **lens),
            lightsplat.Camera.look_at((0.2, 0.3, -0.7), (0.3, 0.2, 0), 50, resolution=(16, 16)),
        ]
        images = lightsplat.views("cornell", cameras, **layers)
        self.assertEqual([image.shape for image in images], [(32, 24, 3), (24, 32, 3), (16, 16, 3)])
        self.assertEqual([image.camera.name for image in images], ["a.b", "view_0002", "view_0003"])
        for given, image in zip(cameras, images):
            self.assert_projects(image)
            numpy.testing.assert_allclose(image.camera.opengl, given.opengl, atol=1e-6)
            self.assertAlmostEqual(image.camera.fov, given.fov, places=3)
        numpy.testing.assert_allclose(images[1].camera.intrinsics, lens["intrinsics"], atol=1e-3)
        # A camera of an image, in the other convention.
        again = lightsplat.Camera(images[1].camera.opencv, convention="opencv", **lens)
        image = lightsplat.render("cornell", camera=again, **layers)
        numpy.testing.assert_allclose(image.layers["position"], images[1].layers["position"], atol=1e-3)
        copied = pickle.loads(pickle.dumps(image))
        self.assertTrue((copied.camera.opengl == image.camera.opengl).all() and copied.stats == image.stats)
        self.assert_projects(lightsplat.render("cornell", resolution=(24, 24), **layers))
        self.assertIsNone(image[2:].camera)

    def test_matrices_need_a_field_of_view_and_keep_their_file(self):
        file = self.folder / "kept.v1.exr"
        image = lightsplat.render("cornell", file, camera=pose(), fov=40, resolution=8, **FAST)
        self.assertEqual(sorted(os.listdir(self.folder)), ["kept.v1.exr", "kept.v1.png"])
        self.assertEqual(image.stats["run"]["output"], str(file))
        self.assertTrue((lightsplat.Image.read(file) == image).all())
        with self.assertRaisesRegex(ValueError, "fov"):
            lightsplat.render("cornell", camera=pose(), **FAST)
        for wrong in [{"matrix": numpy.eye(3)}, {"matrix": numpy.eye(4), "convention": "x"},
                      {"matrix": numpy.eye(4), "intrinsics": numpy.eye(3)}]:
            with self.assertRaises(ValueError):
                lightsplat.Camera(**wrong)
        with self.assertRaisesRegex(ValueError, "OpenEXR"):
            lightsplat.render("cornell", self.folder / "a.png")

    def test_images_are_developed_as_the_program_does(self):
        file = self.folder / "a.exr"
        image = lightsplat.render("cornell", file, resolution=(16, 8), **FAST)
        for look in [{}, {"exposure": "auto+1"}, {"exposure": -2, "view": "agx"}]:
            pixels = lightsplat.develop(file, **look)
            self.assertEqual((pixels.shape, pixels.dtype), ((8, 16, 3), numpy.uint8))
            self.assertTrue((lightsplat.develop(image, **look) == pixels).all())
        grey = numpy.full((2, 3, 4), 0.25, numpy.float32)
        grey[..., 3] = 0.5
        developed = lightsplat.develop(grey, exposure=0, view="standard")
        self.assertEqual(developed[1, 2].tolist(), [188, 188, 188, 128])
        clear = lightsplat.render("cornell", file, background="none", resolution=(16, 8), **FAST)
        self.assertEqual(lightsplat.develop(clear).shape, (8, 16, 4))
        self.assertTrue((lightsplat.develop(clear) == lightsplat.develop(file)).all())
        with self.assertRaisesRegex(ValueError, "shape"):
            lightsplat.develop(numpy.zeros((4, 4)))

    def test_a_data_set_is_its_metadata(self):
        model = self.folder / "a.obj"
        model.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        out = self.folder / "out"
        # The model has no material.
        logging.disable()
        self.addCleanup(logging.disable, logging.NOTSET)
        facts = lightsplat.dataset(model, out, views=2, size=8, light=["0.5", "sky,0,60"], set={"half": "on"}, **FAST)
        self.assertEqual([model["folder"] for model in facts["models"]], ["a"])
        image = lightsplat.Image.read(out / "a/0001.exr")
        self.assertEqual((image.shape, image.dtype), ((8, 8, 3), numpy.float32))
        with self.assertRaises(lightsplat.Error) as caught:
            lightsplat.dataset([model, "none.glb"], out, views=2, size=8, **FAST)
        self.assertEqual(caught.exception.code, 5)


if __name__ == "__main__":
    unittest.main()
