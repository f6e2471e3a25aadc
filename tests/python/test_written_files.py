"""Files that we write are there completely, or as before: a full disk, a kill, places that no file
can have."""

import os
import resource
import shutil
import signal
import subprocess

import gmsh
import meshgrow
import pytest

import child
import models
from program import PROGRAM, run

HERE = os.path.dirname(os.path.abspath(__file__))
BALL = """
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 1};
Mesh.MeshSizeMax = 0.08;
"""
FIXED_FIELD = ["--size-function",
               "fixed source Surface{1} attach Volume{1} size 0.05 growth 1.2 limit 0.5"]
PRECIOUS = "of before"
OUTPUTS = ["sizes.mgf", "sizes.vtu", "sizes.pos", "sizes.msh", "mesh.msh", "mesh.stl",
           "report.json"]
FIELDS = OUTPUTS[:4]
#: More than the temporary files that Gmsh and we need, less than any output but the report.
ROOM = 150000


@pytest.fixture
def ball(tmp_path):
    path = tmp_path / "ball.geo"
    path.write_text(BALL)
    return path


@pytest.fixture(scope="session")
def failing_writes(tmp_path_factory):
    if shutil.which("cc") is None:
        pytest.skip("no C compiler")
    path = tmp_path_factory.mktemp("library") / "failing_writes.so"
    subprocess.run(["cc", "-shared", "-fPIC", "-o", str(path),
                    os.path.join(HERE, "failing_writes.c"), "-ldl"], check=True)
    return str(path)


def command(ball, output):
    if output in FIELDS:
        return ["field", ball, "-o", ball.parent / output, *FIXED_FIELD]
    if output == "report.json":
        return ["mesh", ball, "-2", "-o", ball.parent / "a.msh", "--report", ball.parent / output]
    return ["mesh", ball, "-2", "-o", ball.parent / output]


def run_with_room(arguments, is_ignored):
    """The program, whose files can have ROOM bytes. Where the signal of that is not ignored, the
    process ends at once at the first byte more, as it would when it is killed."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN if is_ignored else signal.SIG_DFL)
        resource.setrlimit(resource.RLIMIT_FSIZE, (ROOM, ROOM))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          preexec_fn=limit)


def names(folder):
    return sorted(p.name for p in folder.iterdir())


def assert_refused(result, code, *words):
    assert result.returncode == code, result.stderr
    told = [line for line in result.stderr.splitlines() if line.startswith("meshgrow: ")]
    assert len(told) == 1, result.stderr
    for word in words:
        assert word in told[0], told[0]


@pytest.mark.parametrize("output", OUTPUTS[:-1])
def test_a_full_disk_leaves_the_old_file(ball, output):
    place = ball.parent / output
    place.write_text(PRECIOUS)
    before = names(ball.parent)
    result = run_with_room(command(ball, output), is_ignored=True)
    assert_refused(result, 1, output, "make room")
    assert place.read_text() == PRECIOUS
    assert names(ball.parent) == before


def test_a_full_disk_leaves_the_old_report(ball, failing_writes):
    place = ball.parent / "report.json"
    place.write_text(PRECIOUS)
    assert_refused(run(*command(ball, "report.json"), LD_PRELOAD=failing_writes,
                       FAIL_WRITES="full", FAIL_FILE=".json"), 1, "report.json", "No space left")
    assert place.read_text() == PRECIOUS
    assert names(ball.parent) == ["a.msh", "ball.geo", "report.json"]  # the mesh was written before


@pytest.mark.parametrize("output", OUTPUTS[:-1])
def test_a_kill_while_writing_leaves_the_old_file(ball, output):
    place = ball.parent / output
    place.write_text(PRECIOUS)
    assert run_with_room(command(ball, output), is_ignored=False).returncode == -signal.SIGXFSZ
    assert place.read_text() == PRECIOUS
    assert run(*command(ball, output)).returncode == 0
    assert place.stat().st_size > ROOM
    assert names(ball.parent) == sorted(["ball.geo", output])  # what the kill left is gone


@pytest.mark.parametrize("output, when", [("sizes.mgf", "kill"), ("sizes.pos", "move"),
                                          ("mesh.msh", "move"), ("report.json", "move")])
def test_sigkill_leaves_the_old_file(ball, failing_writes, output, when):
    place = ball.parent / output
    place.write_text(PRECIOUS)
    killed = run(*command(ball, output), LD_PRELOAD=failing_writes, FAIL_WRITES=when)
    assert killed.returncode == -signal.SIGKILL
    assert place.read_text() == PRECIOUS
    assert run(*command(ball, output)).returncode == 0
    assert place.read_bytes() != PRECIOUS.encode()
    assert set(names(ball.parent)) - {"a.msh"} == {"ball.geo", output}


@pytest.mark.parametrize("model", ["ball.geo", "saved.mgf"])
def test_an_interrupt_while_a_field_is_written_leaves_the_old_file(ball, failing_writes, model):
    if model == "saved.mgf":
        assert run("field", ball, "-o", ball.parent / model, *FIXED_FIELD).returncode == 0
    place = ball.parent / "sizes.vtu"
    place.write_text(PRECIOUS)
    before = names(ball.parent)
    options = FIXED_FIELD if model == "ball.geo" else []
    stopped = run("field", ball.parent / model, "-o", place, *options,
                  LD_PRELOAD=failing_writes, FAIL_WRITES="interrupt")
    assert stopped.returncode == 130
    assert stopped.stderr.splitlines()[-1] == (
        "meshgrow: Interrupted: no size field was written.")
    assert place.read_text() == PRECIOUS
    assert names(ball.parent) == before


def test_an_interrupt_while_python_writes_is_raised_and_leaves_a_whole_file(tmp_path,
                                                                            failing_writes):
    """It comes too late to stop what takes no time."""
    path = tmp_path / "sizes.mgf"
    path.write_text(PRECIOUS)
    assert child.run_child("""
import os, signal
import gmsh
import meshgrow
import models
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
signal.signal(signal.SIGINT, signal.default_int_handler)
volume = models.single(lambda occ: occ.addSphere(0, 0, 0, 1))
field = meshgrow.SizeField(evaluator="grid")
field.add_fixed(gmsh.model.getEntities(2), [volume], 0.05, 1.2, 0.5)
field.refresh()
try:
    field.save(%r)
except KeyboardInterrupt:
    print("interrupted")
print("%%.5f" %% meshgrow.SizeField.load(%r).size(*volume, [[1, 0, 0]])[0])
""" % (str(path), str(path)), LD_PRELOAD=failing_writes, FAIL_WRITES="interrupt") == [
        "interrupted", "0.05000"]
    assert names(tmp_path) == ["sizes.mgf"]


def test_python_is_told_of_a_full_disk(tmp_path):
    volume = models.single(lambda occ: occ.addSphere(0, 0, 0, 1))
    field = meshgrow.SizeField(evaluator="grid")
    field.add_fixed(gmsh.model.getEntities(2), [volume], 0.05, 1.2, 0.5)
    field.refresh()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    for name in FIELDS:
        path = tmp_path / name
        path.write_text(PRECIOUS)
        resource.setrlimit(resource.RLIMIT_FSIZE, (10000, hard))  # Python ignores the signal
        try:
            with pytest.raises(meshgrow.Error, match="%s .*room" % name):
                field.save(path) if name.endswith(".mgf") else field.write_view(path)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        assert path.read_text() == PRECIOUS
    assert names(tmp_path) == sorted(FIELDS)
    field.save(tmp_path / FIELDS[0])
    assert (tmp_path / FIELDS[0]).stat().st_size > 10000


def test_standard_output_that_is_full_is_told(ball):
    assert run(*command(ball, "mesh.msh")).returncode == 0
    with open("/dev/full", "w") as full:
        result = subprocess.run([PROGRAM, "report", str(ball.parent / "mesh.msh"), "--dim", "2",
                                 "--json"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert_refused(result, 1, "standard output")


# ==== Places that no file can have


@pytest.mark.parametrize("output", OUTPUTS)
@pytest.mark.parametrize("place", ["a file in place of the directory", "a directory", "a pipe"])
def test_a_place_that_no_file_can_have_is_refused(ball, output, place):
    path = ball.parent / output
    arguments = command(ball, output)
    if place == "a directory":
        path.mkdir()
    elif place == "a pipe":
        os.mkfifo(path)
    else:
        (ball.parent / "file").write_text(PRECIOUS)
        arguments = [str(a).replace(str(path), str(ball.parent / "file" / output))
                     for a in arguments]
    before = names(ball.parent)
    result = run(*arguments)
    assert_refused(result, result.returncode, "Cannot write", output)
    assert result.returncode in (1, 2)
    assert names(ball.parent) == before


@pytest.mark.parametrize("output", ["sizes.mgf", "sizes.vtu", "mesh.msh", "report.json"])
def test_a_read_only_directory_is_told(ball, output):
    folder, other = ball.parent / "closed", ball.parent / "open"
    folder.mkdir(mode=0o555)
    other.mkdir()
    other.chmod(0o777)
    arguments = [str(a).replace(str(ball.parent / output), str(folder / output))
                 for a in command(ball, output)]
    if output == "report.json":
        arguments[arguments.index("-o") + 1] = str(other / "a.msh")
    nobody = 65534

    def become_nobody():
        if os.geteuid() != 0:
            return  # root may write anywhere, others may not
        os.setgroups([])
        os.setgid(nobody)
        os.setuid(nobody)
    for part in ball.parents:  # pytest's own are closed to others
        if "pytest" in part.name or part == ball.parent:
            part.chmod(0o755)
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                            preexec_fn=become_nobody)
    if "No libgmsh" in result.stderr or "does not name a libgmsh" in result.stderr:
        pytest.skip("nobody cannot read the library")
    assert_refused(result, result.returncode, "Cannot write", output, "Permission denied")
    assert names(folder) == []


def test_a_link_stays_a_link(ball):
    place, link = ball.parent / "real.mgf", ball.parent / "sizes.mgf"
    place.write_text(PRECIOUS)
    link.symlink_to(place.name)
    assert run(*command(ball, "sizes.mgf")).returncode == 0
    assert link.is_symlink() and place.stat().st_size > ROOM
    assert names(ball.parent) == ["ball.geo", "real.mgf", "sizes.mgf"]
