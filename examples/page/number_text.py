"""Numbers as the page writes them: as many digits as mean something, "-" for what is unknown."""

import math

UNKNOWN = "-"


def is_number(value):
    """Whether it is a finite number; a report has None for what could not be measured."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def count(value):
    """A number of things, as 12,345."""
    return format(round(value), ",") if is_number(value) else UNKNOWN


def ratio(value):
    """A ratio with two digits behind the point, none where it is large."""
    if not is_number(value):
        return UNKNOWN
    return "%.2f" % value if abs(value) < 100 else count(value)


def quality(value):
    """A quality of elements, 0 to 1."""
    return "%.3f" % value if is_number(value) else UNKNOWN


def percent(value):
    """A share of 1 in percent."""
    return "%.1f" % (100 * value) if is_number(value) else UNKNOWN


def seconds(value):
    """A time in two digits or more, never 1e-05."""
    if not is_number(value):
        return UNKNOWN
    if value == 0:
        return "0"
    if value < 0.0095:
        return "< 0.01"
    return "%.*f" % (2 if value < 0.995 else 1 if value < 99.5 else 0, value)


def fact(value):
    """What an example tells besides: a number of any kind, or words."""
    if value is None or isinstance(value, float) and not math.isfinite(value):
        return UNKNOWN
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, float):
        return count(value) if isinstance(value, int) else str(value)
    if abs(value) >= 1000:
        return count(value)
    return "%.2f" % value if 1 <= abs(value) < 100 else "%.3g" % value
