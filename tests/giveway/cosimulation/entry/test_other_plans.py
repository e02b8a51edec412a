"""Vehicles whose plan SUMO makes on the way: refused, or told what the ego does not do."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from support.streets import NOBODY, ROUTE

import giveway

if TYPE_CHECKING:
    from collections.abc import Callable

    Scenario = Callable[..., str]

EGO = {"ego": {"take_over": ("car",)}} | NOBODY


@pytest.mark.parametrize("kept", [False, True])
def test_a_bus_that_waits_for_its_passengers_is_refused(
    street_scenario: Scenario, kept: bool
) -> None:
    stop = '<stop lane="A0B0_1" endPos="60" triggered="true" expected="p"/>'
    bus = f'<vType id="bus" vClass="bus"/><vehicle id="car" type="bus" depart="0">{ROUTE}{stop}'
    run = {"scenario": street_scenario(bus + "</vehicle>")} | EGO
    if kept:
        with pytest.raises(giveway.GivewayError, match=r"A0B0_1.*triggered.*--no-rules-stops"):
            giveway.run(run)
    else:
        assert giveway.run(run | {"rules": {"stops": False}}).completed


def test_a_taxi_is_refused(street_scenario: Scenario) -> None:
    taxi = '<vType id="taxi" vClass="taxi"><param key="has.taxi.device" value="true"/></vType>'
    taxi += f'<vehicle id="car" type="taxi" depart="0">{ROUTE}</vehicle>'
    with pytest.raises(giveway.GivewayError, match=r"taxi device.*has\.taxi\.device"):
        giveway.run({"scenario": street_scenario(taxi)} | EGO)


@pytest.mark.parametrize(("off", "said"), [("", True), ('off="1"', False)])
def test_a_rerouter_on_the_egos_way_is_named(
    street_scenario: Scenario, off: str, said: bool
) -> None:
    car = f'<vehicle id="car" depart="0">{ROUTE}</vehicle><route id="up" edges="B0B1 B1B2"/>'
    other = '<interval begin="0" end="99"><routeProbReroute id="north" probability="1"/></interval>'
    config = Path(street_scenario(car))
    additional = '<additional><route id="north" edges="A0B0 B0B1"/>'
    additional += f'<rerouter id="diversion" edges="A0B0" {off}>{other}</rerouter></additional>'
    config.with_name("r.add.xml").write_text(additional)
    files = '<additional-files value="r.add.xml"/></configuration>'
    config.write_text(config.read_text().replace("</configuration>", files))
    result = giveway.run({"scenario": str(config)} | EGO)
    assert result.completed
    assert any("'diversion' on its edge 'A0B0'" in remark for remark in result.remarks) is said


@pytest.mark.parametrize(("period", "is_said"), [(1, True), (0, False)])
def test_a_rerouting_device_does_not_change_the_route(
    street_scenario: Scenario, period: int, is_said: bool
) -> None:
    """Each trip has one with a period of 0, which finds its route at the departure."""
    device = '<param key="has.rerouting.device" value="true"/>'
    device += f'<param key="device.rerouting.period" value="{period}"/>'
    car = f'<vehicle id="car" depart="0">{ROUTE}{device}</vehicle>'
    result = giveway.run({"scenario": street_scenario(car)} | EGO)
    assert result.completed
    assert is_said is any("keeps the route of its departure" in text for text in result.remarks)
