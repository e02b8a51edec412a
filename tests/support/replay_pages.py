"""One short run for all tests, and one headless Chromium that opens its pages from the disk."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

SETTINGS: dict[str, Any] = {
    "scenario": "shared_space",
    "seed": 3,
    "controller": "mpc-paper",
    "time_limit": 7.0,
    "record": {"predictions": 0.25},
}


@pytest.fixture(scope="session")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of a run that drives, brakes and hands over to the PID."""
    from giveway import run

    folder = tmp_path_factory.mktemp("runs") / "recorded"
    run(SETTINGS, results=folder, pictures=False)
    return folder


@dataclass
class Watched:
    """An open page, and what went wrong on it."""

    tab: Any
    complaints: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    @property
    def time(self) -> float:
        """[s] on the run's clock."""
        return float(self.tab.evaluate("replay.time"))

    def seek(self, time: float) -> None:
        """Show an instant, and wait until it has been drawn."""
        self.tab.evaluate("t => replay.seek(t)", time)
        self.settle()

    def settle(self) -> None:
        """Wait for two frames: what was asked for before is on the canvas then."""
        frames = "new Promise(r => requestAnimationFrame(() => requestAnimationFrame(() => r())))"
        self.tab.evaluate(frames)

    def until(self, condition: str) -> None:
        """Wait for a condition in JavaScript; the page's policy forbids Playwright's own way."""
        self.tab.evaluate(f"""new Promise((come, fail) => {{
          const look = () => (({condition}) ? come() : setTimeout(look, 20));
          setTimeout(() => fail(new Error("never: " + {json.dumps(condition)})), 5000);
          look();
        }})""")

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Where a place [m] of the network is on the stage [px]."""
        return tuple(self.tab.evaluate("([x, y]) => replay.place(x, y)", [x, y]))

    def pixel(self, x: float, y: float, canvas: str = "stage") -> tuple[int, ...]:
        """The colour at a pixel of a canvas."""
        read = """([id, x, y]) => {
          const canvas = document.getElementById(id);
          const ratio = canvas.width / canvas.clientWidth;
          const pen = canvas.getContext("2d");
          return [...pen.getImageData(Math.round(x * ratio), Math.round(y * ratio), 1, 1).data];
        }"""
        return tuple(self.tab.evaluate(read, [canvas, x, y])[:3])

    def columns(self, colour: tuple[int, ...], y: float, canvas: str) -> list[float]:
        """Where [px] a row of pixels has exactly this colour."""
        read = """([id, y, [r, g, b]]) => {
          const canvas = document.getElementById(id);
          const ratio = canvas.width / canvas.clientWidth;
          const pen = canvas.getContext("2d");
          const row = pen.getImageData(0, Math.round(y * ratio), canvas.width, 1).data;
          const found = [];
          for (let i = 0; i < row.length; i += 4) {
            if (row[i] === r && row[i + 1] === g && row[i + 2] === b) found.push(i / 4 / ratio);
          }
          return found;
        }"""
        return list(self.tab.evaluate(read, [canvas, y, list(colour)]))

    def count(self, colour: tuple[int, ...]) -> int:
        """How many pixels of the stage have about this colour."""
        read = """([r, g, b]) => {
          const {width, height} = stage;
          const data = stage.getContext("2d").getImageData(0, 0, width, height).data;
          let count = 0;
          for (let i = 0; i < data.length; i += 4) {
            const off = Math.abs(data[i] - r) + Math.abs(data[i + 1] - g)
              + Math.abs(data[i + 2] - b);
            if (off < 12) count++;
          }
          return count;
        }"""
        return int(self.tab.evaluate(read, list(colour)))

    def colour(self, name: str) -> tuple[int, ...]:
        """A colour of the page by its name, like ``mpc``."""
        read = "n => getComputedStyle(document.documentElement).getPropertyValue('--' + n).trim()"
        text = self.tab.evaluate(read, name).lstrip("#")
        return tuple(int(text[i : i + 2], 16) for i in (0, 2, 4))


@pytest.fixture
def watch(chromium: Any) -> Iterator[Callable[..., Watched]]:
    """Opens a page from the disk; no request to anywhere else gets through.

    It is closed after the test: what is open goes on drawing.
    """
    contexts: list[Any] = []

    def watch(page: Path, *, at: str = "", **options: Any) -> Watched:
        options = {"viewport": {"width": 1280, "height": 800}} | options
        context = chromium.new_context(**options)
        contexts.append(context)
        watched = Watched(context.new_page())

        def answer(route: Any) -> None:
            if route.request.url.partition("#")[0] == page.as_uri():
                route.continue_()
            else:
                watched.requests.append(route.request.url)
                route.abort()

        context.route("**/*", answer)
        tab = watched.tab
        tab.on("console", lambda message: watched.complaints.append(message.text))
        tab.on("pageerror", lambda error: watched.complaints.append(str(error)))
        tab.goto(page.as_uri() + at)
        watched.settle()
        return watched

    yield watch
    for context in contexts:
        context.close()


@pytest.fixture(scope="session")
def page(recorded: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The replay of the recorded run."""
    from giveway.replays import write_replay

    return write_replay(recorded, tmp_path_factory.mktemp("pages") / "replay.html")


@pytest.fixture
def watched(watch: Callable[..., Watched], page: Path) -> Watched:
    """The recorded run, just opened."""
    return watch(page)
