"""Compares the kernel of visibility with brute force in 10,000 drawn scenes.

    python benchmarks/bounds/visibility_scenes.py --out FILE.csv    # can be ended and resumed

A scene has one to three cameras with ranges and fields of view of their own, up to six walls, up to
three vehicles at any angle, and four people; all have heights. Brute force sends rays from each
camera to the width of each person at the height of its upper end, and lets Shapely cut them with
each wall and each side of a vehicle. The kernel's share is exact: it may differ from that of the
rays by one ray at each edge of each thing that hides some of them. Each line of FILE.csv is a block
of scenes: its people, those who are hidden in part, the largest difference of the shares, and how
many differ by more than that.
"""

from __future__ import annotations

import argparse
import csv
from dataclasses import astuple, dataclass, fields
from math import inf, pi
from pathlib import Path

import numpy as np
import shapely

from giveway.ego.perception.visibility import RADIUS, fill_shares, walls_of
from giveway.geometry.kernel import Array

BLOCK, RAYS = 50, 512  # scenes in a block; rays to each person
EXTENT, PEOPLE = 12.0, 4  # m: half of the square in which all lies; people in a scene
KEPT = Path(__file__).with_suffix(".csv")


@dataclass(frozen=True)
class Scene:
    """The content of a scene; cameras, walls and vehicles as in the package."""

    cameras: Array  # (e, 6)
    people: Array  # (4, 2) [m]
    heights: Array  # (4,) [m]
    walls: Array  # (k, 5)
    vehicles: Array  # (m, 7)
    tops: Array  # (m,) [m] heights of the vehicles
    own: int  # row of the vehicle that carries the cameras and hides nobody, or -1


@dataclass(frozen=True)
class Block:
    """The comparison of one block of scenes."""

    block: int
    people: int
    in_part: int
    largest: float
    wrong: int


def drawn(number: int) -> Scene:
    """Return the scene of a number."""
    random = np.random.default_rng((0x516, number))
    e, k, m = random.integers(1, 4), random.integers(0, 7), random.integers(0, 4)

    def places(count: int) -> Array:
        return random.uniform(-EXTENT, EXTENT, (count, 2))

    angles = random.uniform(-pi, pi, e + m)
    cameras = np.column_stack(
        [
            places(e),
            random.uniform(1.0, 2.5, e),
            angles[:e],
            random.uniform(8.0, 30.0, e),
            random.uniform(0.5, pi, e),
        ]
    )
    walls = np.column_stack([places(k), places(k), random.uniform(0.5, 3.0, k)])
    speed, sizes = random.choice([0.0, 5.0], m), random.uniform(0.8, 3.0, (m, 3))
    vehicles = np.column_stack([places(m), angles[e:], speed, sizes])
    people, heights = places(PEOPLE), random.uniform(1.0, 1.9, PEOPLE)
    tops, own = random.uniform(1.2, 3.0, m), int(random.integers(-1, m))
    return Scene(cameras, people, heights, walls, vehicles, tops, own)


def shares(scene: Scene) -> Array:
    """Return the share (4,) of each person that the kernel says is seen."""
    walls, _ = walls_of(scene.walls, scene.vehicles, scene.tops, scene.own)
    seen = np.empty(PEOPLE)
    fill_shares(scene.cameras, (scene.people, scene.heights, RADIUS), walls, inf, seen)
    return seen


def counted(scene: Scene) -> tuple[Array, Array]:
    """Return the shares (4,) by counting rays, and how many things hide some rays of each."""
    lines = list(shapely.linestrings(scene.walls[:, :4].reshape(-1, 2, 2)))
    tops = list(scene.walls[:, 4])
    for row, (x, y, heading, _, front, rear, width) in enumerate(scene.vehicles):
        box = shapely.box(-rear, -width / 2.0, front, width / 2.0)
        turned = shapely.affinity.rotate(box, heading, origin=(0, 0), use_radians=True)
        ring = shapely.get_coordinates(shapely.affinity.translate(turned, x, y))
        if row != scene.own:
            lines += list(shapely.linestrings(np.stack([ring[:-1], ring[1:]], axis=1)))
            tops += [scene.tops[row]] * 4
    best, edges = np.zeros(PEOPLE), np.zeros(PEOPLE)
    for camera in scene.cameras:
        for i, (place, height) in enumerate(zip(scene.people, scene.heights, strict=True)):
            hides = _hidden(camera, place, height, (np.array(lines), np.array(tops)))
            best[i] = max(best[i], 1.0 - hides.any(axis=1).mean())
            edges[i] = max(edges[i], hides.any(axis=0).sum())
    return best, edges


def _hidden(camera: Array, place: Array, height: float, things: tuple[Array, Array]) -> Array:
    """Return which things hide which rays (512, k); one column is full outside of the view."""
    (x, y, z, heading, reach, half), (lines, tops) = camera, things
    way = place - (x, y)
    far = float(np.hypot(*way))
    off = abs((np.arctan2(way[1], way[0]) - heading + pi) % (2.0 * pi) - pi)
    if far > reach or off > half:
        return np.ones((RAYS, 1), dtype=np.bool_)
    if far <= RADIUS or not len(lines):
        return np.zeros((RAYS, 1), dtype=np.bool_)
    aside = RADIUS / far * np.array([-way[1], way[0]])
    ends = place + ((2.0 * np.arange(RAYS) + 1.0) / RAYS - 1.0)[:, None] * aside
    rays = shapely.linestrings(np.stack([np.broadcast_to((x, y), ends.shape), ends], axis=1))
    near = np.flatnonzero(shapely.intersects(lines, shapely.Polygon([(x, y), ends[0], ends[-1]])))
    cuts = shapely.intersection(rays[:, None], lines[near][None, :])
    hit = shapely.get_type_id(cuts) == shapely.GeometryType.POINT
    hit &= ~shapely.is_empty(cuts)
    along = np.hypot(shapely.get_x(cuts) - x, shapely.get_y(cuts) - y)
    along /= np.hypot(*(ends - (x, y)).T)[:, None]
    hidden: Array = hit & (z + (height - z) * along <= tops[near]) & (along < 1.0)
    return np.column_stack([hidden, np.zeros(RAYS, dtype=np.bool_)])


def compared(block: int) -> Block:
    """Compare the scenes of one block."""
    found = [
        (shares(scene), *counted(scene))
        for scene in map(drawn, range(block * BLOCK, (block + 1) * BLOCK))
    ]
    kernel, rays, edges = (np.concatenate(one) for one in zip(*found, strict=True))
    off = np.abs(kernel - rays)
    in_part = int(((kernel > 0.0) & (kernel < 1.0)).sum())
    wrong = int((off > (edges + 1.0) / RAYS).sum())
    return Block(block, len(kernel), in_part, round(float(off.max()), 6), wrong)


def kept(file: Path = KEPT) -> list[Block]:
    """Return the blocks that a file holds."""
    if not file.exists():
        return []
    with file.open(newline="", encoding="utf-8") as stream:
        rows = list(csv.reader(stream))[1:]
    return [Block(*(float(x) if "." in x else int(x) for x in row)) for row in rows]


def main() -> None:
    """Compare the blocks that are missing, and print the sum of all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--out", type=Path, required=True)
    options = parser.parse_args()
    done = {row.block for row in kept(options.out)}
    with options.out.open("a", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        if not done:
            writer.writerow(field.name for field in fields(Block))
        for block in range(options.scenes // BLOCK):
            if block not in done:
                writer.writerow(astuple(compared(block)))
                stream.flush()
    rows = kept(options.out)
    print(
        f"{BLOCK * len(rows)} scenes, {sum(row.people for row in rows)} people, "
        f"{sum(row.in_part for row in rows)} hidden in part; largest difference "
        f"{max(row.largest for row in rows):.4f}, wrong: {sum(row.wrong for row in rows)}"
    )


if __name__ == "__main__":
    main()
