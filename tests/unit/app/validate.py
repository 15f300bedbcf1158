# SPDX-License-Identifier: BSD-3-Clause
"""Holds JSON files against a JSON Schema, the first file, and prints for each whether it fits; see test_keys.cpp."""
import json
import sys

try:
    import jsonschema
except ImportError:
    sys.exit(77)

with open(sys.argv[1], encoding="utf-8") as file:
    schema = json.load(file)
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)
for name in sys.argv[2:]:
    with open(name, encoding="utf-8") as file:
        errors = [error.message.split("\n")[0] for error in validator.iter_errors(json.load(file))]
    print("no:" if errors else "yes", *errors[:1])
