"""Why does an ego brake hard in a street? For people who stay on the sidewalk, or for others?

    python benchmarks/law/beside_sidewalks.py --seeds 30 --controller mpc --out FOLDER

drives through ``crossings`` at the lane's speed and asks of each braking beyond 3 m/s^2 who made it
necessary: had the ego gone on for a second, whom could it have met in spite of full braking, by
what its safety layer assumes of people? They are *on the sidewalk* if they are there now and for
the next three seconds. Where nobody could have been met, who is in front of it within 15 m, a stop
or a vehicle is the cause. One file per drive is kept: what is there is not driven again. To compare
with another state of the repository, let that drive (``PYTHONPATH=OTHER_CHECKOUT``, with
``--drive-only``), and judge it with ``--open-ground``.
"""

from __future__ import annotations

import argparse
import pickle
from collections import Counter
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

AGAIN = 1.0  # [s] without it, and it is another braking
NEAR = 15.0  # [m] to who is in front, a stop or a vehicle, that is a cause
AHEAD, EVERY = 24, 3  # steps for which the ego is imagined to go on, and between looks
STAYS = 60  # steps that somebody who stays is looked at
FOUND = ("people on the sidewalk", "people elsewhere", "stop", "vehicle", "what is farther ahead")
KEPT = ("completion_time", "rms_jerk", "frontal_contacts", "beyond_assumption", "contacts_beyond")


def drive(seed: int, controller: str, file: Path) -> None:
    """Drive once, and keep what is asked for later."""
    import giveway

    result = giveway.run({"scenario": "crossings", "controller": controller, "seed": seed})
    ego = result.egos[0]
    kept = {"summary": dict(result.summary), "track": ego.track, "crowd": ego.crowd}
    kept |= {"way": ego.law.way, "width": ego.shape.width}
    file.write_bytes(pickle.dumps(kept))


def kerbs_of(way: Any, width: float) -> Any:
    """The kerbs beside the way."""
    from giveway.ego.perception.kerbs import Kerbs
    from giveway.geometry.path import EgoPath
    from giveway.walkways import WalkNetwork
    from sumo_scenarios import find

    network = WalkNetwork.read(find("crossings").folder / "crossings.net.xml")
    crossings = [place._replace(ends=np.array(place.ends)) for place in way.crossings]
    return Kerbs(EgoPath.through(way.points), width, network.sidewalks, crossings)


class Judge:
    """Says of each hard braking of a drive what made it necessary.

    Args:
        kept: of the drive.
        kerbs: beside its way.
        people: what the ego's safety layer assumes; ``sidewalks`` are known to it or not.
        sidewalks: see above.
        hard: [m/s^2] which brakings.
    """

    def __init__(self, kept: dict[str, Any], kerbs: Any, sidewalks: bool, hard: float) -> None:
        from controller.safety.worst_motion import RECORDED
        from giveway.ego.foresight.threats import Alarm

        self._hard = hard
        self._ego, self._crowd, self._kerbs = kept["track"], kept["crowd"], kerbs
        self._departure, self._half_width = kept["way"].departure, kept["width"] / 2.0
        worst = RECORDED["recorded-99.9"]
        setting_out = worst.setting_out if sidewalks else worst.acceleration
        self._dt = float(np.median(np.diff(self._ego.time)))
        self._alarm = Alarm(0.27, 0.05, worst.acceleration, worst.speed, 8.0, True, setting_out)

    def causes(self) -> list[str]:
        """Of each braking, in the order of time."""
        ego = self._ego
        hard = np.flatnonzero(ego.acceleration < -self._hard - 1e-4)
        begins = hard[np.diff(ego.time[hard], prepend=-inf) > AGAIN]
        return [self._cause(max(int(k) - 1, 0)) for k in begins]

    def _cause(self, k: int) -> str:
        ego = self._ego
        staying = False
        for ahead in range(0, AHEAD, EVERY):
            now = min(k + ahead, len(ego.time) - 1)
            for row, on in self._threats(k, now, ego.speed[k] * self._dt * ahead):
                if not on or not self._stays(row, now):
                    return FOUND[1]
                staying = True
        if staying:
            return FOUND[0]
        if ego.gap[k] <= NEAR:
            return FOUND[1]
        if ego.stop_gap[k] <= NEAR:
            return FOUND[2]
        return FOUND[3] if ego.vehicle_gap[k] <= NEAR else FOUND[4]

    def _threats(self, k: int, now: int, gone: float) -> list[tuple[int, bool]]:
        """Whom the ego could meet, and whether they are on a sidewalk."""
        from giveway.ego.foresight.threats import is_threat, outline

        ego, crowd, alarm = self._ego, self._crowd, self._alarm
        cos, sin, speed = np.cos(ego.heading[k]), np.sin(ego.heading[k]), float(ego.speed[k])
        turn = np.array([[cos, -sin], [sin, cos]])  # from the network's frame into the ego's
        rows = np.flatnonzero(crowd.step == now)
        where = np.column_stack([crowd.x[rows], crowd.y[rows]])
        velocity = np.column_stack([crowd.vx[rows], crowd.vy[rows]])
        to = self._kerbs.of(where, velocity, self._departure + float(ego.position[k]))
        front = np.array([ego.front_x[k] + gone * cos, ego.front_y[k] + gone * sin])
        there = (where - front) @ turn
        walks = velocity @ turn
        ways, stop = to[:, :2] @ turn, outline(speed, self._dt, alarm)
        found = []
        for i, row in enumerate(rows.tolist()):
            kerb = float(ways[i, 0]), float(ways[i, 1]), float(to[i, 2]) - 0.05
            place, walk = tuple(there[i].tolist()), tuple(walks[i].tolist())
            if is_threat(place, walk, stop, self._half_width, self._dt, alarm, kerb):
                found.append((row, bool(to[i, 2] > 0.0)))
        return found

    def _stays(self, row: int, now: int) -> bool:
        """Whether somebody stays on the sidewalk."""
        crowd = self._crowd
        soon = (crowd.step >= now) & (crowd.step <= now + STAYS)
        rows = np.flatnonzero(soon & (crowd.pedestrian == crowd.pedestrian[row]))
        where = np.column_stack([crowd.x[rows], crowd.y[rows]])
        front = self._departure + float(self._ego.position[now])
        velocity = np.column_stack([crowd.vx[rows], crowd.vy[rows]])
        return bool((self._kerbs.of(where, velocity, front)[:, 2] > 0.0).all())


def table(files: list[Path], sidewalks: bool, hard: float) -> str:
    """The counts over all drives, and means."""
    drives = [pickle.loads(file.read_bytes()) for file in files]
    kerbs = kerbs_of(drives[0]["way"], drives[0]["width"])
    judges = [Judge(kept, kerbs, sidewalks, hard) for kept in drives]
    counts = Counter(cause for judge in judges for cause in judge.causes())
    lines = [f"{len(drives)} drives, {sum(counts.values())} brakings harder than {hard:g} m/s^2"]
    lines += [f"  for {cause}: {counts[cause]}" for cause in FOUND]
    for name in KEPT:
        values = np.array([float(kept["summary"][name]) for kept in drives])
        lines.append(f"  {name}: mean {np.nanmean(values):.2f}, sum {np.nansum(values):.0f}")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=30, help="from 1 on")
    parser.add_argument("--controller", default="mpc")
    parser.add_argument("--out", type=Path, required=True, help="folder of the drives")
    parser.add_argument("--hard", type=float, default=3.0, help="[m/s^2] which brakings")
    parser.add_argument("--drive-only", action="store_true", help="judge nothing")
    parser.add_argument(
        "--open-ground", action="store_true", help="the layer that drove knew of no sidewalks"
    )
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    files = [options.out / f"{seed}.pickle" for seed in range(1, options.seeds + 1)]
    for seed, file in enumerate(files, start=1):
        if not file.exists():
            drive(seed, options.controller, file)
    if not options.drive_only:
        print(table(files, not options.open_ground, options.hard))


if __name__ == "__main__":
    main()
