"""The air around a scanned surface: it grows from the triangles, which stay as they are."""

from example_fixture import example  # noqa: F401


def test_the_air_grows_from_the_triangles_of_a_scanned_surface(example, tmp_path):
    rows = example("scanned_surface").main()
    before, grown = rows["without"]["air"], rows["with"]["air"]
    assert grown["ratio_99"] <= 1.32
    assert before["ratio_99"] > grown["ratio_99"] + 0.1
    assert grown["length_share_over_2"] <= 0.03
    assert before["length_share_over_2"] > 0.2
    assert (tmp_path / "scanned_surface.t13_kept.case.json").exists()
    # Node tags, coordinates to the bit, triangles and their order.
    assert len(rows["with"]["scanned"][0]) > 1000
    assert rows["with"]["surface"] == rows["with"]["scanned"]
