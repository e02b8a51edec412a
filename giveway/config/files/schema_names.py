"""The names of the JSON schemas that ``giveway schema`` writes, and how a TOML file refers to one.

Editors (Taplo, and what uses it) read the schema that a file's first line names, relative to it.
"""

from typing import Final

RUN: Final = "giveway-run.schema.json"
STUDY: Final = "giveway-study.schema.json"
PROFILE: Final = "giveway-profile.schema.json"
PRESET: Final = "giveway-preset.schema.json"


def with_schema(text: str, name: str) -> str:
    """A TOML text that names its schema in its first line."""
    return f"#:schema {name}\n{text}"
