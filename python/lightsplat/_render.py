"""`lightsplat.render` and `lightsplat.views`."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterable, Optional, Union

from ._arguments import to_options
from ._run import Progress, run

if TYPE_CHECKING:
    from ._camera import Camera
    from ._image import Image

PathLike = Union[str, "os.PathLike[str]"]


def render(
    scene: PathLike,
    output: Optional[PathLike] = None,
    *,
    camera: Any = None,
    progress: Progress = None,
    **options: Any,
) -> Image:
    """Renders a scene by the program `lightsplat`, and returns an `Image`.

    `scene` is a file, or the name of a built-in scene like "kitchen".
    `output` keeps the image as this OpenEXR file, with its PNG beside it, unless `png` names another.
    `camera` is a camera of the scene by number or name, a `Camera`, or a 4 x 4 matrix from camera to world, as in OpenGL.
    A matrix needs `fov`. With a matrix or a `Camera`, `options` are those of `lightsplat views`.
    `progress` is called with the part of the run that is done, 0 to 1.
    `options` are those of `lightsplat render`, with `_` for `-`. `True` is a flag. Sequences are lists:
    `resolution=(640, 360)`, `look_from=(0, 1, 4)`, `aov=["depth", "normal"]`, `denoise=False`. With `background="none"`,
    the image is premultiplied, and `layers["A"]` is its alpha.

    Raises `UsageError`, `SceneError`, `OutputError` or another `Error`, with the message of the program.
    """
    if output is not None and Path(output).suffix.lower() != ".exr":
        raise ValueError(f"output is an OpenEXR file, and {os.fspath(output)!r} ends otherwise; "
                         "`develop` makes the pixels of a PNG")
    if camera is not None and not isinstance(camera, (int, str)):
        return _placed(scene, output, camera, progress, options)
    words = ["render", os.fspath(scene), "--stats=json", *to_options({"camera": camera, **options})]
    if output is not None:
        return _read(json.loads(run([*words, f"--output={os.fspath(output)}"], progress)), is_kept=True)
    with tempfile.TemporaryDirectory(prefix="lightsplat-") as folder:
        file = str(Path(folder, "image.exr"))
        own = [] if "png" in options else ["--no-png"]
        return _read(json.loads(run([*words, f"--output={file}", *own], progress)), is_kept=False)


def views(
    scene: PathLike,
    cameras: PathLike | Iterable[Any],
    output: Optional[PathLike] = None,
    *,
    fov: Optional[float] = None,
    progress: Progress = None,
    **options: Any,
) -> list[Image]:
    """Renders many cameras of one scene in one process, which reads the scene once, and returns an `Image` of each.

    `cameras` is a list of `Camera`s, and of 4 x 4 matrices from camera to world with the horizontal field of view `fov`
    in degrees. Or it is a file: a `transforms.json`, a TOML list, or a scene whose cameras are taken.
    `output` keeps the files in this folder. `progress` is called with the part of the run that is done, 0 to 1.
    `options` are those of `lightsplat views`, with `_` for `-`, as for `render`. With `resume=True`, only images that
    lacked are returned.

    Raises `UsageError`, `SceneError`, `OutputError` or another `Error`, with the message of the program.
    """
    with tempfile.TemporaryDirectory(prefix="lightsplat-") as folder:
        if not isinstance(cameras, (str, os.PathLike)):
            from ._camera import cameras_of
            cameras = _listed(cameras_of(cameras, fov), folder)
        own = [] if output is not None else ["--no-png"]
        target = os.fspath(folder if output is None else output)
        words = ["views", os.fspath(scene), os.fspath(cameras), f"--output={target}", "--stats=json"]
        stats = [json.loads(line) for line in run([*words, *own, *to_options(options)], progress).splitlines()]
        stats.sort(key=lambda view: view["frame"])
        return [_read(view, is_kept=output is not None) for view in stats]


def _placed(scene: PathLike, output: Optional[PathLike], camera: Any, progress: Progress, options: dict[str, Any]) -> Image:
    """Renders from a `Camera` or a matrix: a list of one."""
    from ._camera import cameras_of

    options = dict(options)
    [placed] = cameras_of([camera], options.pop("fov", None))
    if output is None:
        [image] = views(scene, [placed], progress=progress, **options)
        return image
    [image] = views(scene, [placed.named(Path(output).stem)], Path(output).parent, progress=progress, **options)
    return image


def _listed(cameras: list[Camera], folder: str) -> Path:
    """Writes a list of cameras, and returns its file."""
    path = Path(folder, "transforms.json")
    path.write_text(json.dumps({"frames": [camera.frame() for camera in cameras]}), encoding="utf-8")
    return path


def _read(stats: dict[str, Any], is_kept: bool) -> Image:
    """Reads the image of a run. Files that are not kept are gone when the caller reads their names."""
    from ._image import Image

    run = stats["run"]
    file = run["output"] if is_kept else run.pop("output")
    return Image.read(file, stats)
