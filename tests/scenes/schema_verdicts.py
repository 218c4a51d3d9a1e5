"""What the JSON Schema says of scenes: prints one line for each, "accept" or "refuse", a tab, and the scene.

    schema_verdicts.py SCHEMA DIRECTORY     every .json file below DIRECTORY
    schema_verdicts.py SCHEMA --mutate FILE every scene made from FILE by one change: a value replaced by
                                            another kind, an unknown key added, a key removed
"""
import copy
import json
import pathlib
import sys

import jsonschema


def places(node, path=()):
    yield path
    if isinstance(node, dict):
        for key in node:
            yield from places(node[key], path + (key,))
    elif isinstance(node, list):
        for index in range(len(node)):
            yield from places(node[index], path + (index,))


def at(node, path):
    for step in path:
        node = node[step]
    return node


def replaced(scene, path, value):
    if not path:
        return value
    changed = copy.deepcopy(scene)
    at(changed, path[:-1])[path[-1]] = value
    return changed


def mutants(scene):
    for path in places(scene):
        for value in (None, True, "nonsense", "3 !", [], {}, [None], {"type": "nonsense"}):
            if isinstance(at(scene, path), type(value)) and value in ([], {}):
                continue  # not another kind
            yield replaced(scene, path, value)
        if isinstance(at(scene, path), dict):
            changed = copy.deepcopy(scene)
            at(changed, path)["unheard_of"] = 1
            yield changed
            changed = copy.deepcopy(scene)
            at(changed, path)["x-note"] = [None]
            yield changed
        if path and isinstance(path[-1], str):
            changed = copy.deepcopy(scene)
            del at(changed, path[:-1])[path[-1]]
            yield changed


def without_duplicates(pairs):
    """Of two equal keys of an object, JSON readers keep the last alone."""
    assert len(dict(pairs)) == len(pairs), [key for key, _ in pairs]
    return dict(pairs)


def main():
    schema = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"), object_pairs_hook=without_duplicates)
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    if sys.argv[2] == "--mutate":
        scenes = mutants(json.loads(pathlib.Path(sys.argv[3]).read_text(encoding="utf-8")))
    else:
        files = sorted(pathlib.Path(sys.argv[2]).glob("**/*.json"))
        scenes = (json.loads(f.read_text(encoding="utf-8")) for f in files)
    sys.stdout.reconfigure(encoding="utf-8")
    for scene in scenes:
        verdict = "accept" if validator.is_valid(scene) else "refuse"
        print(verdict, json.dumps(scene, ensure_ascii=False), sep="\t")


main()
