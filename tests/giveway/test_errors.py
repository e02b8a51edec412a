"""The words of giveway's errors."""

from typing import Annotated

import pytest
from pydantic import BaseModel, Field, ValidationError

from giveway.errors import in_words


class Options(BaseModel):
    number: Annotated[int, Field(ge=0, le=50_000)] = 1
    share: Annotated[float, Field(gt=0.0, le=0.5)] = 0.5
    on: bool = True
    name: str = ""


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"number": "ten"}, "should be a whole number"),
        ({"number": 1.5}, "should be a whole number"),
        ({"number": -1}, "should be at least 0"),
        ({"number": 50_001}, "should be at most 50000"),
        ({"share": "half"}, "should be a number"),
        ({"share": 0.6}, "should be at most 0.5"),
        ({"share": 0.0}, "should be greater than 0"),
        ({"on": "perhaps"}, "should be true or false"),
        ({"name": 3}, "should be a text"),
    ],
)
def test_a_refused_value_is_explained_in_plain_words(values: dict, words: str) -> None:
    with pytest.raises(ValidationError) as refusal:
        Options(**values)
    assert in_words(refusal.value.errors()[0]) == words
