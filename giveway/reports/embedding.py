"""Pictures for a page: SVG with the page's colours and fonts, and unique ids."""

import re
from io import BytesIO

from matplotlib import rc_context
from matplotlib.figure import Figure

from giveway.figures.style import house_style

# Black becomes the page's text colour, white its background, so that a dark page has light lines.
_COLOURS = {
    "#000000": "currentColor",
    "#505050": "var(--muted)",
    "#767676": "var(--grey)",
    "#0072b2": "var(--blue)",
    "#ffffff": "var(--paper)",
}
_TAG = re.compile(r"<[^>]+>")
_DIGITS = re.compile(r"-?\d+\.\d{3,}")


def inline_svg(figure: Figure, prefix: str) -> str:
    """Return the figure as an ``<svg>`` element.

    Args:
        figure: Figure to draw.
        prefix: Prefix of the ids in it; letters and digits, unique in the page.
    """
    stream = BytesIO()
    with house_style(), rc_context({"svg.fonttype": "none"}):
        figure.savefig(stream, format="svg", transparent=True, metadata={"Date": None})
    text = stream.getvalue().decode("utf-8")
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = _TAG.sub(lambda tag: _for_page(tag[0], prefix), text)
    return re.sub(r"<svg ", '<svg aria-hidden="true" focusable="false" ', text, count=1).strip()


def _for_page(tag: str, prefix: str) -> str:
    """Return a tag with ids, colours and coordinates for the page.

    Text between tags is returned unchanged.
    """
    tag = re.sub(r'\bid="', f'id="{prefix}-', tag)
    tag = re.sub(r"url\(#", f"url(#{prefix}-", tag)
    tag = re.sub(r'xlink:href="#', f'href="#{prefix}-', tag)
    if tag.startswith("<svg"):
        tag = re.sub(r'\s(?:xmlns(?::xlink)?|version)="[^"]*"', "", tag)
    for colour, name in _COLOURS.items():
        tag = tag.replace(colour, name)
    return _DIGITS.sub(lambda found: f"{float(found[0]):.2f}", tag)
