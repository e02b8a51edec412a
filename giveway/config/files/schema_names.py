"""The names of the JSON schemas that ``giveway schema`` writes, and the reference to one in TOML.

Editors (such as those with Taplo) read the schema that a file's first line names, relative to it.
"""

from typing import Final

RUN: Final = "giveway-run.schema.json"
STUDY: Final = "giveway-study.schema.json"
PROFILE: Final = "giveway-profile.schema.json"
PRESET: Final = "giveway-preset.schema.json"
DATASET: Final = "giveway-dataset.schema.json"


def with_schema(text: str, name: str) -> str:
    """Return a TOML text that names its schema in its first line."""
    return f"#:schema {name}\n{text}"
