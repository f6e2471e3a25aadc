"""Puts the drawn meshes side by side, with titles above and the legend below."""

import numpy as np

from environment import import_pillow
from errors import RenderError
from fonts import fitting_font
from legend import draw_legend
from panel import PANEL_PIXELS


def trim_common(panels):
    """Shrink the panels, and cut off the white that all of them have.

    Raises RenderError if nothing is drawn in any of them.
    """
    image, _, _ = import_pillow()
    panels = [panel.resize((PANEL_PIXELS, PANEL_PIXELS), image.LANCZOS)
              for panel in panels]
    inked = np.any([np.asarray(panel).min(axis=2) < 250 for panel in panels],
                   axis=0)
    if not inked.any():
        raise RenderError("no element is in the picture; change --plane, "
                          "--focus or --zoom.")
    rows, columns = (np.flatnonzero(inked.any(axis=axis)) for axis in (1, 0))
    box = (max(columns[0] - 8, 0), max(rows[0] - 8, 0),
           min(columns[-1] + 9, PANEL_PIXELS), min(rows[-1] + 9, PANEL_PIXELS))
    return [panel.crop(tuple(map(int, box))) for panel in panels]


def compose(panels, captions, size_range):
    """Return the whole picture.

    captions: a pair (title, number of elements) of texts for each panel
    """
    image, image_draw, _ = import_pillow()
    panels = trim_common(panels)
    width, height = panels[0].size
    column = max(width, 760)  # room for titles over a slender mesh
    margin, gap, heading, legend = 30, 50, 126, 190
    total = 2 * margin + len(panels) * column + (len(panels) - 1) * gap
    picture = image.new("RGB", (total, heading + height + legend), "white")
    draw = image_draw.Draw(picture)
    longest = max((title for title, _ in captions), key=len)
    title_font = fitting_font(longest, 42, column, bold=True)
    for index, (panel, (title, count)) in enumerate(zip(panels, captions)):
        left = margin + index * (column + gap)
        picture.paste(panel, (left + (column - width) // 2, heading))
        middle = left + column / 2
        draw.text((middle, 60), title, "black", anchor="ms",
                  font=title_font)
        draw.text((middle, 104), count, (70, 70, 70), anchor="ms",
                  font=fitting_font(count, 34, column))
    draw_legend(draw, heading + height + 28, total, size_range)
    return picture
