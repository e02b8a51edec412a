"""The answers of Euro NCAP's calculator to tables of pedestrian tests by day.

    PYTHON benchmarks/ncap/calculator.py < tables.json > answers.json

PYTHON belongs to an environment of its own with ``pip install euroncap-rating-2026`` (it needs
pandas < 3); nothing of giveway is there. official_points.py calls it.
"""

import contextlib
import importlib
import io
import json
import logging
import os
import sys
import tempfile
import warnings
from copy import deepcopy
from importlib.metadata import version

import openpyxl

_PACKAGE = "euroncap_rating_2026"
common = importlib.import_module(f"{_PACKAGE}.common")
ca = {
    name: importlib.import_module(f"{_PACKAGE}.crash_avoidance.{name}")
    for name in (
        "generate_template",
        "preprocess",
        "compute_score",
        "matrix_processing",
        "data_model",
        "test_info",
    )
}
matrix = ca["matrix_processing"]

TESTS = ("CPNA", "CPFA", "CPNCO", "CPLA")
SHEET, VERIFICATION = "FC - Ped & Cyc pred.", "FC - Ped & Cyc verif."


def main() -> None:
    """Read tables from standard input, and write the answers to standard output."""
    warnings.filterwarnings("ignore")
    logging.disable(logging.CRITICAL)
    tables = json.load(sys.stdin)
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        os.chdir(folder)
        frames = _frames()
    places = {name: _places(frames, name) for name in TESTS}
    answers = [_answer(frames, places, table) for table in tables]
    json.dump({"calculator": version("euroncap-rating-2026"), "answers": answers}, sys.stdout)


def _frames() -> dict:
    """Return the sheets as the calculator's own commands prepare them, all cells green."""
    ca["generate_template"].generate_template.callback()
    book = openpyxl.load_workbook("ca_template.xlsx")
    _fill_parameters(book["Input parameters"])
    _fill_colours(book[SHEET])
    layers = book["FC - Ped & Cyc robust. pred."]
    for column in range(1, layers.max_column + 1):
        if layers.cell(1, column).value in TESTS:
            for row in range(2, layers.max_row + 1):
                layers.cell(row, column).value = "NO"
    book.save("in.xlsx")
    ca["preprocess"].preprocess.callback(input_file="in.xlsx", output_path=".")
    return common.read_excel_file_to_dfs(
        "ca_preprocessed_template.xlsx",
        load_bg_colors=True,
        preserve_na_sheets=ca["data_model"].PRESERVE_NA_SHEETS,
    )


def _fill_parameters(sheet) -> None:
    scenario = None
    for row in range(2, sheet.max_row + 1):
        scenario = sheet.cell(row, 5).value or scenario
        sheet.cell(row, 7).value = "VTA" if scenario in TESTS else "N/A"
        if sheet.cell(row, 6).value == "Heading correction":
            sheet.cell(row, 7).value = "Steering input"


def _fill_colours(sheet) -> None:
    """Fill all cells of the pedestrian tests, and declare the choice rows of CPLA as braking."""
    first = {"CPLA": 7, "CPNA": 6, "CPFA": 6, "CPNCO": 7}
    last = {"CPLA": 10, "CPNA": 10, "CPFA": 10, "CPNCO": 9}
    test = ""
    for row in range(1, sheet.max_row + 1):
        label = str(sheet.cell(row, 1).value or "")
        if not label.endswith("km/h"):
            test = label.split(" ")[0] or test
            continue
        if test in first:
            for column in range(first[test], last[test] + 1):
                sheet.cell(row, column).value = "Green"
            if test == "CPLA" and not sheet.cell(row, 3).value:
                sheet.cell(row, 3).value = "AEB"


def _places(frames: dict, name: str) -> dict:
    """Return the calculator's test points of a test by day by hit point and speed."""
    where = matrix.get_matrix_indices(frames[SHEET], f"{name} day")
    points = matrix.get_test_matrix_from_region(
        frames[f"{SHEET} (bg)"],
        where["start_row"],
        where["n_rows"],
        where["start_col"],
        where["n_cols"],
        f"{name} day",
        ca["test_info"].get_stage_subelement_key("Frontal Collisions"),
        attributes_df=frames[SHEET],
    )
    found = {}
    for point in points:
        hit = int(point.attributes["Impact location"].rstrip("%"))
        speed = int(point.attributes["VUT speed"].split(" ")[0])
        found[hit, speed] = (where["start_row"] + point.row, where["start_col"] + point.col, point)
    return found


def _answer(frames: dict, places: dict, table: dict) -> dict:
    """Return colours, verifications and points of one table."""
    frames = dict(frames)
    colours = frames[f"{SHEET} (bg)"] = frames[f"{SHEET} (bg)"].copy()
    given = []
    for name, hit, speed, impact in table["cells"]:
        row, column, point = places[name][hit, speed]
        colour = _computed(name, point, impact).measured_color
        colours.iloc[row, column] = colour
        given.append(colour.value)
    sheet = frames[VERIFICATION] = frames[VERIFICATION].copy()
    sheet.columns = [str(name) for name in sheet.columns]
    _verify(sheet, colours, places, table["measured"])
    result = ca["compute_score"].calculate_score(frames)
    scores, scenario, points = result["Scenario Scores"], None, {}
    for _, line in scores.iterrows():
        scenario = line["Scenario"] if isinstance(line["Scenario"], str) else scenario
        if scenario in TESTS and line["Layer"] in {"Standard", "Extended"}:
            points.setdefault(scenario, []).append(line["Score"])
    checked = []
    for name, hit, speed, value in table["measured"]:
        row, column, point = places[name][hit, speed]
        point = deepcopy(point)
        point.color = colours.iloc[row, column]
        done = _computed(name, point, value)
        checked.append([done.prediction_result.value, done.computed_color.value])
    return {"colours": given, "checked": checked, "points": points}


def _computed(name: str, point, value: float):
    return matrix.ComputedTestPoint(test_point=point, test_name=f"{name} day", value=value)


def _verify(sheet, colours, places: dict, measured: list) -> None:
    """Put measured values into the rows of the verification sheet, test by test."""
    head = next(i for i in range(len(sheet)) if "Test point" in list(sheet.iloc[i]))
    columns = {str(value): number for number, value in enumerate(sheet.iloc[head])}
    waiting = {}
    for name, hit, speed, value in measured:
        _, _, point = places[name][hit, speed]
        waiting.setdefault((f"{name} day", point.test_range.value), []).append(
            (hit, speed, value, point)
        )
    for i in range(head + 1, len(sheet)):
        key = sheet.iloc[i, columns["Scenario"]], sheet.iloc[i, columns["Range"]]
        if not waiting.get(key):
            continue
        hit, speed, value, point = waiting[key].pop()
        row, column, _ = places[key[0].split(" ")[0]][hit, speed]
        for name, cell in {
            "VUT speed": f"{speed} km/h",
            "Impact location": f"{hit}%",
            "Test point": f"({point.row}, {point.col})",
            "OEM Prediction": colours.iloc[row, column].value.capitalize(),
            "Value": value,
        }.items():
            sheet.iloc[i, columns[name]] = cell


if __name__ == "__main__":
    main()
