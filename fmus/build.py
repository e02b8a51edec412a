"""Rebuild the shipped FMUs: ``python -m fmus.build [--out DIR]``.

The FMUs' own descriptions name this command as the tool that made them.
"""

import argparse
import hashlib
import sys
from pathlib import Path

from fmus.errors import FmuBuildError
from fmus.sources.fmu_files import CONTROLLER_RECIPE, VEHICLE_RECIPE, build


def main() -> None:
    """Build the FMUs from the command line."""
    parser = argparse.ArgumentParser(prog="python -m fmus.build", description="Rebuild the FMUs.")
    parser.add_argument(
        "--out", type=Path, default=Path(__file__).parent, help="folder; default: in place"
    )
    try:
        for path in build(parser.parse_args().out, (VEHICLE_RECIPE, CONTROLLER_RECIPE)):
            digest = hashlib.sha256(path.read_bytes()).hexdigest()
            sys.stdout.write(f"{path}  {path.stat().st_size} bytes  sha256 {digest}\n")
    except FmuBuildError as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
