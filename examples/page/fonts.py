"""Fonts for words in pictures."""

from environment import import_pillow
from errors import RenderError


def load_font(size, bold=False):
    """Return a readable scalable font, `size` in pixels."""
    font_module = import_pillow()[2]
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    try:
        return font_module.truetype(name, size)
    except OSError:
        pass
    try:
        return font_module.load_default(size)  # bundled since Pillow 10.1
    except TypeError:
        raise RenderError("there is no readable font; install the Debian "
                          "package fonts-dejavu-core or a newer Pillow.") \
            from None


def fitting_font(text, size, width, bold=False):
    """Return the largest font up to `size` in which text fits the width."""
    while True:
        font = load_font(size, bold)
        if font.getlength(text) <= width or size <= 12:
            return font
        size -= 1
