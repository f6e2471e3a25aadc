#!/usr/bin/env python3
"""Make one page of the cases that the examples left in a folder.

    make_page.py [folder]           # default: $MESHGROW_EXAMPLES_OUT or examples/out

Reads *.case.json (see cases.py) and writes index.html beside them.  The page
needs nothing but the pictures in the same folder: no script, no network.

Needs: Jinja2 (PyPI: jinja2; Debian: python3-jinja2)
"""

import json
import sys
from pathlib import Path

from cases import OUT
from errors import RenderError, tidy
from page_model import HEADINGS, MEANINGS, describe
from picture_file import written_beside
from size_scale import SIZE_COLORS

FOLDER = Path(__file__).resolve().parent


def read_cases(folder):
    """Return the records of the cases, in the order of their file names."""
    records = []
    for path in sorted(folder.glob("*.case.json")):
        try:
            records.append(json.loads(path.read_text(encoding="utf-8")))
        except ValueError as error:
            raise RenderError(f"'{path}' is no case ({tidy(error)}); run its example again, or "
                              "remove the file.") from None
    return records


def fill_in(examples):
    """Return the text of the page."""
    try:
        import jinja2
    except ImportError:
        raise RenderError("Jinja2 is missing; run 'pip install jinja2' or install the Debian "
                          "package python3-jinja2.") from None
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(FOLDER), autoescape=True,
                                     undefined=jinja2.StrictUndefined)
    # A long list of tags may go on in the next line, and is copied without anything in it.
    markup = jinja2.utils.markupsafe.Markup
    environment.filters["breakable"] = lambda text: markup(",<wbr>").join(text.split(","))
    style = (FOLDER / "page.css").read_text(encoding="utf-8")
    colors = ", ".join("rgb(%d %d %d)" % color for color in SIZE_COLORS)
    return environment.get_template("page.html.jinja").render(
        style=markup(style), colors=colors, headings=HEADINGS,
        meanings=MEANINGS, examples=examples,
        cases=[case for example in examples for case in example["cases"]])


def make_page(folder):
    """Write the page of a folder, complete or not at all; return its path and number of cases."""
    records = read_cases(folder)
    try:
        text = fill_in(describe(records, folder))
    except KeyError as error:
        raise RenderError(f"a case in '{folder}' has no {error}; run the examples again.") from None
    page = folder / "index.html"
    with written_beside(page) as part:
        # A lone half of a surrogate pair, possible in JSON, must not be the end of the page.
        part.write_bytes(text.encode("utf-8", "replace"))
    return page, len(records)


def main(arguments):
    """Run the program; return its exit code."""
    if len(arguments) > 1 or arguments[:1] in (["-h"], ["--help"]):
        print(__doc__)
        return 0 if len(arguments) == 1 else 2
    folder = Path(arguments[0] if arguments else OUT).resolve()
    if not folder.is_dir():
        print(f"make_page: there is no folder '{folder}', run the examples first.", file=sys.stderr)
        return 1
    try:
        page, count = make_page(folder)
    except RenderError as error:
        print(f"make_page: {error}", file=sys.stderr)
        return 1
    print(f"{page}: {count} {'case' if count == 1 else 'cases'}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
