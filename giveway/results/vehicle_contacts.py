"""The remark on contacts with background vehicles."""

from giveway.results.ego_result import EgoResult

_NAMED = 3


def remark(ego: EgoResult) -> str:
    """Return the remark on an ego's contacts with background vehicles, or "" without contacts."""
    contacts = ego.vehicle_contacts
    if not contacts:
        return ""
    named = ", ".join(
        f"'{contact.id}' (from {contact.first:.12g} s on, {contact.duration:.3g} s)"
        for contact in contacts[:_NAMED]
    )
    more = len(contacts) - _NAMED
    return (
        f"ego '{ego.id}': contact with {len(contacts)} background vehicle(s): {named}"
        + (f" and {more} more" if more > 0 else "")
        + "; see vehicle_contacts in the summary"
    )
