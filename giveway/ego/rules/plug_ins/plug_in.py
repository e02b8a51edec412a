"""Makes the rules of other packages that the configuration names, for one ego's route."""

from collections.abc import Callable, Mapping
from typing import Any

from giveway.ego.rules.plug_ins.plugged_in import PluggedInRule
from giveway.ego.rules.protocol import Rule
from giveway.ego.rules.route import RouteContext
from giveway.errors import RuleError
from giveway.plug_ins.faults import blamed, shown
from giveway.plug_ins.finding import load_class, maker_of
from giveway.plug_ins.sockets import RULE

Maker = Callable[[Any], object]
"""Function that makes a rule for a route, with its options."""


def plugged_in_rules(route: RouteContext) -> list[Rule]:
    """The rules of other packages that hold on one ego's route.

    Args:
        route: Route of the ego.

    Raises:
        ConfigError: the options of a rule cannot be used.
        ControlError: a rule is not installed, or cannot be imported.
        RuleError: a rule cannot be made.
    """
    found: list[Rule] = []
    for name, settings in route.config.rules.plugged_in.items():
        whose = f"'{name}' of '{route.config.ego_id}'"
        rule = made(whose, maker(name, settings), route)
        found += [] if rule is None else [rule]
    return found


def maker(name: str, settings: Mapping[str, Any]) -> Maker:
    """Return the function that makes the rule of a name: its ``on`` if it has one, or its class.

    Args:
        name: Name of the rule, as in ``[rules]``.
        settings: Its options, as the user has set them.

    Raises:
        ConfigError: its options cannot be used.
        ControlError: it is not installed, or cannot be imported.
    """
    kind, options = load_class(name, RULE, settings)
    return maker_of(getattr(kind, "on", kind), options)


def made(name: str, make: Maker, route: Any) -> PluggedInRule | None:
    """Make one rule for one route, with checked answers; None if it does not apply there.

    Args:
        name: Name of the rule and its ego, for messages.
        make: Function that makes the rule.
        route: Route of the ego.

    Raises:
        RuleError: it cannot be made, or is no rule.
    """
    with blamed(name, RuleError, " when it was made"):
        rule = make(route)
    if rule is None:
        return None
    if not isinstance(rule, Rule):
        msg = f"{name} made {shown(rule)}: expected an object with a method demand, or None"
        raise RuleError(msg)
    return PluggedInRule(name, rule)
