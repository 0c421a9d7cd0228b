"""All places of an area's folders, kept by the text of each source: parsing them takes minutes."""
import dataclasses
import hashlib
import json
import multiprocessing
import pathlib

import places


def of_source(task):
    root, name, args, kept = task
    text = (root / name).read_bytes() + pathlib.Path(places.__file__).read_bytes()
    record = kept / (hashlib.sha256(text).hexdigest() + ".json")
    if not record.exists():
        found = places.places(str(root / name), name, args)
        record.write_text(json.dumps([dataclasses.asdict(p) for p in found]))
    return [places.Place(**p) for p in json.loads(record.read_text())]


def collect(root, folders, commands, kept, jobs):
    """Places of every source of `folders`, in the order of their names. `commands` is a
    compile_commands.json."""
    kept.mkdir(parents=True, exist_ok=True)
    tasks = []
    for entry in json.loads(commands.read_text()):
        name = str(pathlib.Path(entry["file"]).relative_to(root))
        if str(pathlib.Path(name).parent) in folders:
            tasks.append((root, name, places.arguments(entry), kept))
    unique = {task[1]: task for task in tasks}
    with multiprocessing.Pool(jobs) as pool:
        lists = pool.map(of_source, [unique[name] for name in sorted(unique)], chunksize=1)
    return [place for found in lists for place in found]
