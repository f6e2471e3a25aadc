"""Sums up runs of soak.py: python summary.py RESULTS.jsonl... ; fails where the library did."""

import collections
import json
import re
import sys

from checks import MANY, STEEP

FAST = 1.4  # growth rate with which neighbours differ by about STEEP, as Gmsh's sizes scatter
NONE_FOUND = "none found"


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
    if message.startswith("Gmsh gave ") and failure.get("meshed_before", True):
        return "Gmsh would have to split a curve that was meshed before: refused", True
    if status == "error" and failure.get("same_faces") and "Gmsh:" in message:
        return "Gmsh fails alone as well from the meshes that it made of the faces", True
    return status, False


def fastest_growth(volume, words):
    """The largest growth rate of the functions attached to a volume."""
    rates = [1.0]
    for text in words:
        attached = re.search(r" attach .*Volume\{([0-9,]+)\}.* growth ([0-9.]+)", str(text))
        if attached and str(volume) in attached[1].split(","):
            rates.append(float(attached[2]))
    return max(rates)


def cause(volume, words):
    """Why sizes jump in a volume, as its measurements tell."""
    facts = volume["causes"]
    before = facts["premeshed"]
    if before["of_bad"] > 0.5 and (before.get("ratio_99") or 1) > 1.4:
        return "the mesh from before jumps itself"
    for place, text in (("longer", "faces are coarser than the volume's functions ask for"),
                        ("shorter", "faces are finer than the volume's functions ask for")):
        there = facts[place]
        if there["of_bad"] > max(0.5, min(0.9, there["of_all"] + 0.2)):
            return text
    if fastest_growth(volume["volume"], words) >= FAST:
        return "a growth rate of %g or more is asked for" % FAST
    if volume["tetrahedra"] < 2.5 * facts["faces"]["elements"]:
        return "thin: hardly more tetrahedra than triangles around"
    return NONE_FOUND


def judged(results):
    """Attached volumes with many tetrahedra: (result, volume)."""
    return [(r, v) for r in results for v in r.get("volumes", ())
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
    steep = [(r, v) for r, v in volumes if is_steep(v)]
    slow = [v for r, v in volumes if fastest_growth(v["volume"], r["words"]) < FAST]
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
            len(volumes) - len(steep), 100 - 100 * len(steep) / max(1, len(volumes)))),
        ("  of those with growth < %g" % FAST, "%d of %d (%.2f %%)" % (
            sum(not is_steep(v) for v in slow), len(slow),
            100 * sum(not is_steep(v) for v in slow) / max(1, len(slow))))]
    lines = ["%-46s %s" % row for row in rows]
    for text, seeds in grouped((reason(r)[0], r["seed"]) for r in failed):
        lines.append("not meshed, %s: %d: %s" % (text, len(seeds), seeds))
    for text, places in grouped((cause(v, r["words"]), "%d/%d %.2f" % (
            r["seed"], v["volume"], v["report"]["ratio_99"])) for r, v in steep):
        lines.append("ratio, %s: %d: seed/volume %s" % (text, len(places), ", ".join(places)))
    return "\n".join(lines + broken_promises(results))


def read(path):
    """Results, the last one of each seed; a line that is not complete is none."""
    with open(path) as file:
        lines = [json.loads(line) for line in file if line.endswith("\n")]
    return list({r["seed"]: r for r in lines}.values())


def main():
    broken = False
    for path in sys.argv[1:]:
        results = read(path)
        print("\n== Gmsh %s (%s)\n%s" % (results[0]["gmsh"], path, summary(results)))
        broken = broken or bool(broken_promises(results))
    sys.exit(broken)


if __name__ == "__main__":
    main()
