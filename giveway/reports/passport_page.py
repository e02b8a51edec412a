"""The page of a vehicle's passport: sections of facts and pictures in one HTML file."""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup
from matplotlib.figure import Figure

from giveway.reports.embedding import inline_svg
from giveway.reports.report_page import page_environment


@dataclass(frozen=True)
class Section:
    """A section of the page.

    Attributes:
        title: Title above it.
        rows: Rows of a table; the first cell of each is its heading.
        points: Items of a list below the table.
        figures: Pictures below the table.
    """

    title: str
    rows: Sequence[Sequence[str]] = ()
    points: Sequence[str] = ()
    figures: Sequence[Figure] = ()


def passport_page(title: str, lead: str, sections: Sequence[Section], footer: str) -> str:
    """Return the page as HTML.

    Args:
        title: Name of the vehicle.
        lead: Result in one sentence.
        sections: Sections in their order.
        footer: Origin of the page.
    """
    drawn = [
        {
            "title": section.title,
            "rows": section.rows,
            "points": section.points,
            "pictures": [
                Markup(inline_svg(figure, f"s{number}p{index}"))  # our own drawing, not the FMU's
                for index, figure in enumerate(section.figures)
            ],
        }
        for number, section in enumerate(sections)
    ]
    template = page_environment().get_template("passport.html.j2")
    return template.render(title=title, lead=lead, sections=drawn, footer=footer)
