"""A page of docs: how many mutants died, and why the others did not."""
import collections
import math
import pathlib

import yaml

import coverage
import sample

HERE = pathlib.Path(__file__).parent


def wilson(hits, count):
    """95 % interval of a share."""
    if count == 0:
        return 0.0, 1.0
    z, p = 1.959964, hits / count
    centre = p + z * z / (2 * count)
    half = z * math.sqrt(p * (1 - p) / count + z * z / (4 * count * count))
    return (centre - half) / (1 + z * z / count), (centre + half) / (1 + z * z / count)


def share(hits, count):
    if count == 0:
        return "none"
    low, high = wilson(hits, count)
    return f"{hits} of {count}, {100 * hits / count:.1f} % ({100 * low:.1f} to {100 * high:.1f})"


def reasons():
    """{(file, source line, change): (kind, why)}, from reasons.yaml."""
    listed = yaml.safe_load((HERE / "reasons.yaml").read_text()) or []
    return {(r["file"], r["line"], r["change"]): (r["kind"], r["why"]) for r in listed}


def source_line(root, place):
    return (root / place.file).read_text().splitlines()[place.line - 1].strip()


def table(title, keys, judged):
    rows = [f"| {title} | mutants | died | share, 95 % interval |", "|---|---|---|---|"]
    for key in sorted({keys(place) for place, _ in judged}):
        mine = [v for place, v in judged if keys(place) == key]
        died = sum(v["verdict"] == "killed" for v in mine)
        low, high = wilson(died, len(mine))
        rows.append(f"| {key} | {len(mine)} | {died} | {100 * died / len(mine):.0f} % "
                    f"({100 * low:.0f} to {100 * high:.0f}) |")
    return "\n".join(rows)


def survivors(root, alive, explained):
    rows = ["| place | source | change | kind | reason |", "|---|---|---|---|---|"]
    for place, verdict in sorted(alive, key=lambda pair: (pair[0].file, pair[0].line, pair[0].start)):
        line = source_line(root, place)
        kind, why = explained.get((place.file, line, place.says), ("?", "no reason yet"))
        if not verdict["reaching"]:
            kind += ", not reached"
        code = line.replace("|", "\\|").replace("](", "] (")  # a lambda is no link
        says = place.says.replace("|", "\\|")
        rows.append(f"| {place.file}:{place.line} | `{code}` | {says} | {kind} | {why} |")
    return "\n".join(rows)


def argued_equal(root, alive, explained):
    """How many survivors are argued to be equivalent."""
    return sum(explained.get((place.file, source_line(root, place), place.says), ("?",))[0] == "equivalent"
               for place, _ in alive)


def fresh_section(root, fresh, explained, options):
    """What the second sample says, or that there is none."""
    if not fresh:
        return "None was drawn (`--fresh 200`)."
    alive = [(p, v) for p, v in fresh if v["verdict"] != "killed"]
    checked = sum(v.get("check", False) for _, v in fresh if v["verdict"] == "killed")
    asked = "all were asked about" if len(fresh) == options.drawn else (
        f"{len(fresh)} of these were asked about, in the order of their lots")
    seen = options.fresh - options.drawn
    equal = argued_equal(root, alive, explained)
    return (f"Seed {options.fresh_seed}, {options.fresh} places; {seen} of them stood in earlier second samples and "
            f"are left out; {asked}. **{share(len(fresh) - len(alive), len(fresh))} died**, {checked} of "
            f"them through a contract or a bound; without the {equal} that are argued to be equivalent "
            f"{share(len(fresh) - len(alive), len(fresh) - equal)}.\n\n{table('folder', sample.folder, fresh)}\n\n"
            f"Its survivors:\n\n{survivors(root, alive, explained)}")


def written(area, judged, fresh, places, root, options, commit, tests, failing):
    explained = reasons()
    alive = [(p, v) for p, v in judged if v["verdict"] != "killed"]
    dead = len(judged) - len(alive)
    equal = argued_equal(root, alive, explained)
    killed = [v for _, v in judged if v["verdict"] == "killed"]
    ways = collections.Counter(v["how"].split()[0] for v in killed)
    text = (HERE / f"{area.page}.in").read_text()
    values = {
        "command": "./run mutants" + (" --diagnosis" if options.diagnosis else "") +
                   f" --count {options.count} --seed {options.seed} --budget {options.budget:g}" +
                   (f" --fresh {options.fresh} --fresh-seed {options.fresh_seed} --seen "
                    f"{' '.join(map(str, options.seen))}" if options.fresh else ""),
        "commit": commit, "budget": f"{options.budget:g}",
        "places": f"{len(places):,}", "count": str(len(judged)), "tests": f"{len(tests):,}",
        "failing": ", ".join(failing) or "none",
        "died": share(dead, len(judged)), "without_equal": share(dead, len(judged) - equal),
        "equal": str(equal), "alive": str(len(alive)),
        "unreached": str(sum(not v["reaching"] for _, v in alive)),
        "checked": str(sum(v.get("check", False) for v in killed)),
        "failed": str(ways["failed"]), "crashed": str(ways["status"]), "late": str(ways["too"]),
        "partly": str(sum(v["tried"] < v["reaching"] for _, v in alive)),
        "by_folder": table("folder", sample.folder, judged),
        "by_operator": table("operator", lambda place: place.operator, judged),
        "survivors": survivors(root, alive, explained),
        "fresh": fresh_section(root, fresh, explained, options),
        "coverage": coverage.section(root / "build" / area.work / "coverage.json"),
    }
    for name, value in values.items():
        text = text.replace(f"@{name}@", value)
    return text
