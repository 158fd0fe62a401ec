"""Cameras: matrices from and to other programs."""

from __future__ import annotations

import copy
import math
from typing import Any, Iterable, Mapping, Optional, Sequence

import numpy

Matrix = numpy.ndarray[Any, Any]

# OpenCV's y and z point down and forward, those of OpenGL up and backward.
FLIP = numpy.diag([1.0, -1.0, -1.0, 1.0])

# Relative deviation of a rotation of single precision.
ROUNDING = 1e-4


class Camera:
    """A camera: its place, and its lens.

    `opengl` and `opencv` are its matrices from camera to world, 4 x 4: x to the right, y up and z backward in OpenGL,
    Blender and NeRF data sets; x to the right, y down and z forward in OpenCV and COLMAP. The world is that of the
    scene's file. `intrinsics` is the 3 x 3 matrix of OpenCV for a film of `resolution` (width, height) in pixels, whose
    upper left corner is (0, 0). `fov` is the horizontal field of view in degrees. A parallel projection has neither.
    """

    def __init__(
        self,
        matrix: Any,
        fov: Optional[float] = None,
        *,
        intrinsics: Any = None,
        resolution: Optional[Sequence[int]] = None,
        convention: str = "opengl",
        name: Optional[str] = None,
    ) -> None:
        """Places a camera by a matrix from camera to world in a `convention`, "opengl" or "opencv".

        The lens is `fov`, or `intrinsics` with the `resolution` of their film. `name` names files of its images.
        """
        pose = numpy.array(matrix, dtype=numpy.float64)
        if pose.shape == (3, 4):
            pose = numpy.vstack([pose, [0.0, 0.0, 0.0, 1.0]])
        if pose.shape != (4, 4):
            raise ValueError(f"a camera's matrix is 4 x 4, and this has the shape {pose.shape}")
        if convention not in ("opengl", "opencv"):
            raise ValueError(f"convention is \"opengl\" or \"opencv\", not {convention!r}")
        self.opengl: Matrix = pose @ FLIP if convention == "opencv" else pose
        self.resolution = None if resolution is None else (int(resolution[0]), int(resolution[1]))
        self.name = name
        self.intrinsics: Optional[Matrix] = None
        self.fov = None if fov is None else float(fov)
        if intrinsics is None:
            return
        if fov is not None or self.resolution is None:
            raise ValueError("give intrinsics with the resolution of their film, and without fov")
        self.intrinsics = numpy.array(intrinsics, dtype=numpy.float64)
        if self.intrinsics.shape != (3, 3) or self.intrinsics[0, 1] != 0:
            raise ValueError("intrinsics are [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]")
        self.fov = math.degrees(2 * math.atan(0.5 * self.resolution[0] / self.intrinsics[0, 0]))

    @property
    def opencv(self) -> Matrix:
        """The matrix from camera to world, with y down and z forward."""
        return self.opengl @ FLIP

    @classmethod
    def look_at(
        cls, origin: Sequence[float], target: Sequence[float], fov: float, *, up: Sequence[float] = (0, 1, 0),
        **more: Any,
    ) -> Camera:
        """Returns the camera at `origin` that looks at `target`, with `up` upward. `more` is as for a `Camera`."""
        back = numpy.subtract(origin, target).astype(numpy.float64)
        right = numpy.cross(up, back)
        if not numpy.linalg.norm(right) > 0:
            raise ValueError("the camera looks nowhere, or along `up`; change target or up")
        axes = [right, numpy.cross(back, right), back]
        columns = [axis / numpy.linalg.norm(axis) for axis in axes] + [numpy.asarray(origin, numpy.float64)]
        return cls(numpy.stack(columns, axis=1), fov, **more)

    @classmethod
    def of_header(cls, header: Mapping[str, Any], name: Optional[str] = None) -> Optional[Camera]:
        """Returns the camera of an OpenEXR file, by its `worldToCamera` and `worldToNDC`; None without them."""
        if "worldToCamera" not in header or "worldToNDC" not in header:
            return None
        # Both are for row vectors. The first has y up and z forward.
        to_camera, to_film = (
            numpy.asarray(header[key], numpy.float64).reshape(4, 4) for key in ("worldToCamera", "worldToNDC"))
        pose = numpy.linalg.inv(to_camera).T @ numpy.diag([1.0, 1.0, -1.0, 1.0])
        low, high = (numpy.asarray(corner) for corner in header["displayWindow"])
        width, height = (int(side) for side in high - low + 1)
        lens = numpy.linalg.inv(to_camera) @ to_film
        if abs(lens[2, 3] - 1.0) > ROUNDING:
            return cls(pose, resolution=(width, height), name=name)
        intrinsics = [[width * lens[0, 0], 0, width * lens[2, 0]], [0, -height * lens[1, 1], height * lens[2, 1]], [0, 0, 1]]
        return cls(pose, intrinsics=intrinsics, resolution=(width, height), name=name)

    def named(self, name: str) -> Camera:
        """Returns this camera with another name."""
        other = copy.copy(self)
        other.name = name
        return other

    def frame(self) -> dict[str, Any]:
        """Returns the camera as a frame of a `transforms.json`."""
        frame: dict[str, Any] = {"transform_matrix": self.opengl.tolist()}
        if self.name is not None:
            # The extension of an image goes, and full stops of the name stay.
            frame["file_path"] = f"{self.name}.exr"
        if self.resolution is not None:
            frame["w"], frame["h"] = self.resolution
        if self.intrinsics is not None:
            matrix = self.intrinsics
            frame.update(fl_x=matrix[0, 0], fl_y=matrix[1, 1], cx=matrix[0, 2], cy=matrix[1, 2])
        elif self.fov is not None:
            frame["camera_angle_x"] = math.radians(self.fov)
        else:
            raise ValueError("the camera has no lens; give fov in degrees, or intrinsics with their resolution")
        return frame

    def __repr__(self) -> str:
        place = ", ".join(f"{x:.6g}" for x in self.opengl[:3, 3])
        return f"<Camera {self.name or ''} at ({place}), fov {self.fov}>"


def cameras_of(values: Iterable[Any], fov: Optional[float]) -> list[Camera]:
    """Returns cameras. Matrices have the field of view `fov`."""
    return [value if isinstance(value, Camera) else Camera(value, fov) for value in values]
