"""Opens a page in headless Chromium and tells what a reader would miss in it."""

import html
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

PATIENCE = 300  # seconds; it takes one or two

# Runs before anything of the page, so that errors of its scripts and pictures are heard; writes
# what was found where --dump-dom shows it.
LISTENER = """
<base href="%s">
<script>
(() => {
  const found = {script_errors: [], broken_pictures: [], dead_links: [], pictures: 0, text: ""};
  addEventListener("error", event => {
    if (event instanceof ErrorEvent) found.script_errors.push(event.message);
  }, true);
  addEventListener("unhandledrejection", event => found.script_errors.push(String(event.reason)));
  addEventListener("load", () => setTimeout(() => {
    for (const picture of document.images) {
      ++found.pictures;
      if (!picture.complete || picture.naturalWidth === 0)
        found.broken_pictures.push(picture.getAttribute("src"));
    }
    for (const link of document.querySelectorAll('a[href^="#"]')) {
      const place = link.getAttribute("href").slice(1);
      if (place !== "top" && !document.getElementById(place)) found.dead_links.push("#" + place);
    }
    found.text = document.body.innerText;
    const place = document.createElement("pre");
    place.id = "found-by-the-test";
    place.textContent = JSON.stringify(found);
    document.body.append(place);
  }, 100));
})();
</script>
"""


def program():
    """Path of Chromium."""
    path = shutil.which("chromium") or shutil.which("chromium-browser")
    assert path, "Chromium is not installed: tests/run.sh installs it"
    return path


def look_at(page, folder):
    """Opens the page and returns what was found.

    script_errors, broken_pictures, dead_links: lists of texts; dead are links within the page
    console:  lines that Chromium told developers, of files not found and the like
    pictures: how many there are
    text:     what is to be read
    folder:   for a copy of the page and for Chromium's own files; nothing else is written
    """
    source = Path(page).read_text(encoding="utf-8")
    listening = re.sub(r"(<head[^>]*>)", lambda head: head.group() + LISTENER % Path(page).as_uri(),
                       source, count=1)
    assert listening != source, "the page has no <head>"
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    copy = folder / "listening.html"
    copy.write_text(listening, encoding="utf-8")
    chromium = subprocess.run(
        [program(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
         "--no-first-run", "--disable-background-networking", "--disable-extensions",
         "--user-data-dir=%s" % (folder / "profile"), "--allow-file-access-from-files",
         "--enable-logging=stderr", "--v=0", "--virtual-time-budget=10000",
         "--window-size=1300,2000", "--dump-dom", copy.as_uri()],
        # As root, with no home or the home of another: Chromium's files are all in the folder.
        env=dict(os.environ, HOME=str(folder), XDG_CONFIG_HOME=str(folder / "config"),
                 XDG_CACHE_HOME=str(folder / "cache"), XDG_RUNTIME_DIR=str(folder)),
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=PATIENCE,
        encoding="utf-8", errors="replace")
    written = re.search(r'<pre id="found-by-the-test">(.*?)</pre>', chromium.stdout, re.DOTALL)
    assert written, "Chromium did not show the page:\n" + chromium.stderr[-2000:]
    found = json.loads(html.unescape(written.group(1)))
    found["console"] = [line for line in chromium.stderr.splitlines() if ":CONSOLE" in line]
    return found


def faults(found):
    """Everything that is wrong, as one list of texts."""
    return ["script error: " + text for text in found["script_errors"]] + [
        "broken picture: " + text for text in found["broken_pictures"]] + [
        "dead link: " + text for text in found["dead_links"]] + [
        "console: " + text for text in found["console"]]
