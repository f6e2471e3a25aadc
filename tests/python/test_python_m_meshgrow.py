"""`python -m meshgrow`, which is also what pip installs as `meshgrow`: the program, with the Gmsh
of this Python."""

import os
import shutil
import subprocess
import sys

import gmsh
import meshgrow

PACKAGE = os.path.dirname(os.path.abspath(meshgrow.__file__))


def run_module(*arguments, package_in=os.path.dirname(PACKAGE), **environment):
    """The program as started by Python; a variable that is None is not set."""
    variables = dict(os.environ, PYTHONPATH=package_in)
    for name, value in environment.items():
        if value is None:
            variables.pop(name, None)
        else:
            variables[name] = value
    return subprocess.run([sys.executable, "-m", "meshgrow", *arguments], capture_output=True,
                          text=True, env=variables)


def test_it_finds_the_gmsh_of_this_python():
    version = gmsh.option.getString("General.Version")
    result = run_module("--version", MESHGROW_GMSH_LIB=None)
    assert result.returncode == 0
    assert " with Gmsh %s (" % version in result.stdout


def test_a_gmsh_that_the_user_names_comes_first():
    named = run_module("--version", MESHGROW_GMSH_LIB="/nowhere/libgmsh.so")
    assert "without Gmsh" in named.stdout and "/nowhere/libgmsh.so" in named.stdout


def test_arguments_and_exit_code_pass_through():
    refused = run_module("mesh", "missing one.geo")
    assert refused.returncode == 2
    assert "missing one.geo" in refused.stderr


def test_a_package_without_its_program_says_where_it_looked(tmp_path):
    shutil.copytree(PACKAGE, tmp_path / "python" / "meshgrow")
    result = run_module("--version", package_in=str(tmp_path / "python"))
    assert result.returncode == 1
    assert str(tmp_path / "bin" / "meshgrow") in result.stderr
    assert "build or install meshgrow" in result.stderr
