"""The campaign's kind of kernel caches: damaged, swapped, or writable for others.

Each case is typed into a process of its own, since the nursery has its kernels. The run has to give
the same table as with a sound cache; a note may say what is compiled anew.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from campaign_bases import KERNELS_RUN
from campaign_folders import Expected

if TYPE_CHECKING:
    import random

    from campaign_bases import Bases


def kernels(drawn: random.Random, bases: Bases, folder: Path) -> tuple[object, ...]:
    """Files of a kernel cache that are damaged or swapped, or a folder that others may write in."""
    cache = Path(shutil.copytree(bases.kernels / "cache", folder / "cache"))
    files = sorted(file for file in cache.rglob("*") if file.is_file())
    file, other = drawn.choice(files), drawn.choice(files)
    content = file.read_bytes()
    what = drawn.choice(("empty", "half", "swapped", "noise", "gone", "link", "folder", "open"))
    if what == "swapped":
        file.write_bytes(other.read_bytes())
        other.write_bytes(content)
    elif what == "noise":
        at = drawn.randrange(len(content) + 1)
        file.write_bytes(content[:at] + drawn.randbytes(64) + content[at + 64 :])
    elif what in ("empty", "half"):
        file.write_bytes(content[: len(content) // 2] if what == "half" else b"")
    elif what == "open":
        for place in (cache, *cache.rglob("*")):
            place.chmod(0o777)
    else:
        file.unlink()
        if what == "link":
            file.symlink_to(drawn.choice(("/dev/zero", other, "nowhere")))
        elif what == "folder":
            file.mkdir()
    tables = folder / "out" / "ego.csv", bases.kernels / "out" / "ego.csv"
    return [*KERNELS_RUN, "--out", "out"], f"{file.name}: {what}", Expected(same=tables), cache
