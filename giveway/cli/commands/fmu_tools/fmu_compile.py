"""The command ``giveway fmu compile``: it compiles an FMU's C sources for this platform."""

from pathlib import Path

from rich.console import Console

from fmus import FmuError
from fmus.description.binaries import this_platform
from fmus.sources.foreign import compile_fmu
from giveway.cli.guards.fmu_arguments import require_fmu
from giveway.cli.screen.printing import print_place, writing
from giveway.errors import ConfigError, VehicleError, retold


def compile_command(path: Path, out: Path | None = None, *, force: bool = False) -> None:
    """Write a copy of an FMU with a binary for this platform.

    Args:
        path: File of the FMU.
        out: Copy to write, or None for one in the working folder, named after FMU and platform.
        force: True to replace an existing file.

    Raises:
        ConfigError: there is no such FMU, or the copy exists.
        VehicleError: the FMU is refused, has no sources, or they do not compile.
        ResultsError: the copy cannot be written.
    """
    require_fmu(path)
    out = out or Path(f"{path.stem}_{this_platform()}.fmu")
    if out.exists() and (not force or out.samefile(path)):
        raise ConfigError(f"{out}: exists; name another file with -o, or replace it with --force")
    console = Console()
    compiling, saving = console.status("Compiling ..."), writing(out, "name another with -o")
    with retold(FmuError, VehicleError), compiling, saving:
        made = compile_fmu(path, out)
    for name in made:
        console.print(f"Compiled {name}", highlight=False, markup=False)
    print_place(console, "FMU", out)
