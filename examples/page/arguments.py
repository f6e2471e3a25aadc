"""Values of the command line: numbers and tags between commas, planes, views."""

import argparse
import math
import re


def parse_numbers(text, count, meaning):
    """Return `count` finite numbers from comma-separated text."""
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not all(map(math.isfinite, values)):
        raise argparse.ArgumentTypeError(
            f"expected {count} comma-separated numbers ({meaning}), "
            f"got '{text}'")
    return values


def parse_plane(text):
    """Return [x, y, z, nx, ny, nz] with a unit normal."""
    values = parse_numbers(text, 6, "x,y,z,nx,ny,nz")
    length = math.hypot(*values[3:])
    if length == 0:
        raise argparse.ArgumentTypeError("the normal nx,ny,nz must not be 0")
    return values[:3] + [component / length for component in values[3:]]


def parse_focus(text):
    """Return [x, y, z, radius] with a positive radius."""
    values = parse_numbers(text, 4, "x,y,z,radius")
    if values[3] <= 0:
        raise argparse.ArgumentTypeError("the radius must be positive")
    return values


def parse_view(text):
    """Return 'front', 'iso' or three angles in degrees."""
    if text in ("front", "iso"):
        return text
    return parse_numbers(text, 3, "or the words front or iso")


def parse_zoom(text):
    """Return a positive factor."""
    value, = parse_numbers(text, 1, "the zoom factor")
    if value <= 0:
        raise argparse.ArgumentTypeError("the zoom factor must be positive")
    return value


def parse_tags(text):
    """Return a list of entity tags from comma-separated text."""
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"expected comma-separated volume tags, got '{text}'") from None


def join_negative_values(arguments):
    """Write '--plane -1,0,..' as '--plane=-1,0,..'.

    argparse would take a value that starts with a minus sign for an option.
    """
    joined = []
    for argument in arguments:
        if (joined and joined[-1] in ("--plane", "--focus", "--view")
                and re.match(r"-[\d.]", argument)):
            joined[-1] += "=" + argument
        else:
            joined.append(argument)
    return joined


class OneSentenceParser(argparse.ArgumentParser):
    """An argument parser whose errors are one line, without the usage."""

    def error(self, message):
        """Print the message, say where help is found, and exit with 2."""
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help).\n")
