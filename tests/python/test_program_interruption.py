"""Ctrl-C in the program, and what it shows of its progress."""

import os
import pty
import signal
import subprocess

import pytest

from program import PROGRAM

BALL = """
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 0.3};
Box(2) = {-1, -1, -1, 2, 2, 2};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
"""
FINE = "fixed source Surface{1} attach Volume{:} size 0.02 growth 1.02 limit 0.03"
COARSE = "fixed source Surface{1} attach Volume{:} size 0.1 growth 1.3 limit 0.5"


@pytest.fixture
def directory(tmp_path):
    (tmp_path / "ball.geo").write_text(BALL)
    (tmp_path / "out.msh").write_text("of before")
    return tmp_path


def start(directory, *arguments, **options):
    return subprocess.Popen([PROGRAM, "mesh", "ball.geo", "-o", "out.msh", *arguments],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            cwd=directory, **options)


def wait_for(process, *words):
    for line in process.stdout:
        if all(word in line for word in words):
            return line
    raise AssertionError("never told: %s %s" % (words, process.stderr.read()))


# Each would go on for long: minutes of meshing, or of building a grid.
LONG = {
    "Gmsh's own run": (["-3", "-clmax", "0.005"], ["No size function"]),
    "a pass": (["-3", "--size-function", FINE.replace("0.02 ", "0.004 ").replace("0.03", "0.005"),
                "--evaluator", "exact"], ["Meshing, pass", "Surface 1"]),
    "a grid": (["-1", "--size-function", COARSE.replace("0.1 ", "0.0015 "), "--evaluator", "grid",
                "--tolerance", "0.0005"],
               ["Background grid", " %"]),
}


@pytest.mark.parametrize("what", LONG)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_the_program_at_once_and_leaves_files_as_they_were(directory, what,
                                                                             number):
    arguments, line = LONG[what]
    process = start(directory, *arguments, "--report", "report.json")
    wait_for(process, *line)
    process.send_signal(number)
    _, errors = process.communicate()
    assert process.returncode == 128 + number
    assert errors.splitlines()[-1] == "meshgrow: Interrupted: no mesh was written."
    assert (directory / "out.msh").read_text() == "of before"
    assert sorted(p.name for p in directory.iterdir()) == ["ball.geo", "out.msh"]


def test_an_ignored_interrupt_stays_ignored(directory):
    """As for a program that a script starts in the background."""
    process = start(directory, "-3", "--size-function", COARSE, preexec_fn=lambda: signal.signal(
        signal.SIGINT, signal.SIG_IGN))
    wait_for(process, "Meshing, pass")
    process.send_signal(signal.SIGINT)
    assert process.communicate() and process.returncode == 0
    assert (directory / "out.msh").stat().st_size > 1000


def test_a_pipe_gets_plain_lines(directory):
    text, _ = start(directory, "-3", "--size-function", COARSE).communicate()
    assert "Meshing, pass 1 of" in text and "\r" not in text and "\033" not in text
    assert "passes done" not in text


def test_a_terminal_gets_a_bar(directory):
    controller, terminal = pty.openpty()
    process = subprocess.Popen([PROGRAM, "mesh", "ball.geo", "-o", "out.msh", "--size-function",
                                FINE, "-2"], stdout=terminal, stderr=terminal, cwd=directory)
    os.close(terminal)
    text = b""
    try:
        while True:
            part = os.read(controller, 65536)
            if not part:
                break
            text += part
    except OSError:
        pass  # the program has closed the terminal
    os.close(controller)
    assert process.wait() == 0
    shown = text.decode()
    passes = int(shown.split("Meshing, pass 1 of ")[1].split()[0])
    for done in range(passes):
        assert "] %d of %d passes done" % (done, passes) in shown
    assert shown.rstrip().splitlines()[-1].startswith("Wrote out.msh")
    assert "passes done" not in shown.rsplit("\r\033[K", 1)[1]
