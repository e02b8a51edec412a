"""Several FMUs that are one vehicle: each in a process of its own, with steps of its own."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from support.fmus.ssp import write_ssp

from fmus import (
    FmuCrashError,
    FmuProfileError,
    FmuStateError,
    FmuStepError,
    make_profile,
    open_vehicle,
    prepare,
)
from fmus.checking import coarse
from fmus.isolation import processes_reused

H = 0.05  # [s]
ROLES = {
    "inputs": {"drive_force": {"variable": "drive"}, "brake_force": {"variable": "brake"}},
    "outputs": {"speed": {"variable": "speed"}, "position": {"variable": "position"}},
    "initial": {"speed": {"variable": "chassis.initial_speed"}},
}
CONNECTIONS = [
    ("drive", "powertrain.demand"),
    ("brake", "brakes.demand"),
    ("powertrain.output", "chassis.drive_force"),
    ("brakes.output", "chassis.brake_force"),
    ("chassis.speed", "speed"),
    ("chassis.position", "position"),
]
CONNECTORS = {
    "drive": ("input", "N"),
    "brake": ("input", "N"),
    "speed": ("output", "m/s"),
    "position": ("output", "m"),
    **{f"{part}.demand": ("input", "N") for part in ("powertrain", "brakes")},
    **{f"{part}.output": ("output", "N") for part in ("powertrain", "brakes")},
    **{f"chassis.{name}": ("input", "N") for name in ("drive_force", "brake_force")},
    "chassis.speed": ("output", "m/s"),
    "chassis.position": ("output", "m"),
}


def actuator(zoo, lag, **options):
    """A first-order lag: the zoo's car of `lag` kg and 1 N.s/m answers with its speed."""
    return zoo.car(
        names={"force": "demand", "speed": "output"},
        units={"speed": ("N", 1.0, 0.0)},
        outputs=("speed",),
        initial=(),
        values={"mass": lag, "friction": 1.0},
        file=f"actuator{lag}{options.get('behaviour', '')}",
        **options,
    )


@pytest.fixture
def vehicle(zoo, tmp_path):
    """Opens the vehicle of three parts; steps: of the powertrain, the brakes, the chassis [s]."""
    opened = []

    def open_with(steps=(None, None, None), *, powertrain=None, tables=None, connections=None):
        parts = {
            "powertrain": powertrain or actuator(zoo, 0.3),
            "brakes": actuator(zoo, 0.1),
            "chassis": zoo.car(role="drive_brake", outputs=("speed", "position")),
        }
        path = write_ssp(
            tmp_path / "car.ssp",
            parts,
            connections or CONNECTIONS,
            CONNECTORS,
            values={"chassis.mass": 1200.0},
            linear={"brakes.demand": (50.0, 20.0)} if connections else None,
            plain=("brakes.demand",) if connections else (),
        )
        own = {n: {"step": step} for n, step in zip(parts, steps, strict=True) if step}
        profile = make_profile(ROLES | {"parts": own} | (tables or {}), "the test's profile")
        car = open_vehicle(path, step_size=H, profile=profile)
        car.files = parts
        opened.append(car)
        return car

    with processes_reused():
        yield open_with
        for car in opened:
            car.close()


def driven(car, forces, speed=4.0):
    """Positions and speeds of a drive, after which the vehicle is closed."""
    car.start(speed=speed)
    rows = [(car.position, car.speed)]
    for force in forces:
        car.step(force)
        rows.append((car.position, car.speed))
    car.close()
    return np.array(rows)


FORCES = [2000.0] * 25 + [0.0] * 7 + [-2500.0] * 18


def by_libcosim(path, parts, forces, base):
    """The same drive by libcosim, in which all parts do steps of the same length [s]."""
    pytest.importorskip("libcosimpy", reason="not installed: pip install libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.WARNING)
    system = prepare(path, step_size=H, profile=make_profile(ROLES, "test")).model.system
    execution = CosimExecution.from_step_size(round(base * 1e9))  # [ns]
    execution.real_time_simulation_enabled(enabled=False)
    manipulator = CosimManipulator.create_override()
    observer = CosimObserver.create_last_value()
    execution.add_manipulator(manipulator)
    execution.add_observer(observer)
    slaves = {
        name: execution.add_local_slave(CosimLocalSlave(str(file), name))
        for name, file in parts.items()
    }

    def place(name):
        part, variable = system.part_of(name)
        return slaves[part], system.parts[part].variables[variable].reference

    for link in system.links:
        (one, output), (other, taken) = place(link.source), place(link.target)
        assert execution.connect_real_variables(one, output, other, taken) == 0
    for name, value in {"chassis.mass": 1200.0, "chassis.initial_speed": 4.0}.items():
        assert execution.real_initial_value(*place(name), value)
    rows = []
    for force in forces:
        for name, value in (("powertrain.demand", force), ("brakes.demand", -force)):
            slave, reference = place(name)
            manipulator.slave_real_values(slave, [reference], [max(value, 0.0)])
        assert execution.step(round(H / base))
        slave, position = place("chassis.position")
        _, speed = place("chassis.speed")
        rows.append(observer.last_real_values(slave, [position, speed]))
    return np.array(rows)


def by_plain_fmpy(files, steps, forces):
    """A master on FMPy's own classes: what a part has put out is held until its next step ends."""
    import fmpy
    from fmpy.fmi2 import FMU2Slave

    slaves = {}
    for (name, file), step in zip(files.items(), steps, strict=True):
        description = fmpy.read_model_description(str(file), validate=False)
        slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=fmpy.extract(str(file)),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        references = {v.name: v.valueReference for v in description.modelVariables}
        slave.instantiate()
        slave.setupExperiment()
        slave.enterInitializationMode()
        for variable, value in (("mass", 1200.0), ("initial_speed", 4.0)):
            if name == "chassis":
                slave.setReal([references[variable]], [value])
        slave.exitInitializationMode()
        slaves[name] = (slave, references, round(step * 1000))
    held = {"powertrain": 0.0, "brakes": 0.0}
    rows = []
    for number in range(len(forces) * 50):  # [ms]
        force, before = forces[number // 50], dict(held)
        for name, (slave, references, step) in slaves.items():
            if number % step == 0:
                given = {"demand": max(force if name == "powertrain" else -force, 0.0)}
                if name == "chassis":
                    given = {"drive_force": before["powertrain"], "brake_force": before["brakes"]}
                slave.setReal([references[v] for v in given], list(given.values()))
                slave.doStep(number / 1000, step / 1000)
        for name, (slave, references, step) in slaves.items():
            if (number + 1) % step == 0 and name != "chassis":
                held[name] = slave.getReal([references["output"]])[0]
        if (number + 1) % 50 == 0:
            slave, references, _ = slaves["chassis"]
            rows.append(slave.getReal([references["position"], references["speed"]]))
    for slave, _, _ in slaves.values():
        slave.terminate()
        slave.freeInstance()
        shutil.rmtree(slave.unzipDirectory)
    return np.array(rows)


def container_of(files, path, step):
    """One FMU with the same parts inside, made by FMPy; it does steps of one length [s]."""
    from fmpy import read_model_description
    from fmpy.container_fmu.cli import create_container_fmu
    from fmpy.container_fmu.config import Component, Configuration, Connection
    from fmpy.model_description import CoSimulation, DefaultExperiment, ModelDescription, Unknown
    from fmpy.model_description import ModelVariable as Variable

    parts, inside = {}, {}
    for name, file in files.items():
        described = read_model_description(str(file), validate=False)
        parts[name] = Component(name, file, described)
        for variable in described.modelVariables:
            variable.type = "Float64" if variable.type == "Real" else variable.type
            inside[f"{name}.{variable.name}"] = (parts[name], variable)
    clock = Variable(name="time", type="Float64", causality="independent", variability="continuous")
    shown, mapped = [clock], {}
    for name, causality, start, places in (
        ("drive", "input", "0", ["powertrain.demand"]),
        ("brake", "input", "0", ["brakes.demand"]),
        ("mass", "parameter", "1200", ["chassis.mass"]),
        ("initial_speed", "parameter", "0", ["chassis.initial_speed"]),
        ("speed", "output", None, ["chassis.speed"]),
        ("position", "output", None, ["chassis.position"]),
    ):
        changes = "fixed" if causality == "parameter" else "continuous"
        variable = Variable(
            name=name, type="Float64", causality=causality, variability=changes, start=start
        )
        shown.append(variable)
        mapped[variable] = [inside[place] for place in places]
    model = ModelDescription(
        fmiVersion="3.0",
        modelName="car",
        instantiationToken="car",
        coSimulation=CoSimulation(modelIdentifier="car", fixedInternalStepSize=step),
        defaultExperiment=DefaultExperiment(stepSize=str(step)),
        modelVariables=shown,
        outputs=[Unknown(variable=variable) for variable in shown[-2:]],
    )
    links = [
        Connection(*(each for place in link for each in (inside[place][0], [inside[place][1]])))
        for link in CONNECTIONS
        if all("." in place for place in link)
    ]
    folder = path.with_suffix("")
    folder.mkdir()
    create_container_fmu(
        Configuration(False, model, list(parts.values()), links, mapped), folder, path
    )
    return path


def test_it_drives_as_the_container_of_the_same_parts(vehicle, tmp_path):
    car = vehicle((0.01, 0.01, 0.01))
    path = container_of(car.files, tmp_path / "container.fmu", 0.01)
    axes = {name: {"variable": name, "unit": "N"} for name in ("drive", "brake")}
    roles = {
        "fmu": {"step": 0.01},
        "inputs": {"drive_force": axes["drive"], "brake_force": axes["brake"]},
        "outputs": {
            "speed": {"variable": "speed", "unit": "m/s"},
            "position": {"variable": "position", "unit": "m"},
        },
        "initial": {"speed": {"variable": "initial_speed", "unit": "m/s"}},
    }
    one = open_vehicle(path, step_size=H, profile=make_profile(roles, "test"))
    assert np.abs(driven(car, FORCES) - driven(one, FORCES)).max() < 1e-9


def test_it_drives_as_in_other_masters_each_part_at_its_own_step(vehicle):
    for steps in ((0.01, 0.01, 0.01), (0.01, 0.02, 0.05), (0.03, 0.05, 0.01)):
        car = vehicle(steps)
        ours = driven(car, FORCES)[1:]
        assert np.abs(ours - by_plain_fmpy(car.files, steps, FORCES)).max() < 1e-9
        if len(set(steps)) == 1:
            assert np.abs(ours - by_libcosim(car.path, car.files, FORCES, 0.01)).max() < 1e-9


def test_it_is_interpolated_and_identified_as_one_vehicle(vehicle):
    """The chassis does steps of 30 ms: it has driven 1 m/s at each instant."""
    car = vehicle((None, None, 0.03), tables={"parameters": {"chassis.friction": 0.0}})
    assert car.prepared.delay == pytest.approx(0.02)
    rows = driven(car, [0.0] * 20, speed=1.0)
    assert rows[:, 0] == pytest.approx(np.arange(21) * H, abs=1e-12)

    # The brakes follow the speed: 50 N.s/m and 20 N more, from the first step on.
    dragged = [("chassis.speed", "brakes.demand"), *(c for c in CONNECTIONS if c[0] != "brake")]
    car = vehicle(connections=dragged, tables={"inputs": {"force": {"variable": "drive"}}})
    speeds, brakes = driven(car, [0.0] * 40)[:, 1], 0.0
    assert any("perhaps an algebraic loop" in warning for warning in car.warnings)
    expected = [4.0]
    for _ in range(40):
        before = brakes
        brakes += (50.0 * expected[-1] + 20.0 - brakes) * -np.expm1(-H / 0.1)
        speed = expected[-1] * np.exp(-H / 12.0) - before / 100.0 * -np.expm1(-H / 12.0)
        expected.append(speed)
    assert speeds == pytest.approx(np.array(expected), abs=1e-9)

    found = coarse(lambda _step: vehicle(), path=car.path)
    assert found.mass == pytest.approx(1200.0, rel=0.1)
    assert found.lag == pytest.approx(0.2, abs=0.1)


@pytest.mark.parametrize(
    ("behaviour", "kind", "said"),
    [
        ("segfault", FmuCrashError, "SIGSEGV"),
        ("hang", FmuCrashError, "no answer within 0.5 s"),
        ("error", FmuStepError, "no step from 0.2 s to 0.25 s"),
    ],
)
def test_a_part_that_fails_ends_the_drive(zoo, vehicle, behaviour, kind, said):
    bad = actuator(zoo, 0.3, behaviour=behaviour, at=0.2)
    car = vehicle(powertrain=bad, tables={"fmu": {"step_timeout": 0.5}})
    car.start(speed=4.0)
    for _ in range(4):
        car.step(500.0)
    with pytest.raises(kind) as caught:
        car.step(500.0)
    message = str(caught.value)
    assert message.startswith(f"{car.path}: part 'powertrain': ")
    assert said in message
    assert "\n" not in message
    with pytest.raises(FmuStateError):
        car.step(500.0)
    assert car.time == pytest.approx(4 * H)


def test_a_step_for_a_part_that_does_not_exist(vehicle):
    said = r"\[parts.engine\]: no such part; it has: powertrain, brakes, chassis"
    with pytest.raises(FmuProfileError, match=said):
        vehicle(tables={"parts": {"engine": {"step": 0.01}}})
