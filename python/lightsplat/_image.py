"""Images as NumPy arrays."""

import numpy
import OpenEXR


class Image(numpy.ndarray):
    """A float32 array of height x width x 3: radiance in W/(sr m^2), linear Rec. 709, rows from the top.

    `stats` is the dictionary of `lightsplat render --stats json`. `layers` holds the other layers of the file by their
    names, like `depth`: arrays of height x width, or with an axis for their channels. Copies and results of arithmetic
    are arrays without both.
    """

    stats = None
    layers = None

    @classmethod
    def read(cls, path, stats):
        """Reads an OpenEXR file of the program."""
        with OpenEXR.File(path, separate_channels=True) as file:
            channels = {name: channel.pixels for name, channel in file.channels().items()}
        # A copy by `stack` belongs to nothing that the file's end would free.
        image = numpy.stack([channels.pop(name) for name in "RGB"], axis=-1).view(cls)
        image.stats = stats
        image.layers = _layers(channels)
        return image

    def __array_wrap__(self, array, context=None, return_scalar=False):
        return array[()] if return_scalar or array.ndim == 0 else array.view(numpy.ndarray)

    def __reduce__(self):
        kind, arguments, state = super().__reduce__()
        return kind, arguments, (state, self.stats, self.layers)

    def __setstate__(self, state):
        state, self.stats, self.layers = state
        super().__setstate__(state)


# Order of the channels of a layer.
ORDER = ["R", "G", "B", "A", "X", "Y", "Z"]


def _layers(channels):
    """Returns the layers of channels: `normal.X`, `normal.Y` and `normal.Z` make `normal`."""
    groups = {}
    for name, pixels in channels.items():
        layer, _, part = name.rpartition(".")
        groups.setdefault(layer or name, {})[part if layer else ""] = pixels
    return {layer: _joined(parts) for layer, parts in groups.items()}


def _joined(parts):
    names = sorted(parts, key=lambda name: ORDER.index(name) if name in ORDER else len(ORDER))
    if len(names) == 1:
        return numpy.array(parts[names[0]])
    return numpy.stack([parts[name] for name in names], axis=-1)
