"""The page can be read by everybody: contrast in both colour schemes, and on a phone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

DRIVING, STANDING = 4.0, 6.9  # [s] under the MPC; under the PID
CONTRAST = """() => {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [1, 1];
  const pen = canvas.getContext("2d", { willReadFrequently: true });
  const luminance = () => {
    const [r, g, b] = [...pen.getImageData(0, 0, 1, 1).data].slice(0, 3).map((value) => {
      const share = value / 255;
      return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ratio = (grounds, colour) => {
    const told = [];
    for (const fill of [...grounds, colour]) {
      pen.fillStyle = fill;
      pen.fillRect(0, 0, 1, 1);
      told.push(luminance());
    }
    const [dark, light] = told.slice(-2).sort((a, b) => a - b);
    return (light + 0.05) / (dark + 0.05);
  };
  const poor = [];
  const note = (name, value) => { if (value < 4.5) poor.push(`${name}: ${value.toFixed(2)}`); };
  for (const at of document.querySelectorAll("body *")) {
    const own = [...at.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
    if (!own || !at.checkVisibility() || at.closest("label:has(:disabled)")) continue;
    const grounds = [];
    for (let e = at; e; e = e.parentElement) grounds.unshift(getComputedStyle(e).backgroundColor);
    note(`${at.tagName} ${at.id || at.className} ${at.textContent.trim()}`,
      ratio(grounds, getComputedStyle(at).color));
  }
  for (const on of ["ground", "road", "panel"]) { // of texts on canvases
    for (const text of ["quiet", "ink"]) {
      note(`${text} on ${on}`, ratio([colours[on]], colours[text]));
    }
  }
  return poor;
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_all_text_has_the_contrast_that_wcag_asks_for(
    watch: Callable[..., Any], page: Path, scheme: str
) -> None:
    watched = watch(page, color_scheme=scheme)
    for time in (DRIVING, STANDING):  # the badge has other colours
        watched.seek(time)
        assert watched.tab.evaluate(CONTRAST) == []  # WCAG 2.2, 1.4.3


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone_shows_it_without_scrolling_sideways(
    watch: Callable[..., Any], page: Path, scheme: str
) -> None:
    watched = watch(
        page, viewport={"width": 400, "height": 800}, color_scheme=scheme, has_touch=True
    )
    assert watched.tab.evaluate("document.documentElement.scrollWidth") <= 400
    for control in ("#play", "#speed", "#below", "#loop", "#scrubber", "#charts", "#follow"):
        box = watched.tab.locator(control).bounding_box()
        assert box["x"] >= 0, control
        assert box["x"] + box["width"] <= 400, control
    assert watched.pixel(3, 30) == watched.colour("ground")
    assert (sum(watched.colour("ground")) < 300) == (scheme == "dark")
