"""Every scenario that is given is valid by the schema; every one that is spoilt is not.

Usage: schema_check.py SCHEMA SCENARIO.toml...
"""

import json
import sys
import tomllib

import jsonschema

with open(sys.argv[1]) as file:
    schema = json.load(file)
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)
failures = 0


def mistakes(document):
    return [f"{'.'.join(map(str, e.absolute_path))}: {e.message[:200]}" for e in validator.iter_errors(document)]


for path in sys.argv[2:]:
    with open(path, "rb") as file:
        document = tomllib.load(file)
    found = mistakes(document)
    for line in found:
        print(f"{path}: {line}")
    failures += len(found)
    # A key too many in each table, and a word that there is not.
    for spoil in (
        lambda d: d["run"].update(stepp=1),
        lambda d: d["box"].update(boundry="open"),
        lambda d: d["run"].update(threads="many"),
        lambda d: d["ensembles"][0].update({"class": "Neutron"}),
        lambda d: d["ensembles"][0].update(integrator="leapfrog"),
        lambda d: d["ensembles"][0].update(massive=1),
        lambda d: d["ensembles"][0]["load"].update(kind="blok"),
        lambda d: d.update(influence=[]),
    ):
        with open(path, "rb") as file:
            document = tomllib.load(file)
        # Classes of a scenario's own have names and fields that no schema knows.
        own = [e for e in document["ensembles"] if "classes" in document]
        known = {e["class"] for e in document["ensembles"]} | {k for e in own for k in e}
        spoil(document)
        if own and ({e["class"] for e in document["ensembles"]} | {k for e in document["ensembles"] for k in e}) - known:
            continue
        if len(mistakes(document)) <= len(found):
            print(f"{path}: what is wrong was not found")
            failures += 1

print(f"{len(sys.argv) - 2} scenarios, {failures} failures")
sys.exit(1 if failures or len(sys.argv) < 3 else 0)
