import gmsh
import pytest


@pytest.fixture(autouse=True)
def gmsh_session():
    gmsh.initialize(readConfigFiles=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    yield
    if is_open():
        gmsh.finalize()


def is_open():
    """Whether a test has left Gmsh initialized (gmsh.isInitialized is younger than 4.8)."""
    try:
        gmsh.option.getNumber("General.Terminal")
    except Exception:
        return False
    return True
