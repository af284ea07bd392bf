#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The JSON Schema of case files accepts the cases that the reader accepts, refuses broken ones, and PyYAML reads the text of a case as the reader does.

usage: test_schema.py LIBMPS_CASE     exit code 77: jsonschema or PyYAML is missing
"""
import ctypes
import json
import sys
from pathlib import Path

try:
    import jsonschema
    import yaml
except ImportError:
    sys.exit(77)

CASES = Path(__file__).resolve().parent / "cases"
library = ctypes.CDLL(sys.argv[1])
library.mps_case_schema_write.restype = ctypes.c_size_t
library.mps_case_text.restype = ctypes.c_char_p
library.mps_case_text.argtypes = [ctypes.c_void_p]
library.mps_case_destroy.argtypes = [ctypes.c_void_p]

size = library.mps_case_schema_write(None, ctypes.c_size_t(0)) + 1
buffer = ctypes.create_string_buffer(size)
assert library.mps_case_schema_write(buffer, ctypes.c_size_t(size)) == size - 1
schema = json.loads(buffer.value)
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)


def read(text):
    """Status and merged text of the reader."""
    case = ctypes.c_void_p()
    data = text.encode()
    name = str(CASES / "test.yaml").encode()
    status = library.mps_case_read_text(data, ctypes.c_size_t(len(data)), name, 0, None, ctypes.byref(case))
    merged = library.mps_case_text(case)
    library.mps_case_destroy(case)
    return status, merged.decode() if merged else None


def agree(text, good):
    errors = [f"{list(e.absolute_path)}: {e.message[:200]}" for e in validator.iter_errors(yaml.safe_load(text))]
    status, merged = read(text)
    assert (status == 0) == good, f"reader: {status}\n{text}"
    assert (not errors) == good, f"schema: {errors[:3]}\n{text}"
    if good:
        assert not list(validator.iter_errors(yaml.safe_load(merged))), merged


for path in sorted(CASES.glob("*.yaml")):
    agree(path.read_text(), True)

good = "mps: 1\ndp: 4 mm\ntank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 25 %}}, {air: rest}]\nrun: {until: 5 s}\n"
agree(good, True)
agree(good + "output: {film: yes, pictures: 1 2.5 s}\n", True)
agree(good + "motion: {roll: {amplitude: 0, period: 1 s, ramp: 2}}\n", True)
agree(good + "tank2: {}\n", False)
agree(good + "dim: 4\n", False)
agree(good + "model: [imps]\n", False)
agree(good + "sensors: {P: {wall: 0 50}}\n", False)
agree(good + "sensors: {P: {wall: 0 50 kg}}\n", False)
agree(good + "sensors: {P: {wall: 0 50 mm, gauge: 1 dp}}\n", False)
agree(good + "sensors: {P: {}}\n", False)
agree(good + "sensors: {1st: {wall: 0 50 mm}}\n", False)
agree(good + "motion: {roll: {amplitude: 1 m, period: 1 s}}\n", False)
agree(good + "motion: {roll: {amplitude: 1 deg}}\n", False)
agree(good + "output: {film: maybe}\n", False)
agree(good + "reference: {a: {times: 1 2 s}}\n", False)
agree(good.replace("rest", "all"), False)
agree(good.replace("fill", "fil"), False)
agree(good.replace("mps: 1\n", ""), False)
print("the schema and the reader agree")
