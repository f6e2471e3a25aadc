"""Files of pictures: how large they are, and writing them complete or not at all."""

import contextlib
import os
import struct

from errors import RenderError

# The picture is stored with as many colours as this number of bytes allows.
MAX_FILE_BYTES = 480_000
PALETTE_SIZES = (256, 192, 128, 96, 64, 48, 32)


def png_size(path):
    """Return width and height of a PNG file in pixels."""
    with open(path, "rb") as stream:
        return struct.unpack(">II", stream.read(24)[16:24])


@contextlib.contextmanager
def written_beside(path):
    """Give a path to write to, and move what is there into place if all went well."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield part
        os.replace(part, path)
    except OSError as error:
        raise RenderError(f"'{path}' cannot be written ({error.strerror}); "
                          "choose another place for it.") from None
    finally:
        if part.exists():
            part.unlink()


def save_picture(picture, path):
    """Write the PNG with few colours."""
    with written_beside(path) as part:
        for colors in PALETTE_SIZES:
            # Maximum coverage keeps the rare colours of the smallest
            # elements, k-means then lessens the mean error.
            picture.quantize(colors, method=1, kmeans=1, dither=0).save(
                part, format="PNG", optimize=True)
            if part.stat().st_size <= MAX_FILE_BYTES:
                break
