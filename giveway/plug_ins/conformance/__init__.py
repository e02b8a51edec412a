"""The conformance kits: made-up scenes that tell whether a plug-in keeps to the rules."""

from giveway.plug_ins.conformance.battery import Finding
from giveway.plug_ins.conformance.controllers import check_controller
from giveway.plug_ins.conformance.models import check_model

__all__ = ["Finding", "check_controller", "check_model"]
