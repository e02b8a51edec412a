"""The export of floating car data, which SUMO's replay device drives and sumo-gui shows.

The device (``--device.fcd-replay.file``) takes the records of each object in consecutive SUMO
steps, whatever their times are. Therefore all are written at equal times without a break. SUMO 1.28
crashes if a person's edge is inside a junction. Therefore a person's ``edge`` is the nearest normal
one at its first instant, with the position along it. All vehicle types are written, too, because
SUMO does not know those of pedestrians and egos.
"""

import os
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from giveway.exports.net import Net, Place
from giveway.exports.sampling import PEDESTRIAN, Sampled, Track
from giveway.replays.run_folder import RunFolder

_BODIES = {PEDESTRIAN: (0.54, 0.54)}  # Length and width [m] of people
_CAR = (4.3, 1.8)  # Length and width [m] of a vehicle of unknown size
_COLOURS = {PEDESTRIAN: "213,94,0", "ego": "0,114,178"}
_OTHERS = "118,118,118"


def write_fcd(run: RunFolder, sampled: Sampled, file: Path) -> str:
    """Write FCD, and beside it the types and a configuration that replays it.

    Returns:
        The written files, in words.

    Raises:
        GivewayError: the run's network cannot be read.
    """
    net = Net.of(run)
    types = file.with_name(f"{_stem(file)}.types.add.xml")
    config = file.with_name(f"{_stem(file)}.sumocfg")
    kinds = {track.id: _kind(run, track) for track in sampled.tracks}
    names = {kind: f"giveway_{k}" for k, kind in enumerate(dict.fromkeys(kinds.values()), start=1)}
    _write_types(types, names)
    rows = [_rows(track, net, names[kinds[track.id]]) for track in sampled.tracks]
    with file.open("w", encoding="utf-8", newline="\n") as out:
        out.write("<fcd-export>\n")
        for index, numbers in enumerate(sampled.present):
            out.write(f'    <timestep time="{sampled.time(index):.3f}">\n')
            for number in numbers:
                out.write(rows[number][index - sampled.tracks[number].first])
            out.write("    </timestep>\n")
        out.write("</fcd-export>\n")
    _write_config(config, net, types, file, sampled)
    return f"{len(rows)} people and vehicles every {sampled.step:g} s; sumo-gui -c {config.name}"


def _kind(run: RunFolder, track: Track) -> tuple[str, float, float]:
    """Return type, length and width [m] of a track."""
    length, width = run.scene.body(track.object, _BODIES.get(track.type, _CAR))
    return track.type, length, width


def _write_types(file: Path, names: dict[tuple[str, float, float], str]) -> None:
    lines = []
    for (kind, length, width), name in names.items():
        person = kind == PEDESTRIAN
        shape = "pedestrian" if person else "passenger"
        lines.append(
            f'    <vType id="{name}" vClass="{"pedestrian" if person else "ignoring"}" '
            f'length="{length:g}" width="{width:g}" guiShape="{shape}" '
            f'color="{_COLOURS.get(kind, _OTHERS)}" minGap="0" maxSpeed="70">\n'
            f'        <param key="giveway.type" value={quoteattr(kind)}/>\n    </vType>\n'
        )
    text = f"<additional>\n{''.join(lines)}</additional>\n"
    file.write_text(text, encoding="utf-8", newline="\n")


def _rows(track: Track, net: Net, kind: str) -> list[str]:
    """Return the elements of one object, one for each instant."""
    tag = "person" if track.type == PEDESTRIAN else "vehicle"
    head = f"        <{tag} id={quoteattr(track.id)} "
    columns = np.column_stack([track.x, track.y, track.angle, track.speed])
    return [
        f'{head}x="{x:.4f}" y="{y:.4f}" angle="{angle:.2f}" speed="{speed:.4f}" type="{kind}" '
        f'{_where(tag, place)} pos="{place.position:.2f}" slope="0.00"/>\n'
        for (x, y, angle, speed), place in zip(
            columns.tolist(), net.nearest(track.x, track.y), strict=True
        )
    ]


def _where(tag: str, place: Place) -> str:
    return f'edge="{place.edge}"' if tag == "person" else f'lane="{place.lane}"'


def _write_config(file: Path, net: Net, types: Path, fcd: Path, sampled: Sampled) -> None:
    end = sampled.time(sampled.count - 1)
    options = {
        "net-file": os.path.relpath(net.file.absolute(), file.parent.absolute()),
        "additional-files": types.name,
        "device.fcd-replay.file": fcd.name,
        "begin": f"{sampled.begin:g}",
        "end": f"{end:g}",
        "step-length": f"{sampled.step:g}",
        "ignore-route-errors": "true",
        "insertion-checks": "none",  # an object that enters a step late would stay late
        "pedestrian.model": "striping",  # the only model whose persons can be moved
        "no-warnings": "true",  # SUMO would warn about a motion that is not its own
        "collision.action": "none",
        "time-to-teleport": "-1",
    }
    lines = "".join(f"    <{key} value={quoteattr(value)}/>\n" for key, value in options.items())
    text = f"<configuration>\n{lines}</configuration>\n"
    file.write_text(text, encoding="utf-8", newline="\n")


def _stem(file: Path) -> str:
    return file.name.removesuffix(".xml").removesuffix(".fcd")
