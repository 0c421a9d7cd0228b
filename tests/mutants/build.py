"""The mutated copy of the tree, and the test programs built from it."""
import shutil
import subprocess

import rewrite


def write(path, text):
    """Only where it differs, so that little is compiled again."""
    if not path.exists() or path.read_bytes() != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text)


def tree(root, copy, numbered):
    """Copies what git knows of `root` to `copy`, with the switches of `numbered` [(number, place)]."""
    listed = subprocess.run(["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=root, check=True,
                            capture_output=True, text=True).stdout
    by_file = {}
    for number, place in numbered:
        by_file.setdefault(place.file, []).append((number, place))
    names = [name for name in listed.split("\0") if name and (root / name).is_file()]
    for name in names:
        text = (root / name).read_bytes()
        if name in by_file:
            text = rewrite.rewritten(text.decode(), by_file[name]).encode()
        write(copy / name, text)
        shutil.copymode(root / name, copy / name)
    here = root / "tests/mutants"
    write(copy / "models/mutant_switch.hpp", (here / "switch.hpp").read_bytes())
    source = (here / "switch.cpp").read_text().replace('"switch.hpp"', '"shapeid/models/mutant_switch.hpp"')
    write(copy / "models/mutant_switch.cpp", source.encode())
    kept = set(names) | {"models/mutant_switch.hpp", "models/mutant_switch.cpp"}
    for folder in ("models", "reference", "fast", "proofs", "diagnosis", "app", "tests"):  # sources are found by their folder
        for path in (copy / folder).rglob("*.cpp"):
            if str(path.relative_to(copy)) not in kept:
                path.unlink()


def programs(root, preset, subjects, jobs):
    """Builds, and returns the test programs of these subjects."""
    subprocess.run(["cmake", "--preset", preset], cwd=root, check=True, stdout=subprocess.DEVNULL)
    targets = [f"test_{subject}" for subject in subjects]
    subprocess.run(["cmake", "--build", "--preset", preset, "-j", str(jobs), "--target", *targets], cwd=root,
                   check=True)
    return [root / "build" / preset / "tests" / target for target in targets]
