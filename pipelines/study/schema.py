# SPDX-License-Identifier: GPL-3.0-or-later
"""Values against a JSON Schema: as much of it as the stages' own schemas and schemas/study.json use."""
import difflib

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}


def is_of(value, kind):
    if kind in ("number", "integer"):
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        return number and (kind == "number" or value == int(value))
    return isinstance(value, TYPES[kind])


def nearest(word, words):
    """A hint: which of the WORDS may be meant."""
    close = difflib.get_close_matches(word, list(words), 1, 0.5)
    return f"; '{close[0]}'?" if close else ""


def out_of_range(value, schema):
    """What the number VALUE must be and is not."""
    for name, fits, said in (("minimum", lambda x, y: x >= y, "at least"), ("maximum", lambda x, y: x <= y, "at most"),
                             ("exclusiveMinimum", lambda x, y: x > y, "more than"),
                             ("exclusiveMaximum", lambda x, y: x < y, "less than")):
        if name in schema and not fits(value, schema[name]):
            return f"must be {said} {schema[name]:g}, is {value:g}"
    return None


def wrong_member(value, schema, where):
    known = schema.get("properties", {})
    for name, member in value.items():
        inner = f"{where}.{name}" if where else name
        other = schema.get("additionalProperties", {})
        if name not in known and other is False:
            return f"{inner}: no such key{nearest(name, known)}"
        said = wrong(member, known.get(name, other), inner)
        if said:
            return said
    missing = [name for name in schema.get("required", []) if name not in value]
    return f"{where}: has no {missing[0]}" if missing else None


def wrong_item(value, schema, where):
    if len(value) < schema.get("minItems", 0):
        return f"{where}: must not be empty"
    if len(value) > schema.get("maxItems", len(value)):
        return f"{where}: must have at most {schema['maxItems']} values, has {len(value)}"
    for k, item in enumerate(value):
        said = wrong(item, schema.get("items", {}), f"{where}[{k}]")
        if said:
            return said
    return None


def wrong(value, schema, where=""):
    """What is wrong with VALUE, at WHERE, in words; None: nothing."""
    if "anyOf" in schema:
        said = [wrong(value, each, where) for each in schema["anyOf"]]
        # the one that goes deepest is meant
        return None if None in said else max(said, key=lambda text: (len(text.split(":")[0]), "must be" not in text))
    if "enum" in schema and value not in schema["enum"]:
        words = ", ".join(map(str, schema["enum"]))
        return f"{where}: must be {'one of ' if len(schema['enum']) > 1 else ''}{words}, is {value}"
    kinds = schema.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if kinds and not any(is_of(value, kind) for kind in kinds):
        return f"{where}: must be of type {' or '.join(kinds)}, is {value!r}"
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        said = out_of_range(value, schema)
        return said and f"{where}: {said}"
    if isinstance(value, dict):
        return wrong_member(value, schema, where)
    return wrong_item(value, schema, where) if isinstance(value, list) else None
