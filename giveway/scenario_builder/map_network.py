"""The sources of a network on a map: what netconvert reads from it, with the map's zebra crossings.

netconvert guesses a crossing wherever sidewalks meet a junction, and gives people no priority
there. Where the map has a marked crossing nearby, they get it.
"""

from __future__ import annotations

import gzip
import re
from pathlib import Path
from typing import Final
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from giveway.errors import ScenarioError
from sumo_scenarios.build import convert

MAPS: Final = (".osm", ".osm.gz", ".osm.xml")
"""The endings of maps that netconvert reads."""
PLAIN: Final = ("nod", "edg", "con", "tll", "typ")
"""The kinds of netconvert's sources."""
_OPTIONS: Final = """\
--geometry.remove --keep-edges.by-vclass passenger --remove-edges.isolated --junctions.join \
--tls.guess-signals --tls.discard-simple --tls.join --sidewalks.guess --crossings.guess \
--walkingareas"""
_TYPES: Final = ("osmNetconvert.typ.xml", "osmNetconvertUrbanDe.typ.xml")
_MARKED: Final = frozenset({"uncontrolled", "zebra", "marked"})
"""Values of OpenStreetMap's tag ``crossing`` where people have priority and no signal."""
_NEAR: Final = 12.0  # Longest distance [m] of a marked crossing from the one that is guessed
_HEADER: Final = re.compile(r"<!-- generated on .*?-->\s*", re.DOTALL)

Array = NDArray[np.float64]


def read_map(extract: Path) -> ElementTree.Element:
    """Return the content of a map.

    Raises:
        ScenarioError: it cannot be read, or is no map.
    """
    if not extract.name.endswith(MAPS):
        raise ScenarioError(
            f"{extract}: expected a map (.osm, .osm.xml or .osm.gz) or the description of a street "
            "(.toml); convert a .pbf with: osmium cat MAP.osm.pbf -o MAP.osm"
        )
    try:
        content = extract.read_bytes()
        root = ElementTree.fromstring(gzip.decompress(content) if content[:2] == _GZ else content)
    except (OSError, EOFError) as error:
        raise ScenarioError(f"{extract}: cannot be read: {error}") from error
    except ElementTree.ParseError as error:
        raise ScenarioError(f"{extract}: is not XML ({error}); download it again") from error
    if root.tag != "osm":
        raise ScenarioError(f"{extract}: begins with <{root.tag}>; expected <osm>, a map's")
    return root


_GZ: Final = b"\x1f\x8b"


def network_sources(extract: Path, name: str, scratch: Path) -> tuple[dict[str, str], int]:
    """Return netconvert's sources of a map's network, and the number of netconvert's warnings.

    Args:
        extract: Map.
        name: Name of the scenario.
        scratch: Folder for files that are not kept.

    Raises:
        ScenarioError: the map cannot be read, or holds no streets.
        BuildError: netconvert is missing.
    """
    world = read_map(extract)
    network = scratch / "guessed.net.xml"
    words = ["--osm-files", str(extract.resolve()), *_OPTIONS.split()]
    words += ["--plain-output-prefix", str(scratch / "plain"), "--output-file", str(network)]
    done = convert(words, typemaps=_TYPES)
    if done.returncode or not network.is_file():
        errors = [line for line in done.stderr.splitlines() if line.startswith("Error:")]
        reason = " ".join(errors) or f"exit code {done.returncode}"
        raise ScenarioError(f"{extract}: netconvert makes no network of it: {reason}")
    sources = {
        f"{name}.{kind}.xml": _HEADER.sub("", (scratch / f"plain.{kind}.xml").read_text("utf-8"))
        for kind in PLAIN
    }
    if "<edge " not in sources[f"{name}.edg.xml"]:
        raise ScenarioError(f"{extract}: no streets for cars; expected some that are connected")
    marked = _marked_crossings(world, ElementTree.parse(network).getroot())
    connections = f"{name}.con.xml"
    sources[connections] = _with_priority(sources[connections], marked)
    return sources, done.stderr.count("Warning:")


Crossing = tuple[str, frozenset[str]]
"""A crossing: its junction, and the edges that it crosses."""


def _marked_crossings(world: ElementTree.Element, network: ElementTree.Element) -> set[Crossing]:
    """Return the crossings of a network that are the nearest ones to the map's marked ones."""
    degrees = {
        node.get("id", ""): (float(node.get("lon", "0")), float(node.get("lat", "0")))
        for node in world.iter("node")
    }
    marked = [
        degrees[node.get("id", "")]
        for node in world.iter("node")
        if any(tag.get("k") == "crossing" and tag.get("v") in _MARKED for tag in node.iter("tag"))
    ]
    middles = _middles(network)
    crossings, centres = list(middles), np.array(list(middles.values())).reshape(-1, 2)
    found = set()
    for place in _on_network(degrees, network, np.array(marked).reshape(-1, 2)):
        distances = np.hypot(*(centres - place).T)
        if crossings and distances.min() <= _NEAR:
            found.add(crossings[int(distances.argmin())])
    return found


def _middles(network: ElementTree.Element) -> dict[Crossing, Array]:
    """Return the middle [m] of each crossing of a network."""
    middles = {}
    for edge in network.iter("edge"):
        lane = edge.find("lane")
        if edge.get("function") == "crossing" and lane is not None:
            line = [point.split(",")[:2] for point in lane.get("shape", "").split()]
            junction = edge.get("id", "")[1:].rpartition("_c")[0]
            edges = frozenset(edge.get("crossingEdges", "").split())
            middles[junction, edges] = np.array(line, dtype=float).mean(axis=0)
    return middles


def _on_network(
    degrees: dict[str, tuple[float, float]], network: ElementTree.Element, places: Array
) -> Array:
    """Return places (n, 2) [m] on the network, by the junctions that are nodes of the map.

    Over a few kilometres the projection is affine to a few decimetres.

    Args:
        degrees: Longitude and latitude of the map's nodes, by their ids.
        network: Network.
        places: Longitudes and latitudes (n, 2) [degree].
    """
    both = [
        (degrees[each.get("id", "")], (float(each.get("x", "0")), float(each.get("y", "0"))))
        for each in network.iter("junction")
        if each.get("id") in degrees
    ]
    if len(both) < 3:
        return np.empty((0, 2))
    known = np.array(both)
    origin = known[:, 0].mean(axis=0)
    centred = np.column_stack([known[:, 0] - origin, np.ones(len(known))])
    affine = np.linalg.lstsq(centred, known[:, 1], rcond=None)[0]
    on_network: Array = np.column_stack([places - origin, np.ones(len(places))]) @ affine
    return on_network


def _with_priority(connections: str, marked: set[Crossing]) -> str:
    """Return netconvert's connections with priority of people on the marked crossings."""

    def changed(found: re.Match[str]) -> str:
        crossing = (found["node"], frozenset(found["edges"].split()))
        told = found[0]
        return told.replace('priority="0"', 'priority="1"') if crossing in marked else told

    pattern = r'<crossing node="(?P<node>.*?)" edges="(?P<edges>.*?)"[^>]*>'
    return re.sub(pattern, changed, connections)
