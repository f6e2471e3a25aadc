"""Sizes on a logarithmic scale: their colours, the round ones, and how they are written."""

import math

# Colours of the sizes from small to large (ColorBrewer "RdYlBu").  All are
# light enough for dark outlines to be seen on them, and red and blue are told
# apart by colour-blind people too.
SIZE_COLORS = ((165, 0, 38), (215, 48, 39), (244, 109, 67), (253, 174, 97),
               (254, 224, 144), (255, 255, 191), (224, 243, 248),
               (171, 217, 233), (116, 173, 209), (69, 117, 180), (49, 74, 160))


def ramp_color(position):
    """Return the colour (r, g, b) at a position from 0 (small) to 1."""
    scaled = min(max(position, 0.0), 1.0) * (len(SIZE_COLORS) - 1)
    index = min(int(scaled), len(SIZE_COLORS) - 2)
    part = scaled - index
    return tuple(round(a + part * (b - a)) for a, b in
                 zip(SIZE_COLORS[index], SIZE_COLORS[index + 1]))


def tick_position(value, low, high):
    """Return the place of a size on the bar, from 0 to 1."""
    return math.log(value / low) / math.log(high / low)


def round_sizes(low, high):
    """Return round sizes within a range, the most welcome first."""
    if high > 20 * low:
        steps = [1, 2, 5]
    elif high > 3 * low:
        steps = [1, 2, 5, 3, 4, 6, 8, 1.5, 2.5]
    else:
        steps = [1, 2, 5, 3, 4, 6, 7, 8, 9] + [n / 10 for n in range(11, 100)]
    exponents = range(math.floor(math.log10(low)),
                      math.ceil(math.log10(high)) + 1)
    candidates = [step * 10.0 ** exponent for step in steps
                  for exponent in exponents]
    return [value for value in candidates if low < value < high]


def format_size(value):
    """Return a size with at most three significant digits."""
    if 1e-4 <= value < 1e5:
        digits = max(0, 2 - math.floor(math.log10(value)))
        text = f"{value:.{digits}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    number, exponent = f"{value:.2e}".split("e")
    return f"{number.rstrip('0').rstrip('.')}e{int(exponent)}"
