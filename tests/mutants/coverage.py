"""Lines and branches of an area's folders that the same tests come past."""
import collections
import json
import subprocess
import sys

import build
import campaign


def measure(root, area, kept, jobs):
    """Builds the preset `coverage`, runs the tests, and keeps in the file `kept` what gcov says of each
    source."""
    folder = root / "build/coverage"
    programs = build.programs(root, "coverage", area.subjects, jobs)
    for counts in folder.rglob("*.gcda"):
        counts.unlink()

    def run(program):
        status, test, _, _ = campaign.run(program, ["*"], 3600)
        if status != 0:
            print(f"{program.name} fails, at {test} first; its counts are taken all the same", file=sys.stderr)

    campaign.in_parallel(run, programs, jobs)
    filters = [word for name in area.folders for word in ("--filter", f"{root}/{name}/[a-z_0-9]+[.]cpp")]
    # Threads that count at once leave a counter wrong, now and then below zero, which gcovr stumbles over.
    subprocess.run(["gcovr", "--root", str(root), *filters, "--exclude-throw-branches",
                    "--gcov-ignore-parse-errors", "--json-summary", str(kept), str(folder)],
                   cwd=folder, check=True)
    summary = json.loads(kept.read_text())
    summary["commit"] = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=root, check=True,
                                       capture_output=True, text=True).stdout.strip()
    kept.write_text(json.dumps(summary))


def section(kept):
    """A table, or what is missing."""
    if not kept.exists():
        return "Not measured (`--coverage`)."
    sums = collections.defaultdict(collections.Counter)
    summary = json.loads(kept.read_text())
    for file in summary["files"]:
        name = file["filename"].rsplit("/", 1)[0]
        for kind in ("line", "branch"):
            for what in ("covered", "total"):
                sums[name][f"{kind}_{what}"] += file[f"{kind}_{what}"]
                sums["all"][f"{kind}_{what}"] += file[f"{kind}_{what}"]
    rows = [f"Commit {summary['commit']}.", "", "| folder | lines | come past | branches | come past |", "|---|---|---|---|---|"]
    for name in [*sorted(set(sums) - {"all"}), "all"]:
        s = sums[name]
        rows.append(f"| {name} | {s['line_total']} | {100 * s['line_covered'] / s['line_total']:.1f} % | "
                    f"{s['branch_total']} | {100 * s['branch_covered'] / s['branch_total']:.1f} % |")
    return "\n".join(rows)
