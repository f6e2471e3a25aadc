"""Sums up runs of soak.py: python summary.py RESULTS.jsonl... ; fails where the library did."""

import collections
import json
import sys

from checks import MANY

STEEP = 1.5  # the most that 99 % of neighbours may differ by


def reason(failure):
    """Why a model was not meshed, in words, and whether that is Gmsh's doing."""
    status, message = failure["status"], failure.get("message", "")
    if status == "gmsh":
        return "Gmsh fails before the library is asked", True
    if status == "mistake":
        return "mistake in the soak itself", False
    alone = [failure[mode] for mode in ("plain", "callback") if mode in failure]
    if any(other["status"] in ("gmsh", "crash", status) for other in alone):
        return "Gmsh fails in its own order as well, with sizes alike", True
    if status == "error" and message.startswith("Gmsh gave "):
        return "Gmsh has to split a curve that has a mesh: refused", True
    if status == "error" and failure.get("same_faces") and "Gmsh:" in message:
        return "Gmsh fails alone as well from the meshes that it made of the faces", True
    return status, False


def cause(volume):
    """Why sizes jump in a volume, as its measurements tell."""
    facts, report = volume["causes"], volume["report"]
    faces, before = facts["on_faces"], facts.get("on_premeshed")
    if before and facts["bad_at_premeshed"] > 0.5:
        if before["ratio_99"] > 1.4 or before["ratio_max"] > 1.8:
            return "the mesh from before jumps itself"
        if (before["length_share_over_2"] or 0) > 0.05:
            return "the mesh from before is coarser than asked for there"
        if (before["length_median"] or 1) < 0.7:
            return "the mesh from before is finer than asked for there, and no source"
    if (faces["length_median"] or 1) < 0.75 or (report["length_median"] or 1) < 0.75:
        return "faces are finer than its functions ask for, by those of neighbours"
    if (faces["length_share_over_2"] or 0) > 0.05:
        return "faces are coarser than asked for"
    if volume["tetrahedra"] < 2.5 * faces["elements"]:
        return "thin: hardly more tetrahedra than triangles around"
    return "none found"


def judged(results):
    """Attached volumes with many tetrahedra: (seed, volume)."""
    return [(r["seed"], v) for r in results for v in r.get("volumes", ())
            if v["tetrahedra"] > MANY]


def is_steep(volume):
    return volume["report"]["ratio_99"] > STEEP


def broken_promises(results):
    """What the library must not do, as lines of text."""
    lines = []
    for result in results:
        for problem in result.get("differences", []) + result.get("invalid", []):
            lines.append("seed %d: %s" % (result["seed"], problem))
        if result["status"] != "meshed" and not reason(result)[1]:
            lines.append("seed %d: %s: %s" % (result["seed"], reason(result)[0],
                                              result.get("message")))
    return lines


def grouped(pairs):
    groups = collections.defaultdict(list)
    for key, value in pairs:
        groups[key].append(value)
    return sorted(groups.items(), key=lambda group: -len(group[1]))


def summary(results):
    meshed = [r for r in results if r["status"] == "meshed"]
    failed = [r for r in results if r["status"] != "meshed"]
    volumes = judged(results)
    steep = [(seed, v) for seed, v in volumes if is_steep(v)]
    kept = [r for r in results if r.get("premeshed")]
    changed = [r for r in kept if any(d.startswith(("node", "coord", "elem"))
                                      for d in r["differences"])]
    tetrahedra = sorted(r["tetrahedra"] for r in meshed)
    rows = [
        ("models", len(results)),
        ("meshed", len(meshed)),
        ("not meshed: by Gmsh", sum(reason(r)[1] for r in failed)),
        ("not meshed: by the library", sum(not reason(r)[1] for r in failed)),
        ("with meshes from before", len(kept)),
        ("  of these changed", len(changed)),
        ("options or visibility changed, mesh invalid",
         len([r for r in results if r.get("invalid") or r.get("differences")]) - len(changed)),
        ("tetrahedra, median and most", "%d, %d" % (tetrahedra[len(tetrahedra) // 2],
                                                    tetrahedra[-1]) if meshed else "-"),
        ("attached volumes of > %d tetrahedra" % MANY, len(volumes)),
        ("  99 %% ratio <= %g" % STEEP, "%d (%.2f %%)" % (
            len(volumes) - len(steep), 100 - 100 * len(steep) / max(1, len(volumes))))]
    lines = ["%-46s %s" % row for row in rows]
    for text, seeds in grouped((reason(r)[0], r["seed"]) for r in failed):
        lines.append("not meshed, %s: %d: %s" % (text, len(seeds), seeds))
    for text, places in grouped((cause(v), "%d/%d %.2f" % (seed, v["volume"],
                                                           v["report"]["ratio_99"]))
                                for seed, v in steep):
        lines.append("ratio, %s: %d: seed/volume %s" % (text, len(places), ", ".join(places)))
    return "\n".join(lines + broken_promises(results))


def read(path):
    """Results, the last one of each seed."""
    with open(path) as file:
        return list({r["seed"]: r for r in map(json.loads, file)}.values())


def main():
    broken = False
    for path in sys.argv[1:]:
        results = read(path)
        print("\n== Gmsh %s (%s)\n%s" % (results[0]["gmsh"], path, summary(results)))
        broken = broken or bool(broken_promises(results))
    sys.exit(broken)


if __name__ == "__main__":
    main()
