"""What of a scenario is kept, what is replaced, and that it is said."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import libsumo
import pytest

from giveway.errors import ConfigError, ScenarioError
from giveway.geometry.bodies import VehicleShape
from giveway.scenario_files import SUMO_SEED, Start, StartOptions, prepare_start, read_scenario
from giveway.sumo.types import ROAD_CLASSES, all_types, ego_type

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path


@pytest.fixture
def started(small_scenario: Callable[..., Path], tmp_path: Path) -> Callable[..., Start]:
    """The start of a scenario with the given lines, under the given options."""

    def start(*lines: str, **options: Any) -> Start:
        return prepare_start(
            read_scenario(small_scenario(*lines)), StartOptions(**options), tmp_path
        )

    return start


def options_of(start: Start) -> dict[str, str]:
    words = start.command[1:]
    assert len(words) == len(dict(zip(words[::2], words[1::2], strict=True))) * 2
    return dict(zip(words[::2], words[1::2], strict=True))


def test_what_the_scenario_sets_is_not_set_again(started: Callable[..., Start]) -> None:
    own = '<seed value="9"/><step-length value="0.1"/><time-to-teleport value="-1"/>'
    own += '<lateral-resolution value="0.8"/><begin value="5"/><end value="20"/>'
    own += '<collision.check-junctions value="false"/>'
    start = started(own)
    touched = {"--seed", "--random", "--step-length", "--time-to-teleport", "--lateral-resolution"}
    touched |= {"--begin", "--end", "--collision.check-junctions"}
    assert not touched & options_of(start).keys()
    assert start.seed == 9
    assert start.remarks == ()


def test_the_seed_asked_for_wins(started: Callable[..., Start]) -> None:
    start = started('<seed value="9"/>', seed=4)
    assert options_of(start)["--seed"] == "4"
    assert start.seed == 4
    assert started('<seed value="0"/>').seed == 0
    assert started().seed == SUMO_SEED


def test_a_random_seed_becomes_a_known_one(
    small_scenario: Callable[..., Path], run_started: Callable[..., dict[str, Any]]
) -> None:
    seen = run_started(small_scenario('<random value="true"/>'), until=2, fallback_seed=77)
    assert seen["seed"] == 77
    assert any("random: " in remark and "seed 77" in remark for remark in seen["remarks"])


@pytest.mark.parametrize("model", ["jupedsim", "nonInteracting"])
def test_another_pedestrian_model_gives_way_to_striping(
    model: str, started: Callable[..., Start]
) -> None:
    start = started(f'<pedestrian.model value="{model}"/>')
    assert options_of(start)["--pedestrian.model"] == "striping"
    assert any(f"striping instead of the scenario's {model}" in line for line in start.remarks)


def test_no_collision_takes_a_moved_vehicle_away(started: Callable[..., Start]) -> None:
    start = started('<collision.action value="remove"/>')
    assert options_of(start)["--collision.action"] == "warn"
    assert any("warn instead of the scenario's remove" in line for line in start.remarks)


def test_another_step_is_said(started: Callable[..., Start]) -> None:
    start = started(step_length=0.05)
    assert options_of(start)["--step-length"] == "0.050000"
    assert any("0.05 s instead of the scenario's 1 s" in line for line in start.remarks)


def test_nobody_is_waited_for_and_nothing_is_fetched(
    small_scenario: Callable[..., Path], run_started: Callable[..., dict[str, Any]]
) -> None:
    config = small_scenario('<remote-port value="8813"/><xml-validation value="always"/>')
    seen = run_started(config, until=2)  # with its port open it would never return
    assert seen["command"][seen["command"].index("--xml-validation") + 1] == "local"
    assert any("remote-port: not opened" in remark for remark in seen["remarks"])


def test_an_output_into_the_network_is_said(started: Callable[..., Start]) -> None:
    start = started('<fcd-output value="localhost:9999"/>')
    assert "--fcd-output" not in options_of(start)
    assert any("fcd-output: localhost:9999 is a network address" in line for line in start.remarks)


def test_a_missing_file_of_the_window_is_no_reason_to_stop(
    small_scenario: Callable[..., Path], run_started: Callable[..., dict[str, Any]]
) -> None:
    run_started(
        small_scenario('<gui-settings-file value="none.xml"/><demo value="true"/>'), until=2
    )


def test_the_users_own_options_win(started: Callable[..., Start]) -> None:
    extra = ("--scale=0.5", "--srand", "3", "--ignore-route-errors", "-a", "my.add.xml")
    start = started(seed=1, extra=extra)
    options = options_of(start)
    assert options["--scale"] == "0.5"
    assert options["--seed"] == "3"
    assert options["--ignore-route-errors"] == "true"
    assert options["--additional-files"].endswith(",my.add.xml")
    assert start.seed == 3


@pytest.mark.parametrize(
    ("extra", "message"),
    [
        (("scale", "2"), "SUMO option 'scale': expected a name that begins with --"),
        (("-c", "other.sumocfg"), "SUMO option '-c': giveway sets it itself"),
        (("--seed", "x"), "SUMO option --seed 'x': expected a whole number"),
    ],
)
def test_what_cannot_be_passed_on_is_refused(
    extra: tuple[str, ...], message: str, started: Callable[..., Start]
) -> None:
    with pytest.raises(ConfigError, match=message):
        started(extra=extra)


def test_a_message_about_a_copy_names_the_original(
    small_scenario: Callable[..., Path], tmp_path: Path
) -> None:
    config = small_scenario('<additional-files value="e.add.xml"/>')
    config.with_name("e.add.xml").write_text('<additional><edgeData id="e" file="o"/></additional>')
    start = prepare_start(read_scenario(config), StartOptions(), tmp_path / "cwd")
    (copy,) = start.copies
    assert start.with_original_names(f"Error in '{copy}'") == f"Error in '{start.copies[copy]}'"


def test_a_missing_file_is_said_before_sumo_is_asked(started: Callable[..., Start]) -> None:
    with pytest.raises(ScenarioError, match=r"additional-files names .*none\.add\.xml, which does"):
        started('<additional-files value="none.add.xml"/>')


@pytest.fixture
def held(small_city: Path, tmp_path: Path) -> Iterator[None]:
    """SUMO with a bus that has just departed, and our types."""
    (tmp_path / "bus.rou.xml").write_text(
        '<routes><vType id="line" vClass="bus" length="11.5" width="2.4"/>'
        '<trip id="bus" type="line" depart="0" from="A0A1" to="C1C2"/></routes>'
    )
    (tmp_path / "types.xml").write_text(all_types({"giveway_ego": VehicleShape(4.0, 1.8)}))
    options = ["--time-to-teleport", "20", "--no-step-log", "true", "--no-warnings", "true"]
    net = str(small_city.parent / "net.net.xml.gz")
    files = ["-n", net, "-r", str(tmp_path / "bus.rou.xml"), "-a", str(tmp_path / "types.xml")]
    libsumo.start(["sumo", *files, *options])
    libsumo.simulationStep(3)
    yield
    libsumo.simulationStep()  # carries out a pending move, which close() would leak
    libsumo.close()


def test_a_taken_vehicle_keeps_class_route_and_place_unstuck(held: None) -> None:
    vehicle = libsumo.vehicle
    route, place = vehicle.getRoute("bus"), vehicle.getPosition("bus")
    vehicle.setType("bus", ego_type(vehicle.getVehicleClass("bus")))
    vehicle.setLength("bus", 11.5)
    vehicle.setWidth("bus", 2.4)
    angle = vehicle.getAngle("bus")
    for _ in range(60):
        vehicle.moveToXY("bus", "", -1, *place, angle, 2)
        libsumo.simulationStep()
        assert libsumo.simulation.getStartingTeleportNumber() == 0
    assert vehicle.getPosition("bus") == place
    assert vehicle.getRoute("bus") == route
    assert vehicle.getVehicleClass("bus") == "bus"
    assert (vehicle.getLength("bus"), vehicle.getWidth("bus")) == (11.5, 2.4)


def test_without_our_type_the_held_vehicle_teleports(held: None) -> None:
    vehicle = libsumo.vehicle
    place, angle = vehicle.getPosition("bus"), vehicle.getAngle("bus")
    teleports = 0
    for _ in range(60):
        vehicle.moveToXY("bus", "", -1, *place, angle, 2)
        libsumo.simulationStep()
        teleports += libsumo.simulation.getStartingTeleportNumber()
    assert teleports > 0


def test_there_is_a_type_for_every_class_on_the_road(held: None) -> None:
    known = set(libsumo.vehicletype.getIDList())
    assert {ego_type(name) for name in ROAD_CLASSES} | {
        "giveway_pedestrian",
        "giveway_ego",
    } <= known
    for name in ROAD_CLASSES:
        assert libsumo.vehicletype.getVehicleClass(ego_type(name)) == name
    with pytest.raises(
        ScenarioError, match="vehicle class 'rail': an ego drives where people walk"
    ):
        ego_type("rail")


def test_an_option_of_the_window_does_not_stop_a_headless_run(
    small_scenario: Callable[..., Path], tmp_path: Path
) -> None:
    scenario = read_scenario(small_scenario('<gui_only><osg-view value="true"/></gui_only>'))
    start = prepare_start(scenario, StartOptions(interact=False), tmp_path)
    assert any("osg-view" in remark for remark in start.remarks)
    libsumo.start(list(start.command))
    try:
        libsumo.simulationStep()
        assert libsumo.simulation.getTime() > 0.0
        assert libsumo.edge.getIDList()
    finally:
        libsumo.close()
